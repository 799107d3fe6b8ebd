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

/// The base colour of `flat`, `lambert`, `phong` and `wireframe` is the mesh's colours, (0.8, 0.7,
/// 0.6) where it has none; with materials the base colour factor as a display value, times the
/// mesh's colours where there are some. Textures are `material`'s.
enum class Shader : std::uint8_t {
  automatic,  ///< `material` for a scene with materials, else `phong`
  flat,       ///< base colour, unlit
  depth,      ///< grey: nearest white, farthest of the picture black; whatever the opacity
  normal,     ///< (n + 1) / 2 of the world-space unit normal
  id,         ///< a hash of the triangle id as a colour
  lambert,    ///< base · (0.1 + 0.8 max(n·l, 0))
  phong,      ///< lambert + 0.3 max(n·h, 0)³²
  material,   ///< glTF metallic-roughness, textures, sRGB transfer
  wireframe,  ///< triangle edges about a pixel wide over the flat surface
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
  /// A method of another library: rastrum/family.hpp has published approximations. Read
  /// where `method` is Transparency::added.
  const AddedTransparency* added = nullptr;
  /// A pixel (a sample) is finished once it has this much alpha. 1: what lies behind is invisible
  /// anyway, so that nothing changes; paper 4 takes 1 − 1/128, for whole half-blocks.
  float alpha_threshold = 1;

  bool operator==(const TransparencyOptions&) const = default;
};

/// Images to fill; an empty view is not computed. All must have the frame's size, and memory that
/// no other target has and no array of the scene.
///
/// With several samples a pixel the colours are the mean over them. `depth`, `ids` and `keys` are
/// those of the largest key of any sample: of the nearest surface that some sample sees, with its
/// depth there, even where it covers no other. `extra` is what the shader returns for that surface
/// at the pixel's centre; where it does not cover the centre, for weights of its corners that are
/// cut to [0, 1] there, and so are the images of the surface below. `overdraw` counts samples;
/// `errors` has 255 where some sample has one.
struct Targets {
  ImageView<Rgba8> color8{};            ///< straight alpha
  ImageView<Vec4> color{};              ///< premultiplied float32
  ImageView<float> depth{};             ///< reversed depth in [0, 1], 0 where nothing is
  ImageView<std::int64_t> ids{};        ///< triangle in submission order, −1 where nothing is
  ImageView<std::uint32_t> overdraw{};  ///< fragments at each pixel

  // These describe the surface that `ids` names, at the pixel's centre, whatever the shader and its
  // alpha (docs/outputs.md). The CPU computes them from the keys, and only those that are asked
  // for. Without a scene, draws of programs have the numbers and the barycentrics.
  ImageView<std::int64_t> instances{};   ///< InstanceView::id, −1 where nothing is
  ImageView<std::int64_t> primitives{};  ///< within its instance (its draw), −1 where nothing is
  /// `ids`, `instances` and `primitives` in 32 bits. Frames whose numbers do not fit throw
  /// Error{invalid_argument}.
  ImageView<std::int32_t> ids32{}, instances32{}, primitives32{};
  /// Perspective-correct weights of the second and the third corner of the snapped triangle that
  /// was drawn: position = (1 − x − y) p0 + x p1 + y p2. (0, 0) where nothing is.
  ImageView<Vec2> barycentrics{};
  ImageView<Vec3> positions{};  ///< in the world, (0, 0, 0) where nothing is
  /// Unit length, in the world, (0, 0, 0) where nothing is: the mesh's normals interpolated as
  /// `phong` has them (the faces' where it has none), turned to the viewer.
  ImageView<Vec3> normals{};
  ImageView<Vec3> camera_normals{};  ///< the same in the camera's axes: z towards the viewer
  /// view_distance of `depth`; FrameOptions::no_distance where nothing is, as of `distance`.
  ImageView<float> view_depth{};
  /// From the eye, by `view_depth` along the ray through the pixel's centre; the same as that for
  /// an orthographic camera.
  ImageView<float> distance{};
  /// Linear light, straight alpha: the material's base colour times its texture's and the vertex
  /// colours, with a fragment's own alpha; without any of these the light of the plain colour.
  /// Before light, and without FrameOptions::opacity. 0 where nothing is.
  ImageView<Vec4> albedo{};
  /// The numbers that the geometry has there (MeshView::scalars), interpolated in float64; NaN
  /// where there are none, and where nothing is.
  ImageView<float> scalars{};
  /// Shader::material's colours in linear light, premultiplied, over the background: `color` before
  /// the transfer function, and not cut to 1. A frame with this blends in linear light; its other
  /// colours are the same bits, but with several samples, whose mean is then one of linear light.
  ImageView<Vec4> linear{};

  /// Visibility keys (docs/coverage.md), for pictures drawn in several passes (Pass::load).
  ImageView<std::uint64_t> keys{};

  /// 255 where Transparency::filter blended in a wrong order, and where `exact` had to sort what
  /// its filter could not hold; else 0.
  ImageView<std::uint8_t> errors{};

  /// Further outputs of the shader (program.hpp), as it returns them; 0 where nothing is. Like the
  /// other targets they must have the frame's size.
  std::span<const ImageView<Vec4>> extra{};
};

/// How a frame adds to what its targets hold. As it stands it does not: it fills them.
struct Pass {
  /// Begins from the keys that the passes before have left in Targets::keys, and touches only
  /// pixels where it is nearer (but Shader::depth: all colours, by the depths of all passes). Keys
  /// of primitives that are not before `first_id` are refused.
  bool load = false;
  /// Ids count from it: the number of primitives in the passes before.
  std::uint64_t first_id = 0;
  /// The targets hold a picture, by its reversed depth in Targets::depth (0 where nothing is). Only
  /// what is nearer is drawn, so of equal depths the picture's wins, as submitted first; it is
  /// blended over `color8` and `color`, and pixels that nothing reaches keep all they have.
  bool over = false;
};

/// The result of a frame beside its picture.
struct FrameStats {
  struct Triangles {
    std::uint64_t input = 0;    ///< as submitted
    std::uint64_t dropped = 0;  ///< with a NaN or infinite vertex
    std::uint64_t culled = 0;   ///< facing away, without area, outside the view or between samples
    std::uint64_t clipped = 0;  ///< cut by the near plane or the guard band
    std::uint64_t drawn = 0;    ///< input − dropped − culled, before any early rejection
  } triangles;
  /// Samples covered, over all triangles that were enumerated: where hierarchical Z hides pieces
  /// before their samples are looked for, fewer than Targets::overdraw sums up to.
  std::uint64_t fragments = 0;
  std::uint64_t pixels_covered = 0;  ///< pixels that hold a surface at the end
  std::uint64_t peak_bytes = 0;      ///< scratch, beyond the caller's mesh and images
  std::vector<StageTime> stages;     ///< one after the other; they add up to the frame
  double frame_ms = 0;
  Isa isa = Isa::scalar;
  std::string rasterizer, visibility;
  std::string why;     ///< why `auto` took them
  std::string shader;  ///< the built-in one, as named on the command line; empty: a caller's own
  Device device = Device::threads;
  std::string device_why;  ///< why Device::automatic took it, or why not Device::cuda
  /// The work that is particular to the rasterizer: rows, bins, tile pairs, …
  std::vector<std::pair<std::string, std::uint64_t>> counters;
};

}  // namespace rastrum
