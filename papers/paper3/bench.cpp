// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench paper3`: paper 3, sections 5.6 (time over distance, columns and rows) and 6.2
// (shadows). Also frames of the usual sizes beside the original program under node and the floor:
// each pixel's 4 bytes written once by streaming stores, each sample's 4 bytes read once.
#include <algorithm>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include <papers/paper3/words.hpp>
#include <rastrum/family.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain/blocks.hpp>
#include <rastrum/terrain/methods.hpp>

#include <bench/cuda/rates.hpp>
#include <bench/machine.hpp>
#include <bench/peers/node_peer.hpp>
#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/tables/document.hpp>
#include <bench/tables/options.hpp>
#include <papers/paper3/published.hpp>
#include <papers/paper3/shadow_times.hpp>

namespace rastrum::bench {
namespace {

using terrain::BlockPool;
using terrain::Ceiling;
using terrain::HeightMap;
using terrain::MapView;
using terrain::Pyramid;
using terrain::Samples;
using terrain::Setup;
using terrain::Terrain;
using terrain::TerrainCamera;
using terrain::TerrainOptions;
using terrain::TerrainRenderer;
using terrain::TerrainRendererOptions;
using terrain::TerrainStats;
using terrain::TerrainTargets;

/// Hills of eight octaves, 1024², whole heights 0 to 200; the same in every run.
HeightMap hills() {
  constexpr int kSize = 1024;
  std::mt19937 random(1);
  std::vector<double> sum(kSize * kSize);
  double amplitude = 1;
  for (int cells = 4; cells <= kSize / 2; cells *= 2, amplitude /= 2) {
    Image<float> grid(cells, cells);
    for (float& g : grid.pixels()) g = static_cast<float>(random() % 10000) / 10000;
    const int step = kSize / cells;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const auto ease = [step](int at) {
          const double t = (at % step + 0.5) / step;
          return t * t * (3 - 2 * t);
        };
        const auto at = [&](int i, int j) {
          return static_cast<double>(grid(i % cells, j % cells));
        };
        const int i = x / step, j = y / step;
        const double u = ease(x), v = ease(y);
        const double above = at(i, j) * (1 - u) + at(i + 1, j) * u;
        const double below = at(i, j + 1) * (1 - u) + at(i + 1, j + 1) * u;
        sum[static_cast<std::size_t>(y * kSize + x)] += amplitude * (above * (1 - v) + below * v);
      }
  }
  const auto [low, high] = std::minmax_element(sum.begin(), sum.end());
  HeightMap map{Image<float>(kSize, kSize), Image<Rgba8>(kSize, kSize)};
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const int h = static_cast<int>((sum[i] - *low) / (*high - *low) * 200);
    map.heights.pixels()[i] = static_cast<float>(h);
    const auto channel = [&](int base) {
      return static_cast<std::uint8_t>(base + static_cast<int>(random() % 16));
    };
    map.colors.pixels()[i] = {channel(60 + h / 2), channel(120 - h / 3), channel(40), 255};
  }
  return map;
}

/// A way to draw, with its own threads and picture.
struct TerrainEntry {
  std::string name;
  std::shared_ptr<TerrainRenderer> renderer;
  TerrainOptions options;
  std::shared_ptr<Image<Rgba8>> picture;
  TerrainStats stats;
  Timing timing;

  TerrainEntry(std::string n, const TerrainOptions& o, const TerrainRendererOptions& by)
      : name(std::move(n)),
        renderer(std::make_shared<TerrainRenderer>(by)),
        options(o),
        picture(std::make_shared<Image<Rgba8>>(o.width, o.height)) {
    timing.name = name;
  }
  void frame(const Terrain& terrain) {
    stats = renderer->render(terrain, TerrainCamera{}, options, {.color8 = *picture});
  }
};

/// Each round runs all entries in order, the peer last.
void interleave(const Terrain& terrain, std::vector<TerrainEntry>& entries, NodePeer* peer,
                std::vector<double>& peer_ms, const Plan& plan) {
  std::vector<Contender> contenders;
  for (TerrainEntry& e : entries)
    contenders.push_back({e.name, [&e, &terrain] { e.frame(terrain); }});
  Plan one = plan;
  one.rounds = 1;
  for (int round = 0; round < plan.rounds; ++round) {
    const std::vector<Timing> timings = measure_interleaved(contenders, one);
    for (std::size_t i = 0; i < entries.size(); ++i)
      entries[i].timing.samples_ms.push_back(timings[i].samples_ms.front());
    if (peer != nullptr) peer_ms.push_back(peer->turn_ms());
  }
}

std::uint64_t picture_hash(const Image<Rgba8>& picture) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const Rgba8 c : picture.pixels()) {
    const std::uint32_t pixel = static_cast<std::uint32_t>(c.a) << 24 |
                                static_cast<std::uint32_t>(c.b) << 16 |
                                static_cast<std::uint32_t>(c.g) << 8 | c.r;
    hash = (hash ^ pixel) * 0x100000001b3U;
  }
  return hash;
}

TerrainOptions like_classic(int width, int height, double distance) {
  TerrainOptions o;
  o.width = width;
  o.height = height;
  o.distance = distance;
  o.scale_px = 240;
  o.ground_clearance = 10;
  return o;
}

struct Setting {
  int width, height;
  double distance;
  bool all_threads;
};
constexpr Setting kSizes[] = {{800, 450, 800, false},
                              {1920, 1080, 800, false},
                              {1920, 1080, 2000, false},
                              {3840, 2160, 2000, false},
                              {3840, 2160, 2000, true}};

/// Indices of entries: first the threads', then a device's.
constexpr std::size_t kFast = 1, kFirstOnDevice = 4;

/// The first of the device's entries whose picture differs from the threads'; null if none does.
const TerrainEntry* differs_from_fast(std::vector<TerrainEntry>& entries, const Terrain& terrain) {
  entries[kFast].frame(terrain);
  for (std::size_t i = kFirstOnDevice; i < entries.size(); ++i) {
    entries[i].frame(terrain);
    if (picture_hash(*entries[i].picture) != picture_hash(*entries[kFast].picture))
      return &entries[i];
  }
  return nullptr;
}

/// Returns false if the picture of classic differs from the peer's.
bool frames(const TableOptions& options, const MachineLimits& device, const HeightMap& map,
            Document& document) {
  const Terrain terrain(map);
  const MachineLimits one = measure_machine(1), all = measure_machine(options.threads);
  Grid grid{"Frames of the default camera, ms (in brackets: times as fast as node, round by round)",
            {"picture, distance", "threads", "node", "classic", "fast", "mip, dz 0.02", "words",
             "floor", "fast / floor"},
            {}};
  if (options.on_cuda())
    grid.columns.insert(grid.columns.end(),
                        {"fast, cuda", "words, cuda", "its floor", "fast, cuda / floor"});
  bool right = true;
  for (Setting size : kSizes) {
    size.width = options.size(size.width);
    size.height = options.size(size.height);
    const int threads = size.all_threads ? options.threads : 1;
    const std::string label = std::to_string(size.width) + "×" + std::to_string(size.height) +
                              ", " + significant(size.distance);
    progress(label);
    std::optional<NodePeer> peer;
    std::string why_not;
    try {
      peer.emplace(map, size.width, size.height, size.distance);
    } catch (const Error& e) {
      why_not = e.what();
    }
    TerrainOptions fast = like_classic(size.width, size.height, size.distance);
    TerrainOptions classic;
    classic.classic = true;
    classic.width = size.width;
    classic.height = size.height;
    classic.distance = size.distance;
    TerrainOptions mip = fast, words = fast;
    mip.filter = terrain::MapFilter::mip;
    mip.dz = 0.02;
    words.added = &family::terrain_words();
    std::vector<TerrainEntry> entries;
    const TerrainRendererOptions here{.threads = threads};
    entries.emplace_back("classic", classic, here);
    entries.emplace_back("fast", fast, here);
    entries.emplace_back("mip", mip, here);
    entries.emplace_back("words", words, here);
    if (options.on_cuda()) {
      const TerrainRendererOptions there{.device = Device::cuda, .threads = threads};
      entries.emplace_back("fast, cuda", fast, there);
      entries.emplace_back("words, cuda", words, there);
    }
    entries[0].frame(terrain);
    if (peer && picture_hash(*entries[0].picture) != peer->hash()) {
      document.notes.push_back("**" + label +
                               ": classic's picture is not node's; nothing was timed.**");
      right = false;
      continue;
    }
    if (const TerrainEntry* wrong = differs_from_fast(entries, terrain)) {
      document.notes.push_back("**" + label + ": the picture of " + wrong->name +
                               " is not that of fast; nothing was timed.**");
      right = false;
      continue;
    }
    std::vector<double> peer_ms;
    interleave(terrain, entries, peer ? &*peer : nullptr, peer_ms, options.plan());
    Timing node;
    node.name = "node";
    node.samples_ms = peer_ms;
    const MachineLimits& machine = size.all_threads ? all : one;
    const TerrainStats& stats = entries[1].stats;
    const double floor_ms = 4.0 * size.width * size.height / machine.stream_gbs / 1e6 +
                            4.0 * static_cast<double>(stats.samples) / machine.read_gbs / 1e6;
    std::vector<std::string> row{
        label, std::to_string(threads),
        peer ? significant(node.median_ms()) : "not run (" + why_not + ")"};
    std::vector<std::string> on_device;
    for (const TerrainEntry& e : entries) {
      std::string cell = significant(e.timing.median_ms());
      if (peer) cell.append(" (").append(significant(median_ratio(node, e.timing), 2)).append(")");
      (e.stats.device == Device::cuda ? on_device : row).push_back(std::move(cell));
      document.figures.push_back({{"table", "frames"},
                                  {"picture", label},
                                  {"threads", threads},
                                  {"method", e.name},
                                  {"samples", e.stats.samples},
                                  {"visible", e.stats.visible},
                                  {"slices", e.stats.slices},
                                  {"scratch_bytes", e.stats.peak_bytes},
                                  {"here", to_json(e.timing)},
                                  {"node_ms", peer_ms},
                                  {"floor_ms", floor_ms}});
    }
    row.push_back(significant(floor_ms));
    row.push_back(significant(entries[1].timing.median_ms() / floor_ms, 2));
    if (options.on_cuda()) {
      const TerrainEntry& there = entries[kFirstOnDevice];
      const double its_ms = 4.0 *
                            (static_cast<double>(size.width) * size.height +
                             static_cast<double>(there.stats.samples)) /
                            device.copy_gbs / 1e6;
      row.insert(row.end(), on_device.begin(), on_device.end());
      row.push_back(significant(its_ms));
      row.push_back(significant(there.timing.median_ms() / its_ms, 2));
      document.figures.push_back(
          {{"table", "device floor"}, {"picture", label}, {"threads", threads}, {"ms", its_ms}});
    }
    grid.rows.push_back(std::move(row));
  }
  document.grids.push_back(std::move(grid));
  return right;
}

/// A frame of figures 5.6 to 5.8, which go to 10⁶ columns or rows; pictures end at 32,768. So this
/// calls the methods as TerrainRenderer does, on pixels of its own.
class WideFrame {
 public:
  WideFrame(const Terrain& terrain, const TerrainOptions& options, int threads)
      : terrain_(terrain),
        options_(options),
        camera_(above_ground(terrain, {}, options.ground_clearance.value_or(0))),
        threads_(threads, &memory_),
        serial_(&memory_),
        pool_(memory_),
        ceiling_(terrain.heights()),
        pyramid_(terrain.heights(), terrain.colors(), false),
        pixels_(static_cast<std::size_t>(options.width) *
                static_cast<std::size_t>(options.height)) {}

  void draw(const terrain::AddedMethod* added, Device device) {
    const Setup setup = set_up(options_, camera_, terrain_);
    const Samples samples{{setup, MapView(pyramid_, options_, setup)}, terrain_, &ceiling_};
    const TerrainTargets targets{
        .color8 = {pixels_.data(), options_.width, options_.height, options_.width}};
    if (added == nullptr)
      draw_fast(threads_, available_isas().back(), pool_, samples, targets);
    else if (device == Device::serial)
      family::draw_words(serial_, samples, targets);
    else
      family::draw_words(threads_, samples, targets);
  }
  [[nodiscard]] std::vector<Rgba8>& pixels() { return pixels_; }

 private:
  const Terrain& terrain_;
  TerrainOptions options_;
  TerrainCamera camera_;
  MemoryAccount memory_;
  parallel::Threads threads_;
  parallel::Serial serial_;
  BlockPool pool_;
  Ceiling ceiling_;
  Pyramid pyramid_;
  std::vector<Rgba8> pixels_;
};

struct ScaledWay {
  const char* name;
  const terrain::AddedMethod* added;
  Device device;
};
const ScaledWay kScaledWays[] = {{"words, serial", &family::terrain_words(), Device::serial},
                                 {"words", &family::terrain_words(), Device::threads},
                                 {"fast", nullptr, Device::threads}};

/// The times of kScaledWays; empty if their pictures differ.
std::vector<Timing> time_ways(const Terrain& terrain, const TerrainOptions& options, int threads,
                              const Plan& plan) {
  WideFrame frame(terrain, options, threads);
  std::vector<Rgba8> first;
  std::vector<Contender> contenders;
  for (const ScaledWay& way : kScaledWays) {
    std::ranges::fill(frame.pixels(), Rgba8{});
    frame.draw(way.added, way.device);
    if (first.empty()) first = frame.pixels();
    if (first != frame.pixels()) return {};
    contenders.push_back({way.name, [&frame, &way] { frame.draw(way.added, way.device); }});
  }
  return measure_interleaved(contenders, plan);
}

/// Figures 5.6 to 5.8. Returns false if a picture is wrong.
bool scaling(const TableOptions& options, const HeightMap& map, Document& document) {
  const Terrain terrain(map);
  Plot plot;
  plot.title = "Paper 3, figures 5.6 to 5.8: time, the other two at 10";
  plot.x_title = "d, m or l";
  plot.y_title = "ms";
  plot.log_x = true;
  for (const int n : paper3::kSizes) {
    plot.places.push_back(significant(n));
    plot.x.push_back(n);
  }
  Grid grid{"Figures 5.6 to 5.8: ms, the other two parameters at 10", {"what grows", "method"}, {}};
  for (const std::string& place : plot.places) grid.columns.push_back(place);
  for (const char what : {'d', 'm', 'l'}) {
    progress(std::string("scaling by ") + what);
    constexpr std::size_t kCount = std::size(kScaledWays);
    std::vector<std::vector<double>> ms(kCount);
    std::vector<std::vector<std::string>> cells(kCount);
    for (const int n : paper3::kSizes) {
      const TerrainOptions o =
          like_classic(what == 'm' ? n : paper3::kFixed, what == 'l' ? n : paper3::kFixed,
                       what == 'd' ? n : paper3::kFixed);
      const std::vector<Timing> timings = time_ways(terrain, o, options.threads, options.plan());
      if (timings.empty()) {
        document.notes.push_back(std::string("**")
                                     .append(1, what)
                                     .append(" = " + std::to_string(n))
                                     .append(": the pictures of words and fast differ; scaling was "
                                             "not timed.**"));
        return false;
      }
      for (std::size_t i = 0; i < kCount; ++i) {
        ms[i].push_back(timings[i].median_ms());
        cells[i].push_back(significant(ms[i].back()));
        document.figures.push_back({{"table", "scaling"},
                                    {"grows", std::string(1, what)},
                                    {"at", n},
                                    {"method", kScaledWays[i].name},
                                    {"here", to_json(timings[i])}});
      }
    }
    Panel panel{std::string(1, what), {}};
    for (std::size_t i = 0; i < kCount; ++i) {
      panel.series.push_back({kScaledWays[i].name, ms[i], static_cast<int>(i), false});
      std::vector<std::string> row{std::string(1, what), kScaledWays[i].name};
      row.insert(row.end(), cells[i].begin(), cells[i].end());
      grid.rows.push_back(std::move(row));
    }
    plot.panels.push_back(std::move(panel));
  }
  document.grids.push_back(std::move(grid));
  document.plot = std::move(plot);
  return true;
}

}  // namespace

int run_paper3(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("paper3",
                      "Paper 3, sections 5.6 and 6.2, and frames beside the original under node.");
  options.add_device(parser);
  if (const auto status = options.read(parser, arguments)) return *status;
  Document document = options.document("paper3", "Paper 3: Voxel Space");
  document.notes.push_back(std::string("The paper measured on a ")
                               .append(paper3::kMachine)
                               .append(" and draws its figures without printing them. ")
                               .append(paper3::kFindings));
  document.notes.push_back(
      "Node runs the original program, one thread; classic's picture was compared with node's, "
      "pixel by pixel, before anything was timed. The floor is 4 bytes a pixel at the measured "
      "streaming bandwidth and 4 bytes a sample read by `fast` at the read bandwidth.");
  const HeightMap map = hills();
  MachineLimits device;
  if (options.on_cuda()) {
    device = measure_device(options);
    document.notes.push_back(device_note(options, device));
  }
  bool right = frames(options, device, map, document) && scaling(options, map, document);
  right = add_shadow_times(options, map.heights, document) && right;
  publish(document, options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
