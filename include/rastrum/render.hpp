// SPDX-License-Identifier: BSD-3-Clause
// The façade: scene + camera + options → image. Draws of functions of your own: program.hpp.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/device.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/held.hpp>
#include <rastrum/image.hpp>
#include <rastrum/light.hpp>
#include <rastrum/pick.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/tone.hpp>

namespace RASTRUM_API rastrum {

/// The names as on the command line, in the order of the enum.
[[nodiscard]] std::vector<std::string_view> shader_names();
/// Throws Error{invalid_argument} that lists the names.
[[nodiscard]] Shader shader_from_name(std::string_view name);
/// Throws Error{invalid_argument} for a value that is none.
[[nodiscard]] std::string_view name(Shader shader);
/// The shader that draws `scene`: `shader`, or the one that `automatic` takes.
[[nodiscard]] Shader shader_for(Shader shader, const SceneView& scene);
/// The faces of an instance that `shader` leaves out, whatever FrameOptions::cull says: with
/// `material` the back faces of a single-sided material, as in glTF. Meshes with a material for
/// each face come from formats without single-sided materials.
[[nodiscard]] Cull material_cull(const InstanceView& instance, std::span<const Material> materials,
                                 Shader shader);
/// `cull` for an instance in terms of the screen, where a counter-clockwise triangle is a front: it
/// follows the instance's winding, which a mirroring transform turns.
[[nodiscard]] Cull cull_on_screen(const InstanceView& instance, Cull cull);

/// Options of a renderer, which hold for all its frames.
struct RendererOptions {
  std::uint64_t memory_limit = 0;  ///< bytes of scratch beyond the mesh and the images; 0: none
  /// options() of a Renderer has what `automatic` took. With a GPU there, each frame that the
  /// threads are expected to draw sooner is left to them: FrameStats::device_why has the figures.
  Device device = Device::threads;
  int threads = 0;           ///< 0: all
  std::optional<Isa> isa{};  ///< none: the best this machine has

  bool operator==(const RendererOptions&) const = default;
};

/// How one frame is to look.
struct FrameOptions {
  int width = 1280, height = 720;
  Shader shader = Shader::automatic;  ///< FrameStats::shader says what was taken
  /// none: all faces, but with Shader::material the back of single-sided materials is left out.
  Cull cull = Cull::none;
  Vec4 background{0, 0, 0, 0};  ///< display values, straight alpha
  /// Targets::view_depth and Targets::distance where nothing is; sensors have 0.
  float no_distance = std::numeric_limits<float>::infinity();
  /// The opacity of every surface, in [0, 1]: opaque materials get it as their alpha, masked ones
  /// where they are not cut out, and with AlphaMode::blend (or vertex alpha without any material)
  /// it multiplies alpha.
  float opacity = 1;
  TransparencyOptions transparency{};
  int samples = 1;  ///< a pixel: 1, 4, 8 or 16, at D3D11's standard positions
  /// In the world, at most kMaxClipPlanes. Only places that all of them keep are drawn and hide
  /// what lies behind. This is decided at each pixel (for a triangle once a pixel where there are
  /// several samples) in float64 from the triangle that is drawn; sections stay open.
  std::vector<ClipPlane> clip_planes{};
  /// The lights for `lambert`, `phong` and `material`; empty: the fixed light of each. The CPU
  /// draws frames with lights, not a device.
  std::vector<Light> lights{};
  /// Whether opaque surfaces cast shadows of the directional `lights`, and of the spots that reach
  /// at most 84.8° from their axis. Translucent surfaces cast none; the fixed light has none.
  bool shadows = false;
  /// The most texels across a shadow map, 64 to 8192; 0: about three times the pixels across the
  /// frame, 256 to 2048, or to 1024 where a light has several maps (docs/light_rules.md).
  int shadow_size = 0;
  /// Shadows end at this distance from the eye, along the view axis (with a parallel projection,
  /// from its near plane); 0: as far as the picture sees. Less makes near shadows finer.
  double shadow_distance = 0;
  /// The environments among `lights`, which must have one, replace `background`: they are seen
  /// where nothing is and through translucent surfaces; with `tone`, blended as display values. Not
  /// for pictures that are drawn over others.
  bool environment_behind = false;
  /// How the linear light of Shader::material becomes `color8` and `color`; `linear` is not mapped.
  /// The mean of several samples or layers is mapped.
  ToneMapping tone{};
};

/// Throws Error{invalid_argument} for a number or an enum's value out of range, a background that
/// is not finite and a clip plane without a direction. Each frame begins with this check.
void check(const FrameOptions& options);

struct ProgramDraw;                    // program.hpp
struct RASTRUM_INSIDE RendererAccess;  // render/access.hpp: renderers that draw in another way

/// Renders frames, each with options of its own; keeps threads and scratch between them.
///
/// Threads: several may call its functions at once; each call is a frame, and they take turns (a
/// renderer for each thread draws them at the same time). A caller's own vertex, shading or test
/// function may not call the renderer that calls it: that throws Error{invalid_argument}. The
/// caller keeps all that a frame reads and fills unchanged meanwhile.
///
/// Stopping: once any thread requests a stop of `stop`, the frame throws Stopped
/// (stop.hpp) after a bounded amount of work; a frame that waits for its turn throws when that
/// comes. Its targets then hold parts of the picture; the renderer remains usable.
class Renderer {
 public:
  /// Throws Error{invalid_argument} for a number out of range, Error{no_device}.
  explicit Renderer(RendererOptions options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws `scene` seen by `camera` into `targets`. Translucent surfaces (FrameOptions::opacity,
  /// AlphaMode::blend, vertex alpha) are blended unless transparency is `none`; ids, depth and keys
  /// are those of the nearest surface, whatever its alpha. Meshes without normals are shaded with
  /// face normals (see vertex_normals for smooth ones). Cost: O(vertices + triangles + covered
  /// samples). Throws Error{invalid_argument} as check(), or naming an instance whose index is out
  /// of range, or a target of another size or whose rows overlap, Error{out_of_memory} with what
  /// was asked for, Stopped (above).
  FrameStats render(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                    const Targets& targets, const Pass& pass = {}, StopToken stop = {});

  /// The same in one pass where the scene's arrays (positions, indices, normals, colours) and the
  /// targets are memory of the device that draws: with `cuda` CUDA's, of which nothing is copied,
  /// else the host's, as always. The frame is drawn on a stream of its own, after all work that was
  /// given to the stream `after` before the call: those of CUDA that write the arrays or read the
  /// targets. Without one such work must be complete before the call. When it returns the targets
  /// are complete. For scenes without materials, opaque or translucent (exact, unsorted), by a
  /// shader of the device, into color8, color, depth, ids and keys; throws Error{unsupported} for
  /// what else is asked for.
  FrameStats render_in_place(const SceneView& scene, const Camera& camera,
                             const FrameOptions& frame, const Targets& targets, StopToken stop = {},
                             std::optional<DeviceStream> after = {});

  /// The outputs of a frame at pixel (x, y), without drawing all of it, in the same bits as the
  /// targets; none where nothing is. Cost: O(vertices + triangles), and the pixels of one bin.
  /// Throws as render(), and Error{invalid_argument} for a pixel outside of the frame.
  [[nodiscard]] std::optional<Pick> pick(const SceneView& scene, const Camera& camera,
                                         const FrameOptions& frame, int x, int y,
                                         StopToken stop = {});

  /// The programmable form: draws with vertex, shading and test functions of a caller's own
  /// (program.hpp), of one program or several, with layers, samples and extra targets too. Draws
  /// whose flags have kTranslucent are blended by the alpha that the functions return; of
  /// `frame` the shader and the opacity are not used. Outputs that a draw's program does not have
  /// are 0. Throws as render(), naming the draw.
  FrameStats draw(std::span<const ProgramDraw> draws, const FrameOptions& frame,
                  const Targets& targets, const Pass& pass = {}, StopToken stop = {});

  [[nodiscard]] const RendererOptions& options() const;

 private:
  friend struct RendererAccess;
  struct RASTRUM_INSIDE Impl;
  explicit Renderer(Owner<Impl> impl);
  Held<Owner<Impl>> impl_;
};

/// One frame; the short way.
[[nodiscard]] Image<Rgba8> render(const SceneView& scene, const Camera& camera,
                                  const FrameOptions& frame, const RendererOptions& options = {});

}  // namespace rastrum
