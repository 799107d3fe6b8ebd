// SPDX-License-Identifier: BSD-3-Clause
// Fits of files equal those of the same meshes in memory, bit for bit, for any number of threads.
// After a first look they read only what may matter.
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/io/large_file.hpp>
#include <rastrum/parallel/exec.hpp>

#include "tests/out_of_core/large_files.hpp"

namespace rastrum::test::out_of_core_fit_test {
namespace {

std::vector<Camera> views() {
  std::vector<Camera> all(4);
  all[0].eye = {1, 2, 2};
  all[1].eye = {-0.2, 0.1, -1};
  all[1].fov_rad = 2.1F;
  all[2].eye = {3, -1, 0.5};
  all[2].orthographic = true;
  all[3].eye = {0, 0, 1};  // along an axis: whole sides of boxes are equally far
  return all;
}

/// A ball of 60,000 triangles around its centre, so that many runs have equally far vertices.
Mesh ball() {
  Mesh mesh = shapes::sphere(170, 180);
  mesh.normals = {};
  mesh.texcoords = {};
  return mesh;
}

TEST(OutOfCoreFit, ForAnyNumberOfThreadsItIsTheMeshs) {
  const TempFolder folder;
  Mesh mesh = ball();
  mesh.positions[20'000].y = std::numeric_limits<float>::infinity();
  mesh.positions.push_back({90, 0, 0});  // belongs to no triangle
  Mat4d turned = Mat4d::identity();
  turned.m[0][1] = 0.4;
  turned.m[2][0] = -2.5;
  turned.m[1][3] = 1e4;
  for (const auto& path : {folder.write("a.ply", ply_of(mesh)), folder.write("a.stl", stl_of(mesh)),
                           folder.write("a.npy", npy_of(mesh, true, false))})
    for (const Mat4d& m : {Mat4d::identity(), turned}) {
      Scene scene = io::read_scene(path);
      scene.instances[0].object_to_world = m;
      const SceneBinding binding(scene);
      for (const int threads : {1, 2, 7}) {
        SCOPED_TRACE(path.string() + " " + std::to_string(threads));
        const OutOfCoreFile file(path);
        FitOfFile fit(
            file, [&](Scene& s) { s.instances[0].object_to_world = m; }, threads);
        for (const Camera& view : views()) {
          expect_same(fit_picture(binding.view(), view, 300, 200),
                      fit_picture({}, view, 300, 200, {.ranks = &fit}));
          const Vec3d along = view.target - view.eye;
          expect_same(fit_camera(binding.view(), 1, view.orthographic, along),
                      fit_camera({}, 1, view.orthographic, along, {0, 1, 0}, &fit));
        }
      }
    }
}

TEST(OutOfCoreFit, OfSeveralFaultsTheFirstIsNamed) {
  const TempFolder folder;
  Mesh mesh = ball();
  for (const std::size_t t : {std::size_t{55'000}, std::size_t{18'003}, std::size_t{36'000}})
    mesh.indices[3 * t] = 0x7FFFFFFF;
  const OutOfCoreFile file(folder.write("a.ply", ply_of(mesh)));
  for (int i = 0; i < 20; ++i) {
    FitOfFile fit(file, {}, 4);
    expect_refused("triangle 18003 refers to vertex 2147483647", Errc::bad_format,
                   [&] { (void)fit_picture({}, {}, 20, 20, {.ranks = &fit}); });
  }
}

/// Runs of points that are read on request; records which were read.
class Runs final : public FitRanks, private FitVertices {
 public:
  std::vector<std::vector<Vec3d>> all;
  bool boxes = true;
  mutable std::vector<std::size_t> asked;

  void own(FunctionRef<void()> work) override { work(); }
  std::vector<double> gather(std::span<const double> numbers) override {
    return {numbers.begin(), numbers.end()};
  }
  const FitVertices* beyond() const override { return this; }

 private:
  std::size_t runs() const override { return all.size(); }
  std::optional<Box> box(std::size_t run) const override {
    if (!boxes) return {};
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Box b{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
    for (const Vec3d& p : all[run])
      if (std::isfinite(p.x + p.y + p.z)) {
        b.min = {std::min(b.min.x, p.x), std::min(b.min.y, p.y), std::min(b.min.z, p.z)};
        b.max = {std::max(b.max.x, p.x), std::max(b.max.y, p.y), std::max(b.max.z, p.z)};
      }
    return b;
  }
  const Mat4d& object_to_world(std::size_t) const override { return world_; }
  void read(std::span<const std::size_t> runs,
            FunctionRef<void(std::size_t, std::span<const Vec3d>)> f) const override {
    for (std::size_t i = runs.size(); i-- > 0;) {  // in any order
      asked.push_back(runs[i]);
      f(i, all[runs[i]]);
    }
  }
  Mat4d world_ = Mat4d::identity();
};

TEST(OutOfCoreFit, WhatCannotHaveAnAnswerIsNotRead) {
  Random random(5);
  for (const double scale : {1.0, 1e-30, 1e12, 1e30}) {
    Runs runs;
    for (int i = 0; i < 400; ++i) {
      std::vector<Vec3d>& run = runs.all.emplace_back();
      const double x = random.real(-1, 1);
      const double y = random.real(-1, 1);
      const double z = random.real(-1, 1);
      for (int k = 0; k < 20; ++k) {
        const double dx = random.real(-0.1, 0.1);
        const double dy = random.real(-0.1, 0.1);
        const double dz = random.real(-0.1, 0.1);
        run.push_back({(x + dx) * scale, (y + dy) * scale, (z + dz) * scale});
      }
    }
    runs.all[7] = {};
    runs.all[9][3].y = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < 30; ++i) runs.all.push_back(runs.all[static_cast<std::size_t>(i)]);  // ties
    for (const Camera& view : views()) {
      SCOPED_TRACE(scale);
      runs.boxes = false;
      runs.asked.clear();
      const Camera all = fit_picture({}, view, 64, 48, {.ranks = &runs});
      const Camera sphere = fit_camera({}, 1, false, {0, 0, -1}, {0, 1, 0}, &runs);
      const std::size_t asked = runs.asked.size();
      runs.boxes = true;
      runs.asked.clear();
      expect_same(all, fit_picture({}, view, 64, 48, {.ranks = &runs}));
      expect_same(sphere, fit_camera({}, 1, false, {0, 0, -1}, {0, 1, 0}, &runs));
      EXPECT_LT(runs.asked.size(), asked / 4);
    }
  }
}

/// A mesh at several nodes has its boxes computed once, before any vertex is read, and every node
/// uses them.
TEST(OutOfCoreFit, AMeshAtManyNodesHasItsBoxesOnce) {
  const TempFolder folder;
  std::vector<std::string> nodes;
  for (int i = 0; i < 12; ++i)
    nodes.push_back(R"({"mesh":0,"scale":[0.3,0.2,-0.3],"translation":[)" + std::to_string(i % 4) +
                    "," + std::to_string(i / 4) + ",0]}");
  const Mesh mesh = ball();
  const auto path = folder.write("a.glb", glb_of(mesh, false, "", nodes));
  const auto file = io::LargeFile::open(path);
  parallel::Threads threads(2);
  const std::size_t runs = file->position_runs(threads), of_mesh = runs / nodes.size();
  ASSERT_EQ(of_mesh, 2U);
  for (std::size_t run = 0; run < runs; ++run) {
    ASSERT_TRUE(file->run_box(run)) << run;
    io::FileBox box;
    for (std::size_t v = run % of_mesh * 16384; v < mesh.positions.size(); ++v)
      if (v / 16384 == run % of_mesh) box.add(mesh.positions[v]);
    EXPECT_EQ(file->run_box(run)->min, box.min);
    EXPECT_EQ(file->run_box(run)->max, box.max);
  }
  const Scene scene = io::read_scene(path);
  const SceneBinding binding(scene);
  const OutOfCoreFile large(path);
  FitOfFile fit(large, {}, 2);
  for (const Camera& view : views())
    expect_same(fit_picture(binding.view(), view, 300, 200),
                fit_picture({}, view, 300, 200, {.ranks = &fit}));
}

}  // namespace
}  // namespace rastrum::test::out_of_core_fit_test
