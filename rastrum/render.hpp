// The façade: scene + camera + options → image. Draws of functions of your own: program.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
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
#include <rastrum/tone.hpp>

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
/// What `shader` leaves out of an instance, whatever FrameOptions::cull. glTF: with `material` the
/// back faces of a single-sided material are not seen. Meshes whose faces have materials of their
/// own come from formats without that notion.
[[nodiscard]] Cull material_cull(const InstanceView& instance, std::span<const Material> materials,
                                 Shader shader);
/// Which side of an instance's triangles `cull` leaves out on the screen, where a counter-clockwise
/// one is a front: by its winding, which a mirroring transform turns.
[[nodiscard]] Cull cull_on_screen(const InstanceView& instance, Cull cull);

/// What lives longer than a frame.
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
  /// Of every surface, in [0, 1]: opaque materials get it as their alpha, masked ones where they
  /// are not cut out, and with AlphaMode::blend (or vertex alpha without any material) it
  /// multiplies alpha.
  float opacity = 1;
  TransparencyOptions transparency{};
  int samples = 1;  ///< a pixel: 1, 4, 8 or 16, at D3D11's standard positions
  /// In the world, at most kMaxClipPlanes: what one of them does not keep is not there, nor does it
  /// hide what lies behind. Decided at each pixel (a triangle's once a pixel where there are
  /// several samples) in float64 from the triangle that is drawn; sections stay open.
  std::vector<ClipPlane> clip_planes{};
  /// What lights the scene for `lambert`, `phong` and `material`; empty: the fixed light of each.
  /// The CPU's: frames with lights are not drawn by a device.
  std::vector<Light> lights{};
  /// What stands in the way of directional lights, and of spots that reach at most 84.8° from their
  /// axis, takes their light; of what is translucent all of it. Of `lights` alone.
  bool shadows = false;
  /// Texels across a light's picture at most, 64 to 8192; 0: some three times the pixels across
  /// the frame, 256 to 2048, to 1024 where a light has several pictures (docs/light.md).
  int shadow_size = 0;
  /// How far from the eye something is in shadow, along the view axis (of a parallel projection
  /// from its near plane); 0: as far as the picture sees. Less makes what is near finer.
  double shadow_distance = 0;
  /// The environments among `lights`, which must have one, are seen where nothing is and through
  /// what is translucent, in the place of `background`: with `tone`, blended as display values.
  /// Not of pictures that are drawn over others.
  bool environment_behind = false;
  /// Of Shader::material: how its linear light becomes `color8` and `color`; `linear` is without.
  /// Where several samples or layers meet, their mean is mapped.
  ToneMapping tone{};
};

/// Throws Error{invalid_argument} for a number or an enum's value out of range, a background that
/// is not finite and a clip plane without a direction: what each frame begins with, for who wants
/// to know before.
void check(const FrameOptions& options);

namespace raster {
struct ProgramDraw;
}

/// Renders frames, each with options of its own; keeps threads and scratch between them.
///
/// Threads: its functions may be called by several at once; each call is a frame of its own, one
/// after the other (a renderer for each thread draws them at the same time). Not from within a
/// frame, by a caller's own vertex, shading or test function: that waits for itself. What a frame
/// reads and fills is the caller's to keep still meanwhile.
///
/// Stopping: a frame whose `stop` is asked to stop, by any thread, throws parallel::Stopped
/// (stop.hpp) after a bounded amount of work; one that waits for its turn throws when that comes.
/// Its targets then hold parts of the picture; the renderer is as good as before.
class Renderer {
 public:
  /// Throws Error{invalid_argument} for a number out of range, Error{no_device}.
  explicit Renderer(RendererOptions options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws `scene` seen by `camera` into `targets`. What is translucent (FrameOptions::opacity,
  /// AlphaMode::blend, vertex alpha) is blended unless transparency is `none`; ids, depth and keys
  /// are those of the nearest surface, whatever its alpha.
  /// Meshes without normals are shaded with face normals (see vertex_normals for smooth ones).
  /// Cost: O(vertices + triangles + covered samples). Throws Error{invalid_argument} as check(), or
  /// naming an instance whose index is out of range, or a target of another size or whose rows
  /// overlap, Error{out_of_memory} with what was asked for, parallel::Stopped (above).
  FrameStats render(const SceneView& scene, const Camera& camera, const FrameOptions& frame,
                    const Targets& targets, std::stop_token stop = {});

  /// The same where the scene's arrays (positions, indices, normals, colours) and the targets are
  /// memory of the device that draws: with `cuda` CUDA's, of which nothing is copied, else the
  /// host's, as always. The frame is drawn on a stream of its own, after all work that was given to
  /// the stream `after` before the call: those of CUDA that write the arrays or read the targets.
  /// Without one such work must be complete before the call. When it returns the targets are
  /// complete.
  /// For scenes without materials, opaque or translucent (exact, unsorted), by a shader of the
  /// device, into color8, color, depth, ids and keys; throws Error{unsupported} for what else is
  /// asked for.
  FrameStats render_in_place(const SceneView& scene, const Camera& camera,
                             const FrameOptions& frame, const Targets& targets,
                             std::stop_token stop = {}, std::optional<DeviceStream> after = {});

  /// What a frame shows at pixel (x, y), without drawing it whole; none where nothing is. Of the
  /// same bits as the frame's targets. Cost: O(vertices + triangles), and the pixels of one bin.
  /// Throws as render(), and Error{invalid_argument} for a pixel outside of the frame.
  [[nodiscard]] std::optional<Pick> pick(const SceneView& scene, const Camera& camera,
                                         const FrameOptions& frame, int x, int y,
                                         std::stop_token stop = {});

  /// The programmable form: draws with vertex, shading and test functions of a caller's own
  /// (program.hpp), of one program or several, with layers, samples and extra targets too. Draws
  /// whose flags have raster::kTranslucent are blended by the alpha that the functions return; of
  /// `frame` the shader and the opacity are not used. Outputs that a draw's program does not have
  /// are 0. Throws as render(), naming the draw.
  FrameStats draw(std::span<const raster::ProgramDraw> draws, const FrameOptions& frame,
                  const Targets& targets, std::stop_token stop = {});

  [[nodiscard]] const RendererOptions& options() const;

 private:
  friend struct RendererAccess;  // render/access.hpp: renderers that draw in another way
  struct Impl;
  explicit Renderer(std::unique_ptr<Impl> impl);
  Held<std::unique_ptr<Impl>> impl_;
};

/// One frame; the short way.
[[nodiscard]] Image<Rgba8> render(const SceneView& scene, const Camera& camera,
                                  const FrameOptions& frame, const RendererOptions& options = {});

}  // namespace rastrum
