// SPDX-License-Identifier: BSD-3-Clause
// The images of a frame, what its draws may choose, and what comes back beside the picture.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/device.hpp>
#include <rastrum/image.hpp>

namespace RASTRUM_API rastrum {

/// The faces of triangles that are left out.
enum class Cull : std::uint8_t { none, back, front };

/// How surfaces are shaded. The base colour of `flat`, `lambert`, `phong` and `wireframe` is the
/// mesh's colour, or (0.8, 0.7, 0.6) without one. With materials it is the base colour factor as a
/// display value, times the mesh's colour if there is one. `material` and `classic` use textures.
enum class Shader : std::uint8_t {
  automatic,  ///< `material` for a scene with materials, else `phong`
  flat,       ///< base colour, unlit
  depth,      ///< grey: the nearest is white, the farthest black; ignores opacity
  normal,     ///< (n + 1) / 2 of the world-space unit normal
  id,         ///< a hash of the triangle id as a colour
  lambert,    ///< base · (0.1 + 0.8 max(n·l, 0))
  phong,      ///< lambert + 0.3 max(n·h, 0)³²
  material,   ///< glTF metallic-roughness, textures, sRGB transfer
  wireframe,  ///< triangle edges about a pixel wide over the flat surface
  classic,    ///< OpenGL's fixed pipeline: ambient, diffuse, specular, emission; textures
};

/// How the translucent fragments of a pixel become one colour.
enum class Transparency : std::uint8_t {
  exact,     ///< every fragment, in the order of visibility keys, front to back
  unsorted,  ///< every fragment, in the order of submission, the later one in front
  none,      ///< translucent surfaces are drawn opaque
  added      ///< as TransparencyOptions::added says
};

struct RASTRUM_INSIDE AddedTransparency;

struct TransparencyOptions {
  Transparency method = Transparency::exact;
  /// A method of another library: rastrum/family.hpp has published approximations. It is read only
  /// if `method` is Transparency::added.
  const AddedTransparency* added = nullptr;
  /// Blending of a pixel (a sample) ends once it has this much alpha, in (0, 1]. With 1 nothing
  /// changes, because what lies behind is invisible; paper 4 takes 1 − 1/128, for whole
  /// half-blocks.
  float alpha_threshold = 1;

  bool operator==(const TransparencyOptions&) const = default;
};

/// The images that a frame fills; one with an empty view is not computed. All must have the frame's
/// size, and memory that no other target has and no array of the scene.
///
/// With several samples a pixel, colours are the mean over them. `depth`, `ids` and `keys` are
/// those of the largest key of any sample: the nearest surface that some sample sees, with its
/// depth there, even if it covers no other. `extra` and the images of the surface (below) are those
/// of this surface at the pixel's centre; if it does not cover the centre, its corners' weights are
/// cut to [0, 1]. `overdraw` counts samples; `errors` has 255 if some sample has one.
struct Targets {
  ImageView<Rgba8> color8{};            ///< straight alpha
  ImageView<Vec4> color{};              ///< premultiplied float32
  ImageView<float> depth{};             ///< reversed depth in [0, 1], 0 where nothing is
  ImageView<std::int64_t> ids{};        ///< primitive in submission order, −1 where nothing is
  ImageView<std::uint32_t> overdraw{};  ///< fragments at each pixel, hidden ones too

  // These describe the surface that `ids` names, at the pixel's centre, whatever the shader and its
  // alpha (docs/outputs.md). The CPU computes them from the keys, and only those that are asked
  // for. Draws of programs, which have no scene, give the numbers and the barycentrics alone.
  ImageView<std::int64_t> instances{};   ///< InstanceView::id, −1 where nothing is
  ImageView<std::int64_t> primitives{};  ///< in its instance (or draw), −1 where nothing is
  /// `ids`, `instances` and `primitives` in 32 bits. Frames whose numbers do not fit throw
  /// Error{invalid_argument}.
  ImageView<std::int32_t> ids32{}, instances32{}, primitives32{};
  /// Perspective-correct weights of the second and the third corner of the snapped triangle that
  /// was drawn: position = (1 − x − y) p0 + x p1 + y p2. (0, 0) where nothing is.
  ImageView<Vec2> barycentrics{};
  ImageView<Vec3> positions{};  ///< in the world, (0, 0, 0) where nothing is
  /// Unit normals in the world, turned to the viewer: the mesh's, interpolated as `phong` does, or
  /// the faces' if it has none. (0, 0, 0) where nothing is.
  ImageView<Vec3> normals{};
  ImageView<Vec3> camera_normals{};  ///< `normals` in the camera's axes: z to the viewer
  /// view_distance() of `depth`; FrameOptions::no_distance where nothing is, also in `distance`.
  ImageView<float> view_depth{};
  /// The distance from the eye along the ray through the pixel's centre. For an orthographic camera
  /// it is `view_depth`.
  ImageView<float> distance{};
  /// The base colour before lighting, in linear light with straight alpha: the material's factor
  /// times its texture and the vertex colours, with a fragment's own alpha; without any of these
  /// the light of (0.8, 0.7, 0.6). FrameOptions::opacity does not count. 0 where nothing is.
  ImageView<Vec4> albedo{};
  /// The numbers that the geometry has there (MeshView::scalars), interpolated in float64; NaN
  /// where there are none, and where nothing is.
  ImageView<float> scalars{};
  /// The colours of Shader::material before the transfer function: linear light, premultiplied,
  /// over the background, not cut to 1. A frame with this target blends in linear light. Its other
  /// colours keep their bits, but with several samples the mean is one of linear light.
  ImageView<Vec4> linear{};

  /// Visibility keys (docs/coverage.md), for pictures drawn in several passes (Pass::load).
  ImageView<std::uint64_t> keys{};

  /// 255 where a method that is added (paper 4's depth filter) blended in a wrong order, and where
  /// `exact` had to sort what its filter could not hold; else 0.
  ImageView<std::uint8_t> errors{};

  /// Further outputs of the shader (program.hpp), as it returns them; 0 where nothing is. Like the
  /// other targets they must have the frame's size.
  std::span<const ImageView<Vec4>> extra{};
};

/// How a frame adds to what its targets hold. By default it does not: it fills them anew.
struct Pass {
  /// Begins from the keys that earlier passes have left in Targets::keys, and changes only pixels
  /// where it is nearer (but Shader::depth: all colours, by the depths of all passes). Throws
  /// Error{invalid_argument} for keys of primitives from `first_id` on.
  bool load = false;
  /// The first id of this pass: the number of primitives in the passes before.
  std::uint64_t first_id = 0;
  /// The targets hold a picture, with its reversed depth in Targets::depth (0 where nothing is).
  /// Only nearer fragments are drawn, so at equal depths the picture wins, as if submitted first.
  /// They are blended over `color8` and `color`; pixels that nothing reaches stay as they are.
  bool over = false;
};

/// Figures of a frame: its primitives, memory, time and what drew it.
struct FrameStats {
  struct Triangles {
    std::uint64_t input = 0;    ///< as submitted
    std::uint64_t dropped = 0;  ///< with a NaN or infinite vertex
    std::uint64_t culled = 0;   ///< facing away, without area, outside the view or between samples
    std::uint64_t clipped = 0;  ///< cut by the near plane or the guard band
    std::uint64_t drawn = 0;    ///< input − dropped − culled, before any early rejection
  } triangles;
  /// Samples that triangles cover. Pieces that hierarchical Z hides before their samples are looked
  /// for do not count, so the sum of Targets::overdraw may be larger.
  std::uint64_t fragments = 0;
  std::uint64_t pixels_covered = 0;  ///< pixels that hold a surface at the end
  std::uint64_t peak_bytes = 0;      ///< scratch, beyond the caller's arrays and images
  std::vector<StageTime> stages;     ///< one after the other; they add up to the frame
  double frame_ms = 0;
  Isa isa = Isa::scalar;
  std::string rasterizer, visibility;
  std::string why;     ///< why `auto` took these two
  std::string shader;  ///< the built-in one, as named on the command line; empty: a caller's own
  Device device = Device::threads;
  std::string device_why;  ///< why Device::automatic took it, or why not Device::cuda
  /// The work that only this rasterizer has: rows, bins, tile pairs, …
  std::vector<std::pair<std::string, std::uint64_t>> counters;
};

}  // namespace rastrum
