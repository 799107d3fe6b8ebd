// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench peers-check`: compares coverage, fragment counts and `phong` with OpenGL's by the
// limits of the tests (tests/bench): 0 differing pixels where vertices lie on 1/256 px, at most 3
// on meshes, `phong` within 1/255 on 99.9 % of the covered pixels.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include <bench/options.hpp>
#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/scenes.hpp>
#include <bench/stand_ins.hpp>
#include <rastrum/error.hpp>

#include "check.hpp"
#include "selection.hpp"

namespace rastrum::bench {
namespace {

struct Printed {
  Table table{{{"scene", 12, true},
               {"size", 9, true},
               {"triangles", 9},
               {"fragments", 10},
               {"counts ≠", 8},
               {"coverage ≠", 10},
               {"covered", 9},
               {"phong > 1", 9},
               {"share %", 8},
               {"largest", 7},
               {"ids ≠", 7},
               {"verdict", 7, true}}};
  nlohmann::json rows = nlohmann::json::array();
  bool right = true;

  void add(const std::string& scene, Size size, const GlCheck& c,
           std::optional<std::uint64_t> allowed) {
    const bool ok = c.passes(allowed);
    right = right && ok;
    table.print_row({scene, size_text(size), std::to_string(c.triangles),
                     std::to_string(c.counts.ours), std::to_string(c.counts.pixels),
                     std::to_string(c.counts.coverage), std::to_string(c.colors.covered),
                     std::to_string(c.colors.far), significant(c.colors.share() * 100, 6),
                     std::to_string(c.colors.largest), std::to_string(c.ids),
                     !ok       ? "WRONG"
                     : allowed ? "ok"
                               : "ok (counts not judged)"});
    rows.push_back({{"scene", scene},
                    {"size", size_text(size)},
                    {"triangles", c.triangles},
                    {"fragments", {{"rastrum", c.counts.ours}, {"opengl", c.counts.theirs}}},
                    {"samples_passed", c.samples_passed},
                    {"pixels_with_other_counts", c.counts.pixels},
                    {"pixels_with_other_coverage", c.counts.coverage},
                    {"covered", c.colors.covered},
                    {"share_within_1", c.colors.share()},
                    {"largest_difference", c.colors.largest},
                    {"pixels_with_other_ids", c.ids},
                    {"ok", ok}});
  }
};

}  // namespace

int run_peers_check(std::span<const std::string_view> arguments) {
  std::string json;
  int threads = 2;
  Selection selection(peer_scenes(), {{1024, 1024}, {1920, 1080}});
  OptionParser parser("peers-check", "Coverage, fragment counts and phong against OpenGL's.");
  selection.add_to(parser);
  parser.add_option("--threads", threads, "threads of each contender (default: 2)")->range(1, 1024);
  parser.add_option("--json", json, "write the figures to FILE")->type_name("FILE");
  if (const auto status = parser.parse(arguments)) return *status;
  selection.resolve();

  GlPeer gl(threads);
  std::printf("%s\npeer: %s\n\n", machine_text().c_str(), gl.description().c_str());
  Printed printed;
  printed.table.print_head();
  for (const Size size : selection.sizes()) {
    const Mesh mesh = window_triangles(size.width, size.height, 5000, 1);
    const Camera camera = window_camera(size.width, size.height);
    printed.add("on 1/256 px", size,
                check_against(gl, mesh, camera, size.width, size.height, threads),
                kDifferingPixelsExact);
  }
  for (const SceneInfo& info : selection.scenes()) {
    const Mesh mesh = load(info);
    for (const Size size : selection.sizes())
      printed.add(std::string(info.name), size,
                  check_against(gl, mesh, whole_view(mesh), size.width, size.height, threads),
                  info.soup ? std::nullopt : std::optional(kDifferingPixelsMesh));
  }
  if (!json.empty())
    write_json(json, {{"benchmark", "peers-check"},
                      {"machine", machine_json()},
                      {"opengl", gl.description()},
                      {"rows", printed.rows}});
  return printed.right ? 0 : 1;
}

}  // namespace rastrum::bench
