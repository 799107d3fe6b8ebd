// The names of the façade: shaders and rasterizers.
#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/error.hpp>
#include <rastrum/family/blend/approximations.hpp>
#include <rastrum/family/cuda/rasterizer.hpp>
#include <rastrum/family/row.hpp>
#include <rastrum/family/visibility/layers.hpp>
#include <rastrum/raster/frame/driver.hpp>
#include <rastrum/raster/frame/fast_path.hpp>
#include <rastrum/raster/frame/reference.hpp>
#include <rastrum/render/cuda/rasterizer.hpp>
#include <rastrum/render/device_work.hpp>
#include <rastrum/render/registry.hpp>
#include <rastrum/transparency/layered_path.hpp>
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
        .append(family::coverages().front().name)
        .append(": threads own bins, whose keys stay in cache and which skip what is hidden");
  if (layers)
    text.append(text.empty() ? "" : "; ")
        .append("layers, because something is translucent or pixels have several samples");
  else if (options.visibility == "auto")
    text.append(text.empty() ? "auto takes " : "; ")
        .append(family::visibilities().front().name)
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
void check_layers(const family::CoverageRow& coverage, bool visibility_is_asked_for) {
  if (visibility_is_asked_for) refuse_visibility();
  if (coverage.owns_tiles) return;
  std::string owners;
  for (const family::CoverageRow& row : family::coverages())
    if (row.owns_tiles) owners.append(owners.empty() ? "" : ", ").append(row.name);
  throw Error(
      Errc::invalid_argument,
      std::string("transparency and several samples a pixel need a rasterizer that keeps tiles; '")
          .append(coverage.name)
          .append("' does not, these do: ")
          .append(owners));
}

/// One of two drawers, each made when a frame first needs it: keys are enough, or not.
template <class MakeKeys, class MakeLayers>
DrawFrame by_need(MakeKeys make_keys, MakeLayers make_layers) {
  using Drawer = std::shared_ptr<raster::FrameDrawer>;
  return [make_keys, make_layers, keys = Drawer(),
          layers = Drawer()](raster::FrameRequest& request) mutable {
    if (needs_layers(request)) {
      if (!layers) layers = make_layers();
      return layers->draw(request);
    }
    if (!keys) keys = make_keys();
    return keys->draw(request);
  };
}

DrawFrame make_reference(const RenderOptions& options, MemoryAccount& memory) {
  if (options.rasterizer != "auto" && options.rasterizer != kReference)
    throw Error(Errc::invalid_argument,
                std::string("the rasterizer '")
                    .append(options.rasterizer)
                    .append("' needs --device threads; serial has 'reference'"));
  return by_need(
      [&memory, limit = options.memory_limit] {
        return std::make_unique<raster::FrameDriver>(raster::make_reference(), limit, memory,
                                                     nullptr);
      },
      [&memory] {
        return std::make_unique<raster::FrameDriver>(
            transparency::make_layered_reference(family::make_blend), 0, memory, nullptr);
      });
}

constexpr std::string_view kBySize = "by-size";

/// Why the device leaves a frame to the CPU; empty where it draws it.
std::string why_not_on_cuda(const CudaRasterizer& device, const raster::FrameRequest& request) {
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
  const std::string_view atomic = family::visibilities().front().name;
  const auto& visibility =
      options.visibility == "auto"
          ? family::visibilities().front()
          : find_row(family::visibilities(), options.visibility, "visibility", "auto");
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
      find_row(family::coverages(), options.rasterizer, "rasterizer", "auto, reference, by-size");
  // Refuses sizes of bins and tiles that the host refuses.
  static_cast<void>(coverage.make(options.tuning, memory));
  if (coverage.name == family::coverages().front().name)
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
               : std::shared_ptr<CudaRasterizer>(
                     chosen.coverage.empty()
                         ? make_cuda_rasterizer(options.memory_limit, memory, threads)
                         : family::make_cuda_rasterizer(chosen.coverage, chosen.visibility,
                                                        options.memory_limit, memory, threads)),
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
    for (const family::CoverageRow& row : family::coverages())
      list.push_back({std::string(row.name), std::string(row.description)});
    return list;
  }();
  return infos;
}

const std::vector<AxisInfo>& visibilities() {
  static const std::vector<AxisInfo> infos = [] {
    std::vector<AxisInfo> list;
    for (const family::Visibility& row : family::visibilities())
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
          ? family::coverages().front()
          : find_row(family::coverages(), options.rasterizer, "rasterizer", "auto, reference");
  const auto& visibility =
      options.visibility == "auto"
          ? family::visibilities().front()
          : find_row(family::visibilities(), options.visibility, "visibility", "auto");
  const bool is_asked_for = options.visibility != "auto";
  // Refuses tunings that were not compiled.
  static_cast<void>(coverage.make(options.tuning, memory));
  // The renderer's own path is the table's first point.
  const bool is_first = coverage.name == family::coverages().front().name;
  const bool is_fast = is_first && visibility.name == family::visibilities().front().name &&
                       options.hierarchical_z &&
                       options.tuning.order == raster::BlockOrder::row_major;
  const auto drive = [&memory, threads,
                      limit = options.memory_limit](std::unique_ptr<raster::Method> method) {
    return std::make_unique<raster::FrameDriver>(std::move(method), limit, memory, threads);
  };
  const DrawFrame draw = by_need(
      [=, &memory, &coverage, &visibility, tuning = options.tuning] {
        return drive(is_fast ? raster::make_fast_path(memory)
                             : family::make_row(coverage, visibility, tuning, memory));
      },
      [=, &memory, &coverage, tuning = options.tuning] {
        check_layers(coverage, is_asked_for);
        return drive(is_first ? transparency::make_layered_path(memory, family::make_blend)
                              : family::make_row(coverage, family::layers(), tuning, memory));
      });
  return [draw, why_keys = why(options, false),
          why_layers = why(options, true)](raster::FrameRequest& request) mutable {
    FrameStats stats = draw(request);
    stats.why = needs_layers(request) ? why_layers : why_keys;
    return stats;
  };
}

}  // namespace rastrum
