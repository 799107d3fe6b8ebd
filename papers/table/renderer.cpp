// SPDX-License-Identifier: BSD-3-Clause
// The names of the family's rows, and renderers that draw by them.
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include <papers/axes/cuda_rows.hpp>
#include <papers/table/layers.hpp>
#include <papers/table/row.hpp>
#include <rastrum/core/enum.hpp>
#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/raster/frame/fast_path.hpp>
#include <rastrum/raster/frame/sampled_path.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/transparency/layered_path.hpp>

namespace rastrum::family {
namespace {

constexpr std::string_view kReference = "reference", kBySize = "by-size";

/// The row of that name. The error for an unknown name lists the known ones.
template <class Of>
const Of& find_row(std::span<const Of> rows, std::string_view wanted, std::string_view what,
                   std::string known) {
  for (const Of& row : rows) {
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

const CoverageRow& coverage_of(const Row& row, const char* others) {
  return row.rasterizer == "auto" ? coverages().front()
                                  : find_row(coverages(), row.rasterizer, "rasterizer", others);
}
const Visibility& visibility_of(const Row& row) {
  return row.visibility == "auto" ? visibilities().front()
                                  : find_row(visibilities(), row.visibility, "visibility", "auto");
}

[[noreturn]] void refuse_visibility() {
  throw Error(Errc::invalid_argument,
              "transparency and several samples a pixel resolve fragments in their own way: "
              "leave the visibility to 'auto'");
}

/// Layers need a thread that owns a tile, and they replace the visibility.
void check_layers(const CoverageRow& coverage, bool visibility_is_asked_for) {
  if (visibility_is_asked_for) refuse_visibility();
  if (coverage.owns_tiles) return;
  std::string owners;
  for (const CoverageRow& row : coverages())
    if (row.owns_tiles) owners.append(owners.empty() ? "" : ", ").append(row.name);
  throw Error(
      Errc::invalid_argument,
      std::string("transparency and several samples a pixel need a rasterizer that keeps tiles; '")
          .append(coverage.name)
          .append("' does not, these do: ")
          .append(owners));
}

/// A coverage and a visibility on the CPU's threads. The first point of the table is the renderer's
/// own path.
Ways ways_on_threads(const Row& row, MemoryAccount& memory) {
  const CoverageRow& coverage = coverage_of(row, "auto, reference");
  const Visibility& visibility = visibility_of(row);
  // Throws for tunings that the coverage does not take.
  static_cast<void>(coverage.make(row.tuning, memory));
  const bool is_first = coverage.name == coverages().front().name;
  const bool is_fast = is_first && visibility.name == visibilities().front().name &&
                       row.hierarchical_z && row.tuning.order == BlockOrder::row_major;
  const bool auto_rasterizer = row.rasterizer == "auto", auto_visibility = row.visibility == "auto";
  Ways ways{[=, &memory, &coverage, &visibility, tuning = row.tuning, hides = row.hierarchical_z] {
              return is_fast ? raster::make_fast_path(memory)
                             : make_row(coverage, visibility, tuning, hides, memory);
            },
            [=, &memory, &coverage, tuning = row.tuning, hides = row.hierarchical_z] {
              check_layers(coverage, !auto_visibility);
              return is_first ? transparency::make_layered_path(memory)
                              : make_row(coverage, layers(), tuning, hides, memory);
            }};
  // The family has no rows for samples.
  if (is_fast && auto_visibility)
    ways.samples = [&memory] { return raster::make_sampled_path(memory); };
  ways.automatic = {auto_rasterizer, auto_visibility};
  return ways;
}

/// Refuses layers, which no visibility of a device resolves.
class WithoutLayers final : public raster::FrameDrawer {
 public:
  explicit WithoutLayers(std::unique_ptr<raster::FrameDrawer> drawer)
      : drawer_(std::move(drawer)) {}
  [[nodiscard]] FrameStats draw(raster::FrameRequest& request) override {
    if (request.needs_layers()) refuse_visibility();
    return drawer_->draw(request);
  }
  [[nodiscard]] FrameStats shade(raster::FrameRequest& request,
                                 const raster::KnownBlocks& known) override {
    return drawer_->shade(request, known);
  }

 private:
  std::unique_ptr<raster::FrameDrawer> drawer_;
};

/// How a device draws a row: by a point of the table, or by by-size.
struct OnCuda {
  std::string_view coverage, visibility;  ///< empty: by-size
  std::string why;                        ///< why auto chose it, or why the CPU draws it
  bool is_the_cpus = false;
};

OnCuda choose_on_cuda(const Row& row, MemoryAccount& memory) {
  const std::string_view atomic = visibilities().front().name;
  const Visibility& visibility = visibility_of(row);
  if (row.rasterizer == kBySize && visibility.name != atomic)
    throw Error(Errc::invalid_argument, std::string("by-size draws by '")
                                            .append(atomic)
                                            .append("'; leave the rasterizer to 'auto' for the "
                                                    "visibility '")
                                            .append(visibility.name)
                                            .append("'"));
  if (row.rasterizer == kBySize || (row.rasterizer == "auto" && visibility.name == atomic))
    return {};
  if (row.rasterizer == "auto")
    return {"hybrid", visibility.name, "auto takes hybrid, for by-size has no other visibility"};
  const CoverageRow& coverage = coverage_of(row, "auto, reference, by-size");
  // Throws for sizes of bins and tiles that the host refuses too.
  static_cast<void>(coverage.make(row.tuning, memory));
  if (coverage.name == coverages().front().name)
    return {{},
            {},
            "only the CPU has 'grouped', which keeps its groups and bins in a core's cache",
            true};
  if (row.tuning.schedule == Schedule::persistent)
    return {{}, {}, "only the CPU has the persistent schedule of 'binned'", true};
  return {coverage.name, visibility.name, {}};
}

std::unique_ptr<raster::FrameDrawer> make_on_cuda(const Row& row, const DrawerOptions& options,
                                                  MemoryAccount& memory,
                                                  parallel::Threads& threads) {
  OnCuda chosen = choose_on_cuda(row, memory);
  DeviceFrames frames;
  if (chosen.is_the_cpus) {
    frames.why_host = std::move(chosen.why);
  } else {
    frames.device = make_cuda_rasterizer(chosen.coverage, chosen.visibility, row.tuning,
                                         options.memory_limit, memory, threads);
    frames.why = std::move(chosen.why);
  }
  Row on_threads = row;
  if (row.rasterizer == kBySize) on_threads.rasterizer = "auto";
  auto drawer =
      make_drawer_of([on_threads, &memory] { return ways_on_threads(on_threads, memory); }, options,
                     memory, &threads, std::move(frames));
  if (row.visibility == "auto") return drawer;
  return std::make_unique<WithoutLayers>(std::move(drawer));
}

template <class Of>
std::vector<AxisInfo> axis_of(std::vector<AxisInfo> list, std::span<const Of> rows) {
  for (const Of& row : rows) list.push_back({std::string(row.name), std::string(row.description)});
  return list;
}

void check(const Tuning& tuning) {
  check_enum(tuning.schedule, Schedule::persistent, "the schedule");
  check_enum(tuning.order, BlockOrder::morton, "the order of blocks");
  check_enum(tuning.small_path, SmallPath::rows, "the path of small triangles");
}

}  // namespace

const std::vector<AxisInfo>& rasterizer_axis() {
  static const std::vector<AxisInfo> infos =
      axis_of({{std::string(kReference),
                "rows of triangles in order into one visibility buffer; one thread, plain C++"}},
              coverages());
  return infos;
}

const std::vector<AxisInfo>& visibility_axis() {
  static const std::vector<AxisInfo> infos = axis_of({}, visibilities());
  return infos;
}

Renderer make_renderer(const RendererOptions& options, const Row& row) {
  check(row.tuning);
  DeviceChoice choice = choose_device(options.device);
  if (options.device == Device::automatic && choice.device == Device::cuda &&
      (row.rasterizer != "auto" || row.visibility != "auto"))
    choice = {Device::threads,
              "a rasterizer or a visibility was asked for; with 'auto' the CPU draws by it"};
  // The reference is plain C++ on one thread on every machine.
  const bool plain = row.rasterizer == kReference;
  auto make = [row](const DrawerOptions& how, MemoryAccount& memory,
                    parallel::Threads* threads) -> std::unique_ptr<raster::FrameDrawer> {
    if (threads == nullptr) {
      if (row.rasterizer != "auto" && row.rasterizer != kReference)
        throw Error(Errc::invalid_argument,
                    std::string("the rasterizer '")
                        .append(row.rasterizer)
                        .append("' needs --device threads; serial has 'reference'"));
      return make_reference_drawer(how.memory_limit, memory);
    }
    return how.device == Device::cuda
               ? make_on_cuda(row, how, memory, *threads)
               : make_drawer_of([&] { return ways_on_threads(row, memory); }, how, memory, threads);
  };
  return RendererAccess::make(options, std::move(choice), plain, std::move(make));
}

}  // namespace rastrum::family
