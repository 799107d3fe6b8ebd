// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench transparency`: exact blending beside our unsorted blending, the approximations,
// paper 4's filters, llvmpipe's three ways and VTK's peeling.

#include <bench/cuda/rates.hpp>
#include <bench/machine.hpp>
#include <bench/peers/selection.hpp>
#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/tables/options.hpp>

#include <papers/paper4/bench/tables.hpp>

namespace rastrum::bench {
int run_transparency(std::span<const std::string_view> arguments) {
  TableOptions options;
  double opacity = 0.5, patience_s = 20;
  Selection selection(transparency_scenes(), {{1024, 1024}, {1920, 1080}});
  OptionParser parser("transparency", "Translucent surfaces: exact, unsorted, approximate, peers.");
  options.add_device(parser);
  selection.add_to(parser);
  parser.add_option("--opacity", opacity, "opacity of every surface (default: 0.5)")
      ->range(0.01, 0.99);
  parser
      .add_option("--patience", patience_s, "seconds after which peeling is stopped (default: 20)")
      ->range(0.0, 3600.0);
  if (const auto status = options.read(parser, arguments)) return *status;
  if (options.quick) {
    selection.set_sizes({{128, 128}});
    selection.set_scenes({scene_by_name("boxes")});
    if (!parser.given("--patience")) patience_s = 2;
  }
  selection.resolve();

  Document document =
      options.document("transparency", "Transparency: exact against everything else");
  document.notes.push_back(
      "`phong` with vertex normals, the default camera, no culling, every surface with opacity " +
      significant(opacity, 2) + ", over nothing; " + options.here() + ", " +
      std::to_string(options.rounds) + (options.rounds == 1 ? " round" : " rounds") +
      ". Each peer's picture is compared with ours in float32 (VTK's in 8 bits) before anything is "
      "timed; timed frames end in RGBA8, llvmpipe's blended there, as users have it. Its lists' "
      "nodes are counted and allocated before. Peeling takes passes until an occlusion query "
      "finds nothing.");
  TransparencyPeers peers{Started<GlTransparency>(options.threads),
                          Started<VtkPeer>(options.threads)};
  document.notes.push_back((peers.gl ? "Peer: " : "Left out: ") + peers.gl.note + ".");
  document.notes.push_back((peers.vtk ? "Peer: " : "Left out: ") + peers.vtk.note + ".");
  TransparencyPlan plan;
  plan.plan = options.plan();
  plan.threads = options.threads;
  plan.opacity = static_cast<float>(opacity);
  plan.patience_ms = patience_s * 1000;
  plan.machine = measure_machine(options.threads);
  plan.on_cuda = options.on_cuda();
  if (plan.on_cuda) {
    plan.device = measure_device(options);
    document.notes.push_back(device_note(options, plan.device));
  }

  std::vector<TransparencyRow> rows;
  bool right = true;
  for (const SceneInfo& info : selection.scenes()) {
    const Mesh mesh = load(info);
    if (peers.gl) peers.gl->set_mesh(mesh.view());
    if (peers.vtk) peers.vtk->set_mesh(mesh.view());
    for (const Size size : selection.sizes()) {
      progress(std::string(info.name) + ", " + size_text(size));
      rows.push_back(measure_transparency(mesh, size, peers, plan));
      rows.back().scene = info.name;
      right = right && rows.back().right();
    }
  }
  std::vector<std::string> absent;
  for (const SceneInfo& scene : selection.absent()) absent.emplace_back(scene.name);
  add_transparency(document, rows, absent);
  publish(document, options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
