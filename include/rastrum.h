// SPDX-License-Identifier: BSD-3-Clause
// Rastrum in C: arrays in, images out. For C, Fortran, Julia, Rust and whoever loads a library at
// run time. docs/c.md shows it; docs/arrays.md and docs/outputs.md say what each thing means.
//
// Handles. rastrum_X_new makes one, or returns null; rastrum_X_free gives it back (null: nothing).
// One thread at a time changes a handle, and none while another draws with it.
// Memory. Arrays and targets stay the caller's, and nothing of them is copied: they must be there,
// unchanged, whenever a picture is drawn. Small vectors, matrices and texts are copied.
// Failures. A function that can fail returns a status, and has then changed no handle. The sentence
// that says what was wrong is rastrum_error_text. Arrays are looked at when a picture is drawn.
// ABI. From version 1.0 on, within a major version, functions keep their arguments and their
// meaning, constants their numbers, and rastrum_array its fields. New things are new functions.
#ifndef RASTRUM_H
#define RASTRUM_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/// RASTRUM_OK, or what kind of failure it was.
typedef int rastrum_status;
enum {
  RASTRUM_OK = 0,
  RASTRUM_INVALID_ARGUMENT = 1,  ///< an argument, an array or a handle that is null
  RASTRUM_NOT_FOUND = 2,         ///< a name that is none
  RASTRUM_IO = 3,
  RASTRUM_BAD_FORMAT = 4,
  RASTRUM_UNSUPPORTED = 5,  ///< valid, but outside of what Rastrum does
  RASTRUM_OUT_OF_MEMORY = 6,
  RASTRUM_NO_DEVICE = 7,
  RASTRUM_STOPPED = 8,    ///< rastrum_frame_set_stopped
  RASTRUM_UNEXPECTED = 9  ///< a defect of Rastrum
};

/// The last failure of the calling thread, a sentence in UTF-8; "" before the first. Never null. It
/// stays until this thread's next failure.
const char* rastrum_error_text(void);
/// That of the library: "major.minor.patch".
const char* rastrum_version(void);

// Arrays.

/// The types of numbers.
enum {
  RASTRUM_FLOAT32 = 0,
  RASTRUM_FLOAT64 = 1,
  RASTRUM_UINT8 = 2,
  RASTRUM_INT8 = 3,
  RASTRUM_UINT16 = 4,
  RASTRUM_INT16 = 5,
  RASTRUM_UINT32 = 6,
  RASTRUM_INT32 = 7,
  RASTRUM_UINT64 = 8,
  RASTRUM_INT64 = 9
};

/// `count` values in the caller's memory. {NULL, 0, 0, 0, 0} is none. Positions, normals, colours
/// and radii are float32, float64, or 8 and 16 bits (normalized to [0, 1], signed ones to [-1, 1]);
/// indices and offsets are integers; scalars are any numbers. Numbers need no alignment.
typedef struct {
  const void* data;
  size_t count;
  int type;                ///< RASTRUM_FLOAT32, ...
  int channels;            ///< numbers a value; 0: as many as its use has. Colours may have 3
  ptrdiff_t stride_bytes;  ///< from a value to the next, also negative; 0: packed
} rastrum_array;

/// The element that each value of an attribute belongs to.
enum {
  RASTRUM_PER_VERTEX = 0,  ///< a position, or a sphere; the others are meshes' alone
  RASTRUM_PER_CORNER = 1,
  RASTRUM_PER_FACE = 2,
  RASTRUM_PER_MESH = 3  ///< one value for all
};

// Scenes: instances, numbered from 0 in the order in which they are added. Each function gives the
// number of what it adds in its last argument, which may be null. Indices count from 0.

typedef struct rastrum_scene rastrum_scene;
rastrum_scene* rastrum_scene_new(void);
void rastrum_scene_free(rastrum_scene* scene);

/// Triangles, three indices each; without indices three positions each.
rastrum_status rastrum_scene_add_mesh(rastrum_scene* scene, rastrum_array positions,
                                      rastrum_array indices, size_t* instance);
/// Squares of `size_px` pixels, in (0, 4096].
rastrum_status rastrum_scene_add_points(rastrum_scene* scene, rastrum_array positions,
                                        float size_px, size_t* instance);
/// Segments, two indices each; without indices two positions each.
rastrum_status rastrum_scene_add_lines(rastrum_scene* scene, rastrum_array positions,
                                       rastrum_array indices, float width_px, size_t* instance);
rastrum_status rastrum_scene_add_spheres(rastrum_scene* scene, rastrum_array centers, float radius,
                                         size_t* instance);
/// As lines, closed by discs; cones where rastrum_instance_set_radii makes the ends differ.
rastrum_status rastrum_scene_add_cylinders(rastrum_scene* scene, rastrum_array positions,
                                           rastrum_array indices, float radius, size_t* instance);
/// One tube with round joints along all positions, or several (rastrum_instance_set_offsets).
rastrum_status rastrum_scene_add_tubes(rastrum_scene* scene, rastrum_array positions, float radius,
                                       size_t* instance);
/// The same arrays and looks once more, to be placed elsewhere.
rastrum_status rastrum_scene_add_copy(rastrum_scene* scene, size_t instance, size_t* copy);

/// A way from numbers to colours: a map by its name ("viridis", "coolwarm_r", "tab10", ...), or
/// colours "#RRGGBB" from low to high, separated by commas. Its range goes from the least to the
/// greatest number that is shown by it.
rastrum_status rastrum_scene_add_color_map(rastrum_scene* scene, const char* colors,
                                           size_t* color_map);
rastrum_status rastrum_scene_set_color_range(rastrum_scene* scene, size_t color_map, double low,
                                             double high);

/// Object to world: 16 numbers, row by row, for columns (x, y, z, 1).
rastrum_status rastrum_instance_set_transform(rastrum_scene* scene, size_t instance,
                                              const double matrix[16]);
/// n + 1 that rise: a mesh becomes n polygons, lines and tubes n polylines; number i has the
/// corners from offsets[i] up to offsets[i + 1].
rastrum_status rastrum_instance_set_offsets(rastrum_scene* scene, size_t instance,
                                            rastrum_array offsets);
/// For meshes and points; any length. A mesh without them has its faces'.
rastrum_status rastrum_instance_set_normals(rastrum_scene* scene, size_t instance,
                                            rastrum_array normals, int per);
/// RGB or RGBA, display values, straight alpha.
rastrum_status rastrum_instance_set_colors(rastrum_scene* scene, size_t instance,
                                           rastrum_array colors, int per);
/// Numbers that a colour map of this scene shows.
rastrum_status rastrum_instance_set_scalars(rastrum_scene* scene, size_t instance,
                                            rastrum_array scalars, int per, size_t color_map);
/// One a sphere, or a position of cylinders and tubes; of points sizes in px.
rastrum_status rastrum_instance_set_radii(rastrum_scene* scene, size_t instance,
                                          rastrum_array radii);
/// One for all, in place of its colours; null: none.
rastrum_status rastrum_instance_set_color(rastrum_scene* scene, size_t instance,
                                          const float rgba[4]);
/// In [0, 1]; multiplies alpha and the frame's.
rastrum_status rastrum_instance_set_opacity(rastrum_scene* scene, size_t instance, float opacity);
/// 0: it is not drawn, and its primitives keep their numbers.
rastrum_status rastrum_instance_set_visible(rastrum_scene* scene, size_t instance, int visible);
/// Stands for it in the target "instances"; else its number does.
rastrum_status rastrum_instance_set_id(rastrum_scene* scene, size_t instance, int64_t id);

// Cameras: right-handed, looking along their own -z, +y up. A new one is at (0, 0, 1), looks at the
// origin and sees 60 degrees. A lens or a matrix replaces what was set before.

typedef struct rastrum_camera rastrum_camera;
rastrum_camera* rastrum_camera_new(void);
void rastrum_camera_free(rastrum_camera* camera);

rastrum_status rastrum_camera_look_at(rastrum_camera* camera, const double eye[3],
                                      const double target[3], const double up[3]);
/// An angle across the smaller side of the picture, in (0, pi).
rastrum_status rastrum_camera_set_perspective(rastrum_camera* camera, float fov_rad);
/// Parallel rays; `height` of the world fills the smaller side of the picture.
rastrum_status rastrum_camera_set_orthographic(rastrum_camera* camera, float height);
/// Distances from the eye, near < far, which may be infinite with perspective.
rastrum_status rastrum_camera_set_planes(rastrum_camera* camera, float near_plane, float far_plane);
/// Moves it along its view and sets planes and height, so that the scene fills W x H pixels.
rastrum_status rastrum_camera_fit(rastrum_camera* camera, const rastrum_scene* scene, int width,
                                  int height);
/// World to clip space, row by row, +y up. `depth`: z / w at its near and far plane.
enum {
  RASTRUM_DEPTH_OPENGL = 0,       ///< -1 and 1
  RASTRUM_DEPTH_ZERO_TO_ONE = 1,  ///< 0 and 1: Direct3D, Vulkan, Metal, WebGPU
  RASTRUM_DEPTH_REVERSED = 2      ///< 1 and 0: as in "depth"
};
rastrum_status rastrum_camera_set_matrix(rastrum_camera* camera, const double world_to_clip[16],
                                         int depth);
/// OpenCV's, of a W x H picture. `k`: fx, fy, cx, cy, skew, and u and v of the centre of the top
/// left pixel (OpenCV: 0; COLMAP: 0.5). `world_to_camera`: (R t; 0 1), row by row, y down, z ahead.
rastrum_status rastrum_camera_set_opencv(rastrum_camera* camera, const double k[6],
                                         const double world_to_camera[16], int width, int height,
                                         double near_plane);
/// World to clip space with reversed depth, row by row: where things are in a W x H picture.
rastrum_status rastrum_camera_get_matrix(const rastrum_camera* camera, int width, int height,
                                         double world_to_clip[16]);

// Frames: the size of a picture, how it looks, and the memory that it goes to.

typedef struct rastrum_frame rastrum_frame;
/// At most 32768 x 32768.
rastrum_frame* rastrum_frame_new(int width, int height);
void rastrum_frame_free(rastrum_frame* frame);

/// "auto", "flat", "depth", "normal", "id", "lambert", "phong", "material", "wireframe".
rastrum_status rastrum_frame_set_shader(rastrum_frame* frame, const char* shader);
/// Display values, straight alpha; (0, 0, 0, 0) unless it is set.
rastrum_status rastrum_frame_set_background(rastrum_frame* frame, const float rgba[4]);
/// A pixel: 1, 4, 8 or 16.
rastrum_status rastrum_frame_set_samples(rastrum_frame* frame, int samples);
/// The opacity of everything, in [0, 1].
rastrum_status rastrum_frame_set_opacity(rastrum_frame* frame, float opacity);
enum { RASTRUM_CULL_NONE = 0, RASTRUM_CULL_BACK = 1, RASTRUM_CULL_FRONT = 2 };
rastrum_status rastrum_frame_set_cull(rastrum_frame* frame, int cull);
/// Draws what all of up to 8 planes keep, in the world. Four numbers each: normal n and offset, for
/// places p with n . p + offset >= 0.
rastrum_status rastrum_frame_set_clip_planes(rastrum_frame* frame, const double* planes,
                                             size_t count);
/// The first one replaces the light of the shader. `vector`: of a directional light the way in
/// which it travels, of a point light its place, of an ambient light nothing (null). `rgb`: linear.
/// `of_camera`: not 0: `vector` is in the camera's axes, x right, y up, z to the viewer.
enum { RASTRUM_LIGHT_AMBIENT = 0, RASTRUM_LIGHT_DIRECTIONAL = 1, RASTRUM_LIGHT_POINT = 2 };
rastrum_status rastrum_frame_add_light(rastrum_frame* frame, int kind, const double vector[3],
                                       const float rgb[3], float intensity, int of_camera);
rastrum_status rastrum_frame_set_shadows(rastrum_frame* frame, int shadows);

/// Memory for one image, row 0 at the top; null: it is not computed. `bytes`: of that memory, which
/// must be what the image takes (more, with a stride). `stride_bytes`: from a row to the next
/// below, also negative (then `pixels` is the row that lies last); 0: packed.
///   "color8" uint8 x 4, straight alpha   "color" float32 x 4, premultiplied
///   "depth" float32, 1 near, 0 far       "view_depth" float32, along the axis   "distance" float32
///   "ids" int64, primitive in the scene  "instances" int64   "primitives" int64, in its instance
///   "positions", "normals", "camera_normals" float32 x 3   "barycentrics" float32 x 2
///   "albedo", "linear" float32 x 4       "scalars" float32
///   "ids32", "instances32", "primitives32" int32
///   "keys" uint64   "overdraw" uint32    "errors" uint8
/// docs/outputs.md says what each is, and its value where nothing is.
rastrum_status rastrum_frame_set_target(rastrum_frame* frame, const char* target, void* pixels,
                                        size_t bytes, ptrdiff_t stride_bytes);
/// The type of the numbers of such an image (RASTRUM_UINT8, ...), and how many a pixel has.
rastrum_status rastrum_target_type(const char* target, int* type, int* channels);
/// SHA-256 of what a target holds, 64 hexadecimal digits and a 0: equal on every machine, and to
/// what `rastrum --hash` prints.
rastrum_status rastrum_frame_digest(const rastrum_frame* frame, const char* target,
                                    char digest[65]);
/// Not 0: a picture of this frame ends soon with RASTRUM_STOPPED, which is to be called while
/// another thread draws it, and so do later ones. 0, while nobody draws it: they are drawn again.
rastrum_status rastrum_frame_set_stopped(rastrum_frame* frame, int stopped);

// Renderers keep threads and memory from picture to picture. Several threads may draw with one;
// they take turns.

typedef struct rastrum_renderer rastrum_renderer;
rastrum_renderer* rastrum_renderer_new(void);
void rastrum_renderer_free(rastrum_renderer* renderer);
/// 0: all of the machine.
rastrum_status rastrum_renderer_set_threads(rastrum_renderer* renderer, int threads);
/// Beyond the caller's arrays and targets; 0: none. Larger scenes are then drawn in parts.
rastrum_status rastrum_renderer_set_memory_limit(rastrum_renderer* renderer, uint64_t bytes);
/// "serial", "threads" (as a new one), "cuda", "auto".
rastrum_status rastrum_renderer_set_device(rastrum_renderer* renderer, const char* device);

/// Draws the scene into the frame's targets.
rastrum_status rastrum_render(rastrum_renderer* renderer, const rastrum_scene* scene,
                              const rastrum_camera* camera, const rastrum_frame* frame);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
