// SPDX-License-Identifier: BSD-3-Clause
// Rastrum in C: arrays in, images out. It is for C, Fortran, Julia, Rust and whatever else loads a
// library at run time. docs/c.md is the guide; docs/arrays.md and docs/outputs.md define the words.
//
// Handles. rastrum_X_new makes one, or returns null; rastrum_X_free frees it (null: nothing).
// One thread at a time changes a handle, and none while another draws with it.
// Memory. Arrays and targets stay the caller's, and nothing of them is copied: they must be there,
// unchanged, when a picture is drawn or a camera fitted. Vectors, matrices and texts are copied.
// Failures. A function that can fail returns a status. If it fails, no handle has changed, and
// rastrum_error_text says what was wrong. The values in arrays are checked when they are used.
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

/// RASTRUM_OK, or the kind of failure.
typedef int rastrum_status;
enum {
  RASTRUM_OK = 0,
  RASTRUM_INVALID_ARGUMENT = 1,  ///< an argument or array that is wrong, a null handle
  RASTRUM_NOT_FOUND = 2,         ///< a target or a colour map of that name does not exist
  RASTRUM_IO = 3,
  RASTRUM_BAD_FORMAT = 4,
  RASTRUM_UNSUPPORTED = 5,  ///< valid, but outside of what Rastrum does
  RASTRUM_OUT_OF_MEMORY = 6,
  RASTRUM_NO_DEVICE = 7,
  RASTRUM_STOPPED = 8,    ///< as rastrum_frame_set_stopped asked
  RASTRUM_UNEXPECTED = 9  ///< a defect of Rastrum
};

/// The last failure of the calling thread as a sentence in UTF-8; "" before the first, never null.
/// The text stays until this thread's next failure.
const char* rastrum_error_text(void);
/// The status of that failure, also where a function returned null; RASTRUM_OK before the first.
rastrum_status rastrum_error_status(void);
/// The version of the library: "major.minor.patch".
const char* rastrum_version(void);

// Arrays.

/// The types of the numbers in arrays and targets.
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

/// `count` values in the caller's memory; {NULL, 0, 0, 0, 0} is no array. Positions, normals,
/// colours and radii are float32, float64, or 8 and 16 bits (normalized to [0, 1], signed ones to
/// [-1, 1]); indices and offsets are integers; scalars are any numbers. Numbers need no alignment.
typedef struct {
  const void* data;
  size_t count;
  int type;                ///< RASTRUM_FLOAT32, ...
  int channels;            ///< numbers in a value; 0: as its use needs. Colours may have 3
  ptrdiff_t stride_bytes;  ///< from a value to the next, may be negative; 0: packed
} rastrum_array;

/// The element that each value of an attribute belongs to. Meshes alone have the last three.
enum {
  RASTRUM_PER_VERTEX = 0,  ///< a position, or a sphere
  RASTRUM_PER_CORNER = 1,
  RASTRUM_PER_FACE = 2,
  RASTRUM_PER_MESH = 3  ///< one value for the whole mesh
};

// Scenes have instances and colour maps, each numbered from 0 in the order of adding. Functions
// that add one give its number in the last argument, which may be null. Indices count from 0.

typedef struct rastrum_scene rastrum_scene;
rastrum_scene* rastrum_scene_new(void);
void rastrum_scene_free(rastrum_scene* scene);

/// Adds triangles, of three indices each or, without indices, of three positions each.
rastrum_status rastrum_scene_add_mesh(rastrum_scene* scene, rastrum_array positions,
                                      rastrum_array indices, size_t* instance);
/// Adds points: squares of `size_px` pixels, in (0, 4096].
rastrum_status rastrum_scene_add_points(rastrum_scene* scene, rastrum_array positions,
                                        float size_px, size_t* instance);
/// Adds line segments, of two indices each or, without indices, of two positions each.
rastrum_status rastrum_scene_add_lines(rastrum_scene* scene, rastrum_array positions,
                                       rastrum_array indices, float width_px, size_t* instance);
rastrum_status rastrum_scene_add_spheres(rastrum_scene* scene, rastrum_array centers, float radius,
                                         size_t* instance);
/// Adds cylinders, with ends as lines have them, closed by discs; cones if
/// rastrum_instance_set_radii makes the ends differ.
rastrum_status rastrum_scene_add_cylinders(rastrum_scene* scene, rastrum_array positions,
                                           rastrum_array indices, float radius, size_t* instance);
/// Adds a tube with round joints along all positions, or several (rastrum_instance_set_offsets).
rastrum_status rastrum_scene_add_tubes(rastrum_scene* scene, rastrum_array positions, float radius,
                                       size_t* instance);
/// Adds an instance again, with the same arrays and look, to be placed elsewhere.
rastrum_status rastrum_scene_add_copy(rastrum_scene* scene, size_t instance, size_t* copy);

/// Adds a map from numbers to colours: its name ("viridis", "coolwarm_r", "tab10", ...), or colours
/// "#RRGGBB" from low to high, separated by commas. Unless a range is set it goes from the least to
/// the greatest number that the map shows.
rastrum_status rastrum_scene_add_color_map(rastrum_scene* scene, const char* colors,
                                           size_t* color_map);
rastrum_status rastrum_scene_set_color_range(rastrum_scene* scene, size_t color_map, double low,
                                             double high);

/// The matrix from object to world: 16 numbers, row by row, for columns (x, y, z, 1).
rastrum_status rastrum_instance_set_transform(rastrum_scene* scene, size_t instance,
                                              const double matrix[16]);
/// n + 1 rising offsets, by which a mesh has n polygons, and lines and tubes have n polylines:
/// number i has the corners from offsets[i] up to offsets[i + 1].
rastrum_status rastrum_instance_set_offsets(rastrum_scene* scene, size_t instance,
                                            rastrum_array offsets);
/// Normals of meshes or points, of any length. A mesh without them has its faces'.
rastrum_status rastrum_instance_set_normals(rastrum_scene* scene, size_t instance,
                                            rastrum_array normals, int per);
/// Colours, RGB or RGBA: display values with straight alpha.
rastrum_status rastrum_instance_set_colors(rastrum_scene* scene, size_t instance,
                                           rastrum_array colors, int per);
/// Scalars: numbers that a colour map of this scene shows.
rastrum_status rastrum_instance_set_scalars(rastrum_scene* scene, size_t instance,
                                            rastrum_array scalars, int per, size_t color_map);
/// One radius for each sphere, or position of cylinders and tubes; sizes of points in px.
rastrum_status rastrum_instance_set_radii(rastrum_scene* scene, size_t instance,
                                          rastrum_array radii);
/// One colour in place of the geometry's; null: none.
rastrum_status rastrum_instance_set_color(rastrum_scene* scene, size_t instance,
                                          const float rgba[4]);
/// The opacity, in [0, 1]; it multiplies alpha and the frame's opacity.
rastrum_status rastrum_instance_set_opacity(rastrum_scene* scene, size_t instance, float opacity);
/// Whether the instance is drawn; with 0 it is not, and its primitives keep their numbers.
rastrum_status rastrum_instance_set_visible(rastrum_scene* scene, size_t instance, int visible);
/// The instance's value in the target "instances"; unless it is set, its number.
rastrum_status rastrum_instance_set_id(rastrum_scene* scene, size_t instance, int64_t id);

// Cameras are right-handed; they look along their own -z, +y up. A new one is at (0, 0, 1), looks
// at the origin and sees 60 degrees. A matrix replaces all else until another setter is called.

typedef struct rastrum_camera rastrum_camera;
rastrum_camera* rastrum_camera_new(void);
void rastrum_camera_free(rastrum_camera* camera);

rastrum_status rastrum_camera_look_at(rastrum_camera* camera, const double eye[3],
                                      const double target[3], const double up[3]);
/// The field of view across the smaller side of the picture, in (0, pi).
rastrum_status rastrum_camera_set_perspective(rastrum_camera* camera, float fov_rad);
/// Parallel rays: `height` units of the world fill the smaller side of the picture.
rastrum_status rastrum_camera_set_orthographic(rastrum_camera* camera, float height);
/// Distances along the view, near < far. `far_plane` may be infinite with perspective.
rastrum_status rastrum_camera_set_planes(rastrum_camera* camera, float near_plane, float far_plane);
/// Moves the camera along its view, or that of its matrix, and sets planes and height, so that the
/// scene fills W x H pixels. The camera has no matrix then.
rastrum_status rastrum_camera_fit(rastrum_camera* camera, const rastrum_scene* scene, int width,
                                  int height);
/// The matrix from world to clip space, row by row, +y up. `depth`: z / w at near and far plane.
enum {
  RASTRUM_DEPTH_OPENGL = 0,       ///< -1 and 1
  RASTRUM_DEPTH_ZERO_TO_ONE = 1,  ///< 0 and 1: Direct3D, Vulkan, Metal, WebGPU
  RASTRUM_DEPTH_REVERSED = 2      ///< 1 and 0: as in "depth"
};
rastrum_status rastrum_camera_set_matrix(rastrum_camera* camera, const double world_to_clip[16],
                                         int depth);
/// OpenCV's camera for W x H pixels. `k`: fx, fy, cx, cy, skew, u and v of the top left pixel's
/// centre (OpenCV: 0; COLMAP: 0.5). `world_to_camera`: (R t; 0 1), row by row, y down, z ahead.
rastrum_status rastrum_camera_set_opencv(rastrum_camera* camera, const double k[6],
                                         const double world_to_camera[16], int width, int height,
                                         double near_plane);
/// Gives the matrix from world to clip space, row by row, with reversed depth, for a W x H picture.
rastrum_status rastrum_camera_get_matrix(const rastrum_camera* camera, int width, int height,
                                         double world_to_clip[16]);

// Frames: the size of a picture, how it looks, and the memory that it goes to.

typedef struct rastrum_frame rastrum_frame;
/// Makes a frame of at least 1 x 1 and at most 32768 x 32768 pixels.
rastrum_frame* rastrum_frame_new(int width, int height);
void rastrum_frame_free(rastrum_frame* frame);

/// A name: "auto", "flat", "depth", "normal", "id", "lambert", "phong", "material", "wireframe",
/// "classic".
rastrum_status rastrum_frame_set_shader(rastrum_frame* frame, const char* shader);
/// The background, display values with straight alpha; (0, 0, 0, 0) unless it is set.
rastrum_status rastrum_frame_set_background(rastrum_frame* frame, const float rgba[4]);
/// Samples in each pixel: 1, 4, 8 or 16.
rastrum_status rastrum_frame_set_samples(rastrum_frame* frame, int samples);
/// The opacity of everything, in [0, 1].
rastrum_status rastrum_frame_set_opacity(rastrum_frame* frame, float opacity);
enum { RASTRUM_CULL_NONE = 0, RASTRUM_CULL_BACK = 1, RASTRUM_CULL_FRONT = 2 };
rastrum_status rastrum_frame_set_cull(rastrum_frame* frame, int cull);
/// Draws only what all planes keep, at most 8, in the world. Each has four numbers: normal n and
/// offset, and keeps places p with n . p + offset >= 0.
rastrum_status rastrum_frame_set_clip_planes(rastrum_frame* frame, const double* planes,
                                             size_t count);
/// Adds a light; the first replaces that of the shader. `vector`: the way in which a directional
/// light travels, or the place of a point light; ambient light has none (null). `rgb`: linear
/// light. `of_camera` not 0: `vector` is in the camera's axes, x right, y up, z to the viewer.
enum { RASTRUM_LIGHT_AMBIENT = 0, RASTRUM_LIGHT_DIRECTIONAL = 1, RASTRUM_LIGHT_POINT = 2 };
rastrum_status rastrum_frame_add_light(rastrum_frame* frame, int kind, const double vector[3],
                                       const float rgb[3], float intensity, int of_camera);
rastrum_status rastrum_frame_set_shadows(rastrum_frame* frame, int shadows);

/// Gives memory for one image, row 0 at the top; null: it is not computed. `bytes`: the size of
/// that memory, which must be what the image takes (or more, with a stride). `stride_bytes`: from a
/// row to the next below, may be negative (then `pixels` is the row that lies last); 0: packed.
///   "color8" uint8 x 4, straight alpha   "color" float32 x 4, premultiplied
///   "depth" float32, 1 near, 0 far       "view_depth" float32, along the axis   "distance" float32
///   "ids" int64, primitive in the scene  "instances" int64   "primitives" int64, in its instance
///   "positions", "normals", "camera_normals" float32 x 3   "barycentrics" float32 x 2
///   "albedo", "linear" float32 x 4       "scalars" float32
///   "ids32", "instances32", "primitives32" int32
///   "keys" uint64   "overdraw" uint32    "errors" uint8
/// docs/outputs.md defines each, and its value where nothing is.
rastrum_status rastrum_frame_set_target(rastrum_frame* frame, const char* target, void* pixels,
                                        size_t bytes, ptrdiff_t stride_bytes);
/// The type of the numbers in the image `target` (RASTRUM_UINT8, ...), and how many a pixel has.
rastrum_status rastrum_target_type(const char* target, int* type, int* channels);
/// SHA-256 of a target's image, as 64 hexadecimal digits and a 0: equal on every machine, and to
/// the output of `rastrum --hash`.
rastrum_status rastrum_frame_digest(const rastrum_frame* frame, const char* target,
                                    char digest[65]);
/// If `stopped` is not 0, the picture of this frame that another thread is drawing ends soon with
/// RASTRUM_STOPPED, and so do later ones. With 0, while nobody draws it, they are drawn again.
rastrum_status rastrum_frame_set_stopped(rastrum_frame* frame, int stopped);

// Renderers keep threads and memory from picture to picture. Several threads may draw with one;
// they take turns. Setting an option makes both anew.

typedef struct rastrum_renderer rastrum_renderer;
rastrum_renderer* rastrum_renderer_new(void);
void rastrum_renderer_free(rastrum_renderer* renderer);
/// The number of threads; 0: all of the machine.
rastrum_status rastrum_renderer_set_threads(rastrum_renderer* renderer, int threads);
/// Bytes beyond the caller's arrays and targets; 0: no limit. Beyond it scenes are drawn in parts.
rastrum_status rastrum_renderer_set_memory_limit(rastrum_renderer* renderer, uint64_t bytes);
/// The device: "serial", "threads" (as in a new renderer), "cuda" or "auto".
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
