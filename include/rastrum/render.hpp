// SPDX-License-Identifier: BSD-3-Clause
// Renders a scene: scene + camera + options → image. Draws with functions of your own: program.hpp.
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

/// The names of the shaders, as on the command line, in the order of the enum.
[[nodiscard]] std::vector<std::string_view> shader_names();
/// Throws Error{invalid_argument}, which lists the names, for any other name.
[[nodiscard]] Shader shader_from_name(std::string_view name);
/// Throws Error{invalid_argument} for a value that is no Shader.
[[nodiscard]] std::string_view name(Shader shader);
/// The shader that draws `scene`: `shader` itself, or the one that `automatic` takes.
[[nodiscard]] Shader shader_for(Shader shader, const SceneView& scene);
/// The faces of an instance that `shader` leaves out, whatever FrameOptions::cull says. With
/// `material` these are the back faces of a single-sided material, as in glTF. Meshes with a
/// material for each face lose none, because they come from formats without single-sided materials.
[[nodiscard]] Cull material_cull(const InstanceView& instance, std::span<const Material> materials,
                                 Shader shader);
/// `cull` in terms of the screen, where a counter-clockwise triangle is a front. It follows the
/// instance's winding, which a mirroring transform reverses.
[[nodiscard]] Cull cull_on_screen(const InstanceView& instance, Cull cull);

/// Options of a renderer, which hold for all its frames.
struct RendererOptions {
  std::uint64_t memory_limit = 0;  ///< bytes of scratch beside scene and images; 0: no limit
  /// Renderer::options() has what `automatic` took. If that is a GPU, each frame that the threads
  /// are expected to draw sooner is left to them; FrameStats::device_why has the figures.
  Device device = Device::threads;
  int threads = 0;           ///< 0: all
  std::optional<Isa> isa{};  ///< none: the best this machine has

  bool operator==(const RendererOptions&) const = default;
};

/// How one frame is to look.
struct FrameOptions {
  int width = 1280, height = 720;
  Shader shader = Shader::automatic;  ///< FrameStats::shader says what was taken
  /// `none` draws all faces, but Shader::material leaves out the back of single-sided materials.
  Cull cull = Cull::none;
  Vec4 background{0, 0, 0, 0};  ///< display values, straight alpha
  /// The value of Targets::view_depth and Targets::distance where nothing is; sensors have 0.
  float no_distance = std::numeric_limits<float>::infinity();
  /// The opacity of every surface, in [0, 1]. Opaque materials, and masked ones where they are not
  /// cut out, get it as their alpha. With AlphaMode::blend (or vertex alpha without any material)
  /// it multiplies alpha.
  float opacity = 1;
  TransparencyOptions transparency{};
  int samples = 1;  ///< per pixel: 1, 4, 8 or 16, at D3D11's standard positions
  /// Planes in the world, at most kMaxClipPlanes. Only places that all of them keep are drawn and
  /// hide what lies behind. This is decided at each pixel, in float64, from the triangle that is
  /// drawn (once a pixel for a triangle, also with several samples). Sections stay open.
  std::vector<ClipPlane> clip_planes{};
  /// The lights for `lambert`, `phong`, `material` and `classic`; empty: the fixed light of each.
  /// Frames with lights are drawn by the CPU, not by a device.
  std::vector<Light> lights{};
  /// Whether opaque surfaces cast shadows of the directional `lights`, and of the spots that reach
  /// at most 84.8° from their axis. Translucent surfaces cast none; the fixed light makes none.
  bool shadows = false;
  /// The most texels across a shadow map, 64 to 8192; 0: about three times the pixels across the
  /// frame, 256 to 2048, or to 1024 where a light has several maps (docs/light_rules.md).
  int shadow_size = 0;
  /// Shadows end at this distance from the eye, along the view axis (with a parallel projection,
  /// from its near plane); 0: as far as the picture sees. Less makes near shadows finer.
  double shadow_distance = 0;
  /// The environments among `lights`, which must have one, replace `background`. They are seen
  /// where nothing is and through translucent surfaces, with `tone` blended as display values. Not
  /// for pictures that are drawn over others.
  bool environment_behind = false;
  /// How the linear light of Shader::material becomes `color8` and `color`; `linear` is not mapped.
  /// With several samples or layers their mean is mapped.
  ToneMapping tone{};
};

/// Throws Error{invalid_argument} for a number or an enum's value out of range, a background that
/// is not finite or a clip plane without a direction. Each frame begins with this check.
void check(const FrameOptions& options);

/// One of the pictures of Renderer::render_many.
struct ScenePicture {
  SceneView scene{};
  Camera camera{};
  Targets targets{};
};

struct ProgramDraw;                    // program.hpp
struct RASTRUM_INSIDE RendererAccess;  // render/access.hpp: renderers that draw in another way

/// Renders frames, each with its own options; keeps threads and scratch between them.
///
/// Threads: several threads may call its functions at once. Each call is a frame, and frames take
/// turns; with a renderer for each thread they are drawn at the same time. A caller's own vertex,
/// shading or test function may not call the renderer that calls it: that throws
/// Error{invalid_argument}. The caller leaves unchanged all that a frame in work reads and fills.
///
/// Stopping: once any thread requests a stop of `stop`, the frame throws Stopped (stop.hpp) after a
/// bounded amount of work. A frame that waits for its turn throws when that comes. The targets then
/// hold parts of the picture; the renderer remains usable.
class Renderer {
 public:
  /// Throws Error{invalid_argument} for a number out of range, Error{no_device} if there is none.
  explicit Renderer(RendererOptions options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws `scene` seen by `camera` into `targets`. Translucent surfaces (FrameOptions::opacity,
  /// AlphaMode::blend, vertex alpha) are blended unless transparency is `none`. Ids, depth and keys
  /// are those of the nearest surface, whatever its alpha. Meshes without normals are shaded with
  /// face normals (vertex_normals makes smooth ones). Cost: O(vertices + triangles + covered
  /// samples). Throws Error{invalid_argument} as check(), for an instance with an index out of
  /// range, which it names, and for a target of another size or with rows that overlap;
  /// Error{out_of_memory} with what was asked for; Stopped (above).
  FrameStats render(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                    const Targets& targets, const Pass& pass = {}, StopToken stop = {});

  /// Draws each of `pictures` as render does. Pictures of at most 512 × 512 pixels are drawn side
  /// by side, a thread each, if each thread's share of memory_limit is at least 64 MiB. Larger
  /// ones, and those of a device, come one after the other. Throws as render for one of them;
  /// others may be drawn by then.
  std::vector<FrameStats> render_many(std::span<const ScenePicture> pictures,
                                      const FrameOptions& frame, StopToken stop = {});

  /// As render in one pass, for arrays of the scene (positions, indices, normals, colours) and
  /// targets that are memory of the device that draws: CUDA's with `cuda`, of which nothing is
  /// copied; otherwise the host's, as always. The frame has a stream of its own. It comes after all
  /// work that was given to the stream `after` before the call: CUDA work that writes the arrays or
  /// reads the targets. Without `after` such work must be complete before the call. The targets are
  /// complete when the call returns. The scene has no materials and is opaque or translucent
  /// (exact, unsorted); a shader of the device draws it into color8, color, depth, ids and keys.
  /// Throws Error{unsupported} for all else.
  FrameStats render_in_place(const SceneView& scene, const Camera& camera,
                             const FrameOptions& frame, const Targets& targets, StopToken stop = {},
                             std::optional<DeviceStream> after = {});

  /// The outputs of a frame at pixel (x, y), in the same bits as the targets, without drawing all
  /// of it; none where nothing is. Cost: O(vertices + triangles), and the pixels of one bin. Throws
  /// as render(), and Error{invalid_argument} for a pixel outside the frame.
  [[nodiscard]] std::optional<Pick> pick(const SceneView& scene, const Camera& camera,
                                         const FrameOptions& frame, int x, int y,
                                         StopToken stop = {});

  /// The programmable form: draws with the caller's own vertex, shading and test functions
  /// (program.hpp), of one program or several, also with layers, samples and extra targets. Draws
  /// with kTranslucent among their flags are blended by the alpha that the functions return. The
  /// shader and the opacity of `frame` are not used. Outputs that a draw's program does not have
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

/// The short way: draws one frame and returns its colours, Targets::color8.
[[nodiscard]] Image<Rgba8> render(const SceneView& scene, const Camera& camera,
                                  const FrameOptions& frame, const RendererOptions& options = {});

}  // namespace rastrum
