// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench peers`: frames of Rastrum, OpenGL (Mesa llvmpipe) and Embree in one interleaved
// run, after a comparison of their pictures, with the floor of each frame.
//
// A frame of Rastrum goes from the caller's mesh in memory to finished RGBA8 in memory. llvmpipe
// has static buffers; its frame ends with glFinish, and the picture stays in place. Embree traces
// and shades into RGBA8; its build is timed separately.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include <bench/floor.hpp>
#include <bench/machine_json.hpp>
#include <bench/measure.hpp>
#include <bench/options.hpp>
#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/scenes.hpp>
#include <rastrum/family.hpp>

#include "compare.hpp"
#include "embree_peer.hpp"
#include "gl_peer.hpp"
#include "selection.hpp"
#include "started.hpp"

namespace rastrum::bench {
namespace {

constexpr int kColorTolerance = 1;  ///< of 255
// At silhouettes and between nearly equal depths, rays hit other triangles than samples.
constexpr double kLeastShareGl = 0.999, kLeastShareEmbree = 0.99;

struct PeersOptions : PeerOptions {
  std::string rasterizer = "auto";
};

struct Peers {
  Started<GlPeer> gl;
  Started<EmbreePeer> embree;
};

struct Row {
  std::string scene;
  Size size;
  Workload work;
  std::uint64_t peak_bytes = 0;
  std::optional<double> share_gl, share_embree;  ///< pixels within the tolerance
  bool right = true;                             ///< every picture is right
  std::optional<Timing> ours, gl, build, trace;
  Floor floor;

  [[nodiscard]] double ratio(const std::optional<Timing>& peer) const {
    return peer && ours ? median_ratio(*peer, *ours) : 0;
  }
  /// Embree's build and trace over ours.
  [[nodiscard]] double ratio_embree() const {
    return build && trace ? ratio(build) + ratio(trace) : 0;
  }
  [[nodiscard]] std::string missed_goals() const;
};

/// The goals of the project: multiples of llvmpipe's speed by size, and Embree's by triangles.
std::string Row::missed_goals() const {
  const bool large = size.width >= 4096 || size.height >= 4096;
  const double wanted = large ? 5 : work.triangles < 60000 ? 3 : 8;
  std::string missed;
  const auto miss = [&](const char* who, double is, double goal) {
    if (is < goal)
      missed += (missed.empty() ? "" : ", ") + std::string(who) + " " + significant(is) + " < " +
                significant(goal, 1);
  };
  if (gl) miss("llvmpipe", ratio(gl), wanted);
  if (build) miss("build + trace", ratio_embree(), 1);
  if (trace && work.triangles <= 1'200'000) miss("trace", ratio(trace), 1);
  return missed;
}

nlohmann::json to_json(const Row& row) {
  nlohmann::json j = {{"scene", row.scene},
                      {"size", size_text(row.size)},
                      {"vertices", row.work.vertices},
                      {"triangles", row.work.triangles},
                      {"fragments", row.work.fragments},
                      {"pixels_covered", row.work.pixels_covered},
                      {"peak_bytes", row.peak_bytes},
                      {"right", row.right},
                      {"floor",
                       {{"bytes", row.floor.bytes},
                        {"operations", row.floor.operations},
                        {"bytes_ms", row.floor.bytes_ms},
                        {"operations_ms", row.floor.operations_ms},
                        {"binds", row.floor.binds()}}},
                      {"missed_goals", row.missed_goals()}};
  if (row.share_gl) j["share_within_1_llvmpipe"] = *row.share_gl;
  if (row.share_embree) j["share_within_1_embree"] = *row.share_embree;
  if (row.ours) j["rastrum"] = to_json(*row.ours);
  if (row.gl) j["llvmpipe"] = to_json(*row.gl);
  if (row.build) j["embree_build"] = to_json(*row.build);
  if (row.trace) j["embree_trace"] = to_json(*row.trace);
  if (row.gl) j["ratio_llvmpipe"] = row.ratio(row.gl);
  if (row.trace) j["ratio_embree_trace"] = row.ratio(row.trace);
  if (row.build) j["ratio_embree_build_and_trace"] = row.ratio_embree();
  return j;
}

Row measure_row(const SceneInfo& info, const Mesh& mesh, Size size, Peers& peers,
                const MachineLimits& machine, const PeersOptions& options) {
  const MeshView view = mesh.view();
  const InstanceView instance{view};
  const SceneView scene{.instances = {&instance, 1}};
  const Camera camera = fit_camera(scene, Camera{}.fov_rad, false);
  Renderer renderer =
      family::make_renderer({.threads = options.threads}, {.rasterizer = options.rasterizer});
  const FrameOptions frame{.width = size.width, .height = size.height};
  Image<Rgba8> ours(size.width, size.height);
  const Targets targets{.color8 = ours};

  Row row;
  row.scene = info.name;
  row.size = size;
  const FrameStats stats = renderer.render(scene, camera, frame, targets);
  row.peak_bytes = stats.peak_bytes;
  row.work = {mesh.positions.size(), mesh.triangle_count(), stats.fragments, stats.pixels_covered,
              static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height)};
  row.floor = floor_of(row.work, machine);

  std::vector<Contender> contenders{
      {"rastrum", [&] { renderer.render(scene, camera, frame, targets); }}};
  if (peers.gl) {
    peers.gl->set_view(camera, size.width, size.height);
    peers.gl->draw_phong();
    row.share_gl = compare_colors(ours, peers.gl->colors(), kColorTolerance).share();
    row.right = row.right && *row.share_gl >= kLeastShareGl;
    contenders.push_back({"llvmpipe", [&] { peers.gl->draw_phong(); }});
  }
  Image<Rgba8> traced(size.width, size.height);
  if (peers.embree) {
    peers.embree->build();
    peers.embree->trace(camera, traced.view());
    row.share_embree = compare_colors(ours, traced, kColorTolerance).share();
    row.right = row.right && *row.share_embree >= kLeastShareEmbree;
    contenders.push_back({"embree build", [&] { peers.embree->build(); }});
    contenders.push_back({"embree trace", [&] { peers.embree->trace(camera, traced.view()); }});
  }
  if (!row.right) return row;

  for (Timing& timing : measure_interleaved(contenders, {.rounds = options.rounds})) {
    std::optional<Timing>& place = timing.name == "rastrum"        ? row.ours
                                   : timing.name == "llvmpipe"     ? row.gl
                                   : timing.name == "embree build" ? row.build
                                                                   : row.trace;
    place = std::move(timing);
  }
  return row;
}

Table make_table() {
  return Table({{"scene", 12, true},
                {"size", 9, true},
                {"triangles", 9},
                {"ours ms", 8},
                {"± %", 4},
                {"MiB", 5},
                {"llvmpipe", 8},
                {"ratio", 6},
                {"build", 7},
                {"trace", 7},
                {"ratio", 6},
                {"trace r.", 8},
                {"floor ms", 8},
                {"binds", 5},
                {"floor/ours", 10},
                {"goals missed", 12, true}});
}

void print_row(const Table& table, const Row& row) {
  const auto ms = [](const std::optional<Timing>& t) {
    return t ? significant(t->median_ms()) : "-";
  };
  const auto times = [](double r) { return r > 0 ? significant(r) : "-"; };
  std::string goals = row.missed_goals();
  if (!row.right)
    goals = "WRONG PICTURE: " + significant(row.share_gl.value_or(1), 5) + " as llvmpipe, " +
            significant(row.share_embree.value_or(1), 5) + " as Embree";
  table.print_row({row.scene, size_text(row.size), std::to_string(row.work.triangles), ms(row.ours),
                   row.ours ? significant(row.ours->spread() * 100, 2) : "-",
                   significant(static_cast<double>(row.peak_bytes) / 1048576), ms(row.gl),
                   times(row.ratio(row.gl)), ms(row.build), ms(row.trace),
                   times(row.ratio_embree()), times(row.ratio(row.trace)),
                   significant(row.floor.ms()), std::string(row.floor.binds()),
                   row.ours ? significant(row.floor.ms() / row.ours->median_ms(), 2) : "-", goals});
}

}  // namespace

int run_peers(std::span<const std::string_view> arguments) {
  PeersOptions options;
  Selection selection(peer_scenes(), {{1024, 1024}, {1920, 1080}, {4096, 4096}});
  OptionParser parser("peers", "Frames of Rastrum, llvmpipe and Embree, interleaved, `phong`.");
  parser.add_option("--rasterizer", options.rasterizer, "Rastrum's rasterizer (default: auto)");
  if (const auto status = options.read(parser, selection, arguments)) return *status;

  Peers peers{Started<GlPeer>(options.threads), Started<EmbreePeer>(options.threads)};
  std::printf("%s\n%s\n%s\n", machine_text().c_str(), peers.gl.line().c_str(),
              peers.embree.line().c_str());
  const MachineLimits machine = measure_machine(options.threads);
  std::printf("limits: read %s GB/s, stream %s GB/s, %s GFLOP/s; %d threads, %d rounds\n\n",
              significant(machine.read_gbs).c_str(), significant(machine.stream_gbs).c_str(),
              significant(machine.gflops).c_str(), options.threads, options.rounds);

  const Table table = make_table();
  table.print_head();
  nlohmann::json rows = nlohmann::json::array();
  bool right = true;
  for (const SceneInfo& info : selection.scenes()) {
    const Mesh mesh = load(info);
    if (peers.gl) peers.gl->set_mesh(mesh.view());
    if (peers.embree) peers.embree->set_mesh(mesh.view());
    for (const Size size : selection.sizes()) {
      const Row row = measure_row(info, mesh, size, peers, machine, options);
      print_row(table, row);
      rows.push_back(to_json(row));
      right = right && row.right;
    }
  }
  std::printf(
      "\nratio: the peer's time over ours, the median over rounds; Embree's first is build + "
      "trace.\n");
  if (!options.json.empty()) {
    nlohmann::json document = {{"benchmark", "peers"},       {"machine", machine_json()},
                               {"limits", to_json(machine)}, {"threads", options.threads},
                               {"rounds", options.rounds},   {"rows", rows}};
    if (peers.gl) document["llvmpipe"] = peers.gl->description();
    if (peers.embree) document["embree"] = peers.embree->description();
    write_json(options.json, document);
  }
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
