// The façade: scene + camera + options → image.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/core/image.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/frame/options.hpp>
#include <rastrum/scene/scene.hpp>

namespace rastrum {

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
/// The names as on the command line, in the order of the enum.
[[nodiscard]] std::vector<std::string_view> shader_names();
/// Throws Error{invalid_argument} that lists the names.
[[nodiscard]] Shader shader_from_name(std::string_view name);
/// Throws Error{invalid_argument} for a value that is none.
[[nodiscard]] std::string_view name(Shader shader);
/// What `shader` is for `scene`: itself, or what `automatic` takes.
[[nodiscard]] Shader shader_for(Shader shader, const SceneView& scene);
/// What `shader` leaves out of an instance, whatever RenderOptions::cull. glTF: with `material` the
/// back faces of a single-sided material are not seen; a mirroring transform turns them. Meshes
/// whose faces have materials of their own come from formats without that notion.
[[nodiscard]] Cull material_cull(const InstanceView& instance, std::span<const Material> materials,
                                 Shader shader);

/// A named way to find what triangles cover (`--rasterizer`) or to resolve the fragments of a pixel
/// (`--visibility`): the two axes of the family's table.
struct AxisInfo {
  std::string name, description;
};
/// `reference`, the plain one, then those that combine with every visibility.
[[nodiscard]] const std::vector<AxisInfo>& rasterizers();
/// The first is the default.
[[nodiscard]] const std::vector<AxisInfo>& visibilities();

struct RenderOptions {
  int width = 1280, height = 720;
  std::string rasterizer = "auto";
  std::string visibility = "auto";
  raster::Tuning tuning{};         ///< of the rasterizer
  std::uint64_t memory_limit = 0;  ///< bytes of scratch beyond the mesh and the images; 0: none
  bool hierarchical_z = true;      ///< where the rasterizer has it; changes no pixel
  /// options() of a Renderer has what `automatic` took. With a GPU there, each frame that the
  /// threads are expected to draw sooner is left to them: FrameStats::device_why has the figures.
  Device device = Device::threads;
  int threads = 0;  ///< 0: all
  /// The scene's arrays (positions, indices, normals, colours) and the targets are memory of the
  /// device that draws: with `cuda` CUDA's, of which nothing is copied, else the host's, as always.
  /// For opaque scenes without materials, by a shader of the device; Renderer::render says what
  /// not.
  bool in_place = false;
  std::optional<Isa> isa{};           ///< none: the best this machine has
  Shader shader = Shader::automatic;  ///< FrameStats::shader says what was taken
  /// none: all faces, but with Shader::material the back of single-sided materials is left out.
  Cull cull = Cull::none;
  Vec4 background{0, 0, 0, 0};  ///< display values, straight alpha
  /// Of every surface, in [0, 1]: opaque materials get it as their alpha, masked ones where they
  /// are not cut out, and with AlphaMode::blend (or vertex alpha without any material) it
  /// multiplies alpha.
  float opacity = 1;
  TransparencyOptions transparency{};
  int samples = 1;  ///< a pixel: 1, 4, 8 or 16, at D3D11's standard positions
};

/// Renders frames with one set of options; keeps threads and scratch between frames.
///
/// Threads: render() and draw() may be called by several at once; each call is a frame of its own,
/// one after the other (a renderer for each thread draws them at the same time). Not from within a
/// frame, by a caller's own vertex, shading or test function: that waits for itself. What a frame
/// reads and fills is the caller's to keep still meanwhile.
///
/// Stopping: a frame whose `stop` is asked to stop, by any thread, throws parallel::Stopped
/// (parallel/stop.hpp) after a bounded amount of work; one that waits for its turn throws when that
/// comes. Its targets then hold parts of the picture; the renderer is as good as before.
class Renderer {
 public:
  /// Throws Error{invalid_argument} for a size, name, number or enum's value out of range and a
  /// background that is not finite, Error{no_device}.
  explicit Renderer(RenderOptions options);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws `scene` seen by `camera` into `targets`. What is translucent (RenderOptions::opacity,
  /// AlphaMode::blend, vertex alpha) is blended unless transparency is `none`; ids, depth and keys
  /// are those of the nearest surface, whatever its alpha.
  /// Meshes without normals are shaded with face normals (see vertex_normals for smooth ones).
  /// Cost: O(vertices + triangles + covered samples). Throws Error{invalid_argument} naming an
  /// instance whose index is out of range, or a target of another size or whose rows overlap,
  /// Error{out_of_memory} with what was asked for, Error{unsupported} for what
  /// RenderOptions::in_place has not, parallel::Stopped (above).
  FrameStats render(const SceneView& scene, const Camera& camera, const Targets& targets,
                    std::stop_token stop = {});

  /// The programmable form: draws of any vertex source with any shading (raster/draws/program.hpp
  /// makes both from a caller's functions) and a fragment test for the draws that ask for it: each
  /// by its own (Draw::shading, Draw::test), where it has none by `shading` and `test`.
  /// So programs and built-in shaders meet in one frame, with layers, samples and extra targets
  /// too; outputs that a draw's shader does not have are 0. Draws whose flags have
  /// raster::kTranslucent are blended by the alpha that the shader returns; opacity is the shader's
  /// business here. Throws as render(), Error{invalid_argument} naming the draw.
  FrameStats draw(std::span<raster::Draw> draws, const raster::Shading& shading,
                  const raster::Testing& test, const Targets& targets, std::stop_token stop = {});
  /// The same where each draw has a shader of its own, as those of a Program have.
  FrameStats draw(std::span<raster::Draw> draws, const Targets& targets, std::stop_token stop = {});

  [[nodiscard]] const RenderOptions& options() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One frame with everything chosen by `options`; the short way.
[[nodiscard]] Image<Rgba8> render(const SceneView& scene, const Camera& camera,
                                  const RenderOptions& options);

}  // namespace rastrum
