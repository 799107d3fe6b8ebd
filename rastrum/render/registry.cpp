// The names of the façade: shaders and rasterizers.
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/error.hpp>
#include <rastrum/raster/cuda/rasterizer.hpp>
#include <rastrum/raster/frame/rasterizer.hpp>
#include <rastrum/raster/frame/reference.hpp>
#include <rastrum/render/device_work.hpp>
#include <rastrum/render/registry.hpp>
#include <rastrum/transparency/layers.hpp>
#include <rastrum/transparency/reference.hpp>

namespace rastrum {
namespace {

constexpr std::array<std::string_view, 9> kShaderNames{
    "auto", "flat", "depth", "normal", "id", "lambert", "phong", "material", "wireframe"};

}  // namespace

std::vector<std::string_view> shader_names() {
  return {kShaderNames.begin(), kShaderNames.end()};
}

std::string_view name(Shader shader) {
  check_enum(shader, Shader::wireframe, "the shader");
  return kShaderNames[static_cast<std::size_t>(shader)];
}

Shader shader_for(Shader shader, const SceneView& scene) {
  if (shader != Shader::automatic) return shader;
  return scene.materials.empty() ? Shader::phong : Shader::material;
}

Cull material_cull(const InstanceView& instance, std::span<const Material> materials,
                   Shader shader) {
  if (shader != Shader::material || materials.empty() || !instance.mesh.face_materials.empty() ||
      materials[instance.mesh.material].double_sided)
    return Cull::none;
  const auto& m = instance.object_to_world.m;
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return determinant < 0 ? Cull::front : Cull::back;
}

Shader shader_from_name(std::string_view wanted) {
  std::string known;
  for (std::size_t i = 0; i < kShaderNames.size(); ++i) {
    if (kShaderNames[i] == wanted) return static_cast<Shader>(i);
    known += (i == 0 ? "" : ", ") + std::string(kShaderNames[i]);
  }
  throw Error(Errc::invalid_argument,
              "no shader is called '" + std::string(wanted) + "'; there are " + known);
}

namespace {

constexpr std::string_view kReference = "reference";

/// The row of that name; throws with what there is.
template <class Row>
const Row& find_row(std::span<const Row> rows, std::string_view wanted, std::string_view what,
                    std::string known) {
  for (const Row& row : rows) {
    if (row.name == wanted) return row;
    known.append(", ").append(row.name);
  }
  throw Error(Errc::invalid_argument, std::string("no ")
                                          .append(what)
                                          .append(" is called '")
                                          .append(wanted)
                                          .append("'; there are ")
                                          .append(known));
}

/// One choice for all frames: on no row of `rastrum bench auto` another pair was faster by enough
/// to choose by it (docs/decisions/0010).
std::string why(const RenderOptions& options, bool layers) {
  std::string text;
  if (options.rasterizer == "auto")
    text.append("auto takes ")
        .append(raster::coverages().front().name)
        .append(": threads own bins, whose keys stay in cache and which skip what is hidden");
  if (layers)
    text.append(text.empty() ? "" : "; ")
        .append("layers, because something is translucent or pixels have several samples");
  else if (options.visibility == "auto")
    text.append(text.empty() ? "auto takes " : "; ")
        .append(raster::visibilities().front().name)
        .append(": a plain maximum where a thread owns the keys, and shading once a pixel");
  return text.empty() ? "as asked for" : text;
}

/// Whether keys are not enough: something is translucent, or pixels have several samples.
bool needs_layers(const raster::FrameRequest& request) {
  return request.samples > 1 || blends(request.draws, request.transparency);
}

[[noreturn]] void refuse_visibility() {
  throw Error(Errc::invalid_argument,
              "transparency and several samples a pixel resolve fragments in their own way: "
              "leave the visibility to 'auto'");
}

/// Layers want a thread that owns a tile, and are a visibility themselves.
void check_layers(const raster::CoverageRow& coverage, bool visibility_is_asked_for) {
  if (visibility_is_asked_for) refuse_visibility();
  if (coverage.owns_tiles) return;
  std::string owners;
  for (const raster::CoverageRow& row : raster::coverages())
    if (row.owns_tiles) owners.append(owners.empty() ? "" : ", ").append(row.name);
  throw Error(
      Errc::invalid_argument,
      std::string("transparency and several samples a pixel need a rasterizer that keeps tiles; '")
          .append(coverage.name)
          .append("' does not, these do: ")
          .append(owners));
}

DrawFrame make_reference(const RenderOptions& options, MemoryAccount& memory) {
  if (options.rasterizer != "auto" && options.rasterizer != kReference)
    throw Error(Errc::invalid_argument,
                std::string("the rasterizer '")
                    .append(options.rasterizer)
                    .append("' needs --device threads; serial has 'reference'"));
  return [&memory](raster::FrameRequest& request) {
    return needs_layers(request) ? transparency::render_reference(request, memory)
                                 : raster::render_reference(request, memory);
  };
}

constexpr std::string_view kBySize = "by-size";

/// Why the device leaves a frame to the CPU; empty where it draws it.
std::string why_not_on_cuda(const raster::CudaRasterizer& device,
                            const raster::FrameRequest& request) {
  if (std::string why = device.why_no_test(request); !why.empty()) return why;
  return needs_layers(request) ? device.why_no_layers(request) : std::string();
}

/// What the options name of a device's rasterizers: a point of the table, or by-size.
struct OnCuda {
  std::string_view coverage, visibility;  ///< empty: by-size
  std::string why;                        ///< auto took it, or the CPU draws it
  bool is_the_cpus = false;
};

OnCuda choose_on_cuda(const RenderOptions& options, MemoryAccount& memory) {
  const std::string_view atomic = raster::visibilities().front().name;
  const auto& visibility =
      options.visibility == "auto"
          ? raster::visibilities().front()
          : find_row(raster::visibilities(), options.visibility, "visibility", "auto");
  if (options.rasterizer == kBySize && visibility.name != atomic)
    throw Error(Errc::invalid_argument, std::string("by-size draws by '")
                                            .append(atomic)
                                            .append("'; leave the rasterizer to 'auto' for the "
                                                    "visibility '")
                                            .append(visibility.name)
                                            .append("'"));
  if (options.rasterizer == kBySize || (options.rasterizer == "auto" && visibility.name == atomic))
    return {};
  if (options.rasterizer == "auto")
    return {"hybrid", visibility.name, "auto takes hybrid, for by-size has no other visibility"};
  const auto& coverage =
      find_row(raster::coverages(), options.rasterizer, "rasterizer", "auto, reference, by-size");
  // Refuses sizes of bins and tiles that the host refuses.
  static_cast<void>(coverage.make(options.tuning, memory));
  if (coverage.name == raster::coverages().front().name)
    return {{}, {}, "'grouped' keeps its groups and bins in a core's cache: it is the CPU's", true};
  if (options.tuning.schedule == raster::Schedule::persistent)
    return {{}, {}, "the persistent schedule of 'binned' is the CPU's", true};
  return {coverage.name, visibility.name, {}};
}

/// The device's rasterizers, and for what they have no code, or `automatic` expects to be done
/// sooner there, a rasterizer of the CPU.
DrawFrame make_on_cuda(const RenderOptions& options, MemoryAccount& memory,
                       parallel::Threads& threads, const std::string& automatic_why) {
  const OnCuda chosen = choose_on_cuda(options, memory);
  RenderOptions on_threads = options;
  on_threads.device = Device::threads;
  if (options.rasterizer == kBySize) on_threads.rasterizer = "auto";
  return
      [device =
           chosen.is_the_cpus
               ? nullptr
               : std::shared_ptr<raster::CudaRasterizer>(raster::make_cuda_rasterizer(
                     chosen.coverage, chosen.visibility, options.memory_limit, memory, threads)),
       host = DrawFrame(), on_threads, why = chosen.why, &memory, &threads,
       there = DeviceChoice{Device::cuda, automatic_why}](raster::FrameRequest& request) mutable {
        if (needs_layers(request) && on_threads.visibility != "auto") refuse_visibility();
        DeviceChoice choice{Device::threads, device ? why_not_on_cuda(*device, request) : why};
        if (choice.why.empty())
          choice = there.why.empty() || request.in_place
                       ? there
                       : choose_device(there, device_work(request), threads.concurrency());
        if (choice.device == Device::cuda) {
          FrameStats stats = device->render(request);
          if (!why.empty()) stats.why = std::string(why).append("; ").append(stats.why);
          if (stats.device_why.empty()) stats.device_why = std::move(choice.why);
          return stats;
        }
        if (request.in_place)
          throw Error(Errc::unsupported,
                      std::string("arrays in the device's memory (in_place): ").append(choice.why));
        if (!host) host = make_rasterizer(on_threads, memory, &threads);
        FrameStats stats = host(request);
        stats.device = Device::threads;
        stats.device_why = std::move(choice.why);
        return stats;
      };
}

}  // namespace

bool blends(std::span<const raster::Draw> draws, const TransparencyOptions& options) {
  return options.method != Transparency::none &&
         std::ranges::any_of(draws, [](const raster::Draw& d) {
           return (d.any_flags() & raster::kTranslucent) != 0;
         });
}

const std::vector<AxisInfo>& rasterizers() {
  static const std::vector<AxisInfo> infos = [] {
    std::vector<AxisInfo> list{{std::string(kReference),
                                "rows of triangles in order into one visibility buffer; one "
                                "thread, plain C++"}};
    for (const raster::CoverageRow& row : raster::coverages())
      list.push_back({std::string(row.name), std::string(row.description)});
    return list;
  }();
  return infos;
}

const std::vector<AxisInfo>& visibilities() {
  static const std::vector<AxisInfo> infos = [] {
    std::vector<AxisInfo> list;
    for (const raster::Visibility& row : raster::visibilities())
      list.push_back({std::string(row.name), std::string(row.description)});
    return list;
  }();
  return infos;
}

DrawFrame make_rasterizer(const RenderOptions& options, MemoryAccount& memory,
                          parallel::Threads* threads, const std::string& automatic_why) {
  if (threads == nullptr) return make_reference(options, memory);
  if (options.device == Device::cuda) return make_on_cuda(options, memory, *threads, automatic_why);
  const auto& coverage =
      options.rasterizer == "auto"
          ? raster::coverages().front()
          : find_row(raster::coverages(), options.rasterizer, "rasterizer", "auto, reference");
  const auto& visibility =
      options.visibility == "auto"
          ? raster::visibilities().front()
          : find_row(raster::visibilities(), options.visibility, "visibility", "auto");
  const auto make = [&memory, threads, &coverage, tuning = options.tuning,
                     limit = options.memory_limit](const raster::Visibility& by) {
    return std::make_shared<raster::Rasterizer>(coverage, by, tuning, limit, memory, *threads);
  };
  const bool is_asked_for = options.visibility != "auto";
  return [rasterizer = make(visibility), layered = std::shared_ptr<raster::Rasterizer>(), make,
          &coverage, is_asked_for, why_keys = why(options, false),
          why_layers = why(options, true)](raster::FrameRequest& request) mutable {
    const bool layers = needs_layers(request);
    if (layers) {
      check_layers(coverage, is_asked_for);
      if (!layered) layered = make(transparency::layers());
    }
    FrameStats stats = (layers ? layered : rasterizer)->render(request);
    stats.why = layers ? why_layers : why_keys;
    return stats;
  };
}

}  // namespace rastrum
