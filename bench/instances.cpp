// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench instances`: many instances of one mesh beside the same triangles as one mesh.
// Before the timing, ids are compared with the serial reference's, pixel by pixel, and with the
// single mesh's, whose vertices were rounded in another order.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/raster/rules/clip.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "cloud.hpp"
#include "measure.hpp"
#include "peers/started.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "tables/document.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {
namespace {

/// The least share of pixels with the single mesh's id; the others lie on edges.
constexpr double kEqualIds = 0.99;

/// A random turn and place in the view, scaled to `px` pixels in a picture of that height.
Mat4d placed(Noise& noise, double aspect, double px, int height) {
  const Vec3 at = place(noise, aspect);
  const double size = px * 2 / height * -static_cast<double>(at.z);
  const double angle = 2 * std::numbers::pi * noise.next();
  const double s = size * std::sin(angle), c = size * std::cos(angle);
  // Turned about y, then leant towards the eye so that three sides are visible.
  const double rows[16] = {c,        0,          s,        at.x,  //
                           0.6 * s,  0.8 * size, -0.6 * c, at.y,  //
                           -0.8 * s, 0.6 * size, 0.8 * c,  at.z,  //
                           0,        0,          0,        1};
  return matrix_from_rows(rows);
}

struct Flock {
  Mesh mesh, flat;  ///< flat: all instances as one
  MeshView view, flat_view;
  std::vector<InstanceView> instances;
};

void make(Flock& flock, std::size_t n, double px, int width, int height) {
  Noise noise;
  flock.view = flock.mesh.view();
  const auto vertices = static_cast<std::uint32_t>(flock.mesh.positions.size());
  for (std::size_t i = 0; i < n; ++i) {
    const Mat4d to_world = placed(noise, double(width) / height, px, height);
    flock.instances.push_back({flock.view, to_world});
    for (const std::uint32_t v : flock.mesh.indices)
      flock.flat.indices.push_back(static_cast<std::uint32_t>(i) * vertices + v);
    for (const Vec3 p : flock.mesh.positions) {
      const Vec4 at = rounded(raster::transform_point(to_world, Vec3d(p)));
      flock.flat.positions.push_back({at.x, at.y, at.z});
    }
  }
  flock.flat_view = flock.flat.view();
}

}  // namespace

int run_instances(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("instances", "Frames of many instances of one mesh at 1920 × 1080.");
  if (const auto status = options.read(parser, arguments)) return *status;
  FrameOptions frame = options.frame(1920, 1080);
  Document document = options.document("instances", "Many instances of one mesh");
  document.notes.push_back(
      options.here(frame) +
      ", `flat`; cubes of 6 px, spheres of 760 triangles of 24 px. The ids are the serial "
      "reference's, and those of the same triangles as one mesh but for edges. An instance's "
      "bytes are what the caller keeps (" +
      std::to_string(sizeof(InstanceView)) + ") and, under MB, a frame's scratch.");
  Grid grid{"",
            {"mesh", "instances", "ms", "project ms", "MB", "as one mesh ms", "its MB",
             "instances ÷ one mesh"},
            {}};
  struct Row {
    const char* mesh;
    std::size_t count;
    double px;
  };
  Plot plot = options.plot(document, "instances", "ms");
  Panel panel{"frame", {{"instances", {}, 0}, {"one mesh", {}, 1}}};
  bool right = true;
  for (const Row& row : {Row{"cube", 1000, 6}, Row{"cube", 10000, 6}, Row{"cube", 100000, 6},
                         Row{"cube", 1000000, 6}, Row{"sphere", 10000, 24}}) {
    const bool is_cube = std::string_view(row.mesh) == "cube";
    Flock flock;
    flock.mesh = is_cube ? shapes::boxes(1, 1) : shapes::sphere(20, 20);
    const std::size_t n = options.triangles(row.count);
    make(flock, n, is_cube ? row.px : row.px / 2, frame.width, frame.height);
    const SceneView scene{flock.instances, {}, {}};
    const InstanceView one{flock.flat_view};
    const SceneView flat{{&one, 1}, {}, {}};
    const Camera camera = camera_at_origin();
    Renderer renderer({.threads = options.threads}), other({.threads = options.threads});
    Image<std::int64_t> ids(frame.width, frame.height), expected(frame.width, frame.height);
    frame.shader = Shader::id;
    (void)renderer.render(scene, camera, frame, {.ids = ids});
    (void)Renderer({.device = Device::serial}).render(scene, camera, frame, {.ids = expected});
    right = right && equal_share(ids, expected) == 1;
    (void)other.render(flat, camera, frame, {.ids = expected});
    if (const double share = equal_share(ids, expected); share < kEqualIds) {
      std::fprintf(stderr, "%zu instances: the one mesh has the same ids at %.4f of the pixels\n",
                   n, share);
      right = false;
    }
    frame.shader = Shader::flat;
    Image<Rgba8> image(frame.width, frame.height);
    FrameStats stats, flat_stats;
    const Contender contenders[] = {
        {"instances", [&] { stats = renderer.render(scene, camera, frame, {.color8 = image}); }},
        {"one mesh", [&] { flat_stats = other.render(flat, camera, frame, {.color8 = image}); }}};
    const std::vector<Timing> timings = measure_interleaved(contenders, options.plan());
    grid.rows.push_back({row.mesh, std::to_string(n), significant(timings[0].median_ms()),
                         significant(stages_ms(stats)["project"]), megabytes(stats.peak_bytes),
                         significant(timings[1].median_ms()), megabytes(flat_stats.peak_bytes),
                         significant(median_ratio(timings[0], timings[1]))});
    plot.places.push_back(std::to_string(n).append(is_cube ? "" : " spheres"));
    for (std::size_t i = 0; i < timings.size(); ++i)
      panel.series[i].values.push_back(timings[i].median_ms());
    document.figures.push_back({{"mesh", row.mesh},
                                {"instances", n},
                                {"ms", timings[0].median_ms()},
                                {"bytes", stats.peak_bytes},
                                {"one_mesh_ms", timings[1].median_ms()},
                                {"one_mesh_bytes", flat_stats.peak_bytes}});
  }
  publish(std::move(document), std::move(grid), std::move(plot), std::move(panel), options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
