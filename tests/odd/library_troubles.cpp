// SPDX-License-Identifier: BSD-3-Clause
// Calls of the C++ interface, faults and limits.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/annotate.hpp>
#include <rastrum/digest.hpp>
#include <rastrum/effects.hpp>
#include <rastrum/environment.hpp>
#include <rastrum/io.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/out_of_core.hpp>
#include <rastrum/pick.hpp>
#include <rastrum/ranks.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/terrain.hpp>

#include "tests/io/files.hpp"
#include "tests/support/refused.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::library_troubles {
namespace {

/// A ball that is drawn.
struct Ball {
  Scene scene = single(shapes::sphere());
  SceneBinding binding{scene};
  Camera camera = fit_camera(binding.view(), 0.8F, false);
  FrameOptions frame{.width = 64, .height = 48};

  FrameStats draw(Renderer& renderer, const Targets& targets, const Pass& pass = {}) const {
    return renderer.render(binding.view(), camera, frame, targets, pass);
  }
  [[nodiscard]] Image<Rgba8> picture(Renderer& renderer) const {
    Image<Rgba8> image(frame.width, frame.height);
    draw(renderer, {.color8 = image});
    return image;
  }
};

// A pass loads keys of primitives that are not of an earlier pass. Right: an Error that names
// first_id (Pass).
TEST(OddLoad, KeysOfThisPass) {
  const Ball ball;
  Renderer renderer({.threads = 2});
  Image<std::uint64_t> keys(64, 48);
  Image<Rgba8> image(64, 48);
  Image<std::int64_t> ids(64, 48);
  ball.draw(renderer, {.ids = ids, .keys = keys});
  const auto last = static_cast<std::uint64_t>(std::ranges::max(ids.pixels()));
  for (const std::uint64_t first_id : {std::uint64_t{5}, last})
    expect_refused("first_id", [&] {
      ball.draw(renderer, {.color8 = image, .keys = keys}, {.load = true, .first_id = first_id});
    });
  ball.draw(renderer, {.color8 = image, .keys = keys}, {.load = true, .first_id = last + 1});
  // They are those of a pass before this one.
  ball.draw(renderer, {.color8 = image, .keys = keys},
            {.load = true, .first_id = ball.scene.primitive_count()});
}

// A place, corners or edges of a primitive that does not exist. Right: an Error (pick.hpp,
// effects.hpp).
TEST(OddPick, PlacesOfNoPrimitive) {
  const Ball ball;
  const SceneView scene = ball.binding.view();
  expect_refused("out of range", [&] { (void)position(scene, {0, 1'000'000'000}, {}); });
  expect_refused("instance 7 is out of range", [&] { (void)position(scene, {7, 0}, {}); });
  expect_refused("out of range",
                 [&] { (void)barycentrics(scene, ball.camera, 64, 48, 1'000'000'000, 0, 0); });
  expect_refused("image size", [&] { (void)barycentrics(scene, ball.camera, 0, -3, 0, 0, 0); });
  const SceneEdges edges(scene);
  expect_refused("out of range", [&] { (void)edges.find(1'000'000'000); });
  expect_refused("out of range", [&] { (void)edges.sides({7, 0}); });
  expect_refused("out of range", [&] { (void)edges.sides({0, 1'000'000'000}); });
}

// A view of three values at null. Right: an Error where the view is made; a view of none is
// valid (array.hpp).
TEST(OddArray, NullWithACount) {
  const float* const none = nullptr;
  const std::uint32_t* const no_indices = nullptr;
  const std::string said = "null";
  expect_refused(said, [&] { (void)ArrayView<Vec3>::of(none, 3); });
  expect_refused(said, [&] { (void)ArrayView<Vec4>::rgb(none, 3); });
  expect_refused(said, [&] {
    (void)ArrayView<Vec3>(std::span<const Vec3>{(const Vec3*)nullptr, 3});
  });
  expect_refused("beyond",
                 [&] { (void)ArrayView<float>::in({}, {.count = 3, .stride_bytes = 0}); });
  expect_refused(said, [&] { (void)IndexView::of(no_indices, 3); });
  expect_refused(said, [&] { (void)ScalarView::of(none, 3); });
  EXPECT_TRUE(ArrayView<Vec3>::of(none, 0).empty());
  EXPECT_TRUE(IndexView::of(no_indices, 0).empty());
  EXPECT_TRUE(ScalarView::of(none, 0).empty());
}

terrain::Terrain small_map() {
  terrain::HeightMap map{.heights = Image<float>(4, 4)};
  return terrain::Terrain(std::move(map));
}

// The surface of a terrain that is a map. Right: an Error (terrain.hpp).
TEST(OddTerrain, SurfaceOfAMap) {
  expect_refused("map", [] { (void)small_map().surface(); });
}

// Two threads draw pictures of two sizes with one Annotator. Right: they take turns: the
// pictures of one thread (threads.md).
TEST(OddAnnotator, TwoThreads) {
  const Ball ball;
  Annotator annotator(1);
  Annotations all;
  all.occlusion.emplace();
  all.silhouettes.emplace();
  all.edges.emplace();
  const auto draw = [&](int width) {
    Renderer renderer({.threads = 1});
    FrameOptions frame = ball.frame;
    frame.width = width;
    Image<Rgba8> image(width, frame.height);
    annotator.render(renderer, ball.binding.view(), ball.camera, frame, all, {.color8 = image});
    return digest(image);
  };
  const Digest narrow = draw(40), wide = draw(400);
  const auto repeat = [&](int width, const Digest& right) {
    for (int i = 0; i < 20; ++i) EXPECT_EQ(draw(width), right);
  };
  std::jthread other([&] { repeat(400, wide); });
  repeat(40, narrow);
}

// An object that was moved from is used. Right: an Error that says so (held.hpp).
TEST(OddMoved, FromSaysSo) {
  const std::string said = "was moved from";
  const Ball ball;
  const SceneView scene = ball.binding.view();
  Image<Rgba8> image(64, 48);
  Image<float> depth(64, 48);
  const auto left_by = [](auto& object) { auto other = std::move(object); };

  Renderer renderer({.threads = 1});
  left_by(renderer);
  expect_refused(said, [&] { (void)ball.picture(renderer); });
  expect_refused(said, [&] { (void)renderer.options(); });
  expect_refused(said, [&] { (void)renderer.pick(scene, ball.camera, ball.frame, 1, 1); });
  expect_refused(said, [&] { (void)SceneOnTerrain(std::move(renderer)); });

  Annotator annotator(1);
  left_by(annotator);
  Renderer working({.threads = 1});
  const auto annotate = [&] {
    annotator.render(working, scene, ball.camera, ball.frame, {.title = "ball"}, {.color8 = image});
  };
  expect_refused(said, annotate);

  Effects effects(1);
  left_by(effects);
  expect_refused(said, [&] { effects.darken(image, {}, depth.view()); });

  terrain::TerrainRenderer ground;
  left_by(ground);
  const auto draw_ground = [&] {
    ground.render(small_map(), {}, {.width = 64, .height = 48}, {.color8 = image});
  };
  expect_refused(said, draw_ground);
  expect_refused(said, [&] { (void)ground.options(); });

  SceneOnTerrain standing{Renderer({.threads = 1})};
  left_by(standing);
  expect_refused(said, [&] {
    standing.draw({}, ball.frame, {.width = 64, .height = 48}, {},
                  {.color8 = image, .depth = depth});
  });

  SceneBinding binding(ball.scene);
  left_by(binding);
  expect_refused(said, [&] { (void)binding.view(); });
  expect_refused(said, [&] { binding.prepare(1); });

  const TempFolder folder;
  io::write_ply(folder.path("ball.ply"), ball.scene.meshes[0]);
  OutOfCoreFile file(folder.path("ball.ply"));
  left_by(file);
  expect_refused(said, [&] { (void)file.triangles(); });
  expect_refused(said, [&] { file.render(ball.camera, ball.frame, {.color8 = image}, {}); });
  io::AtomicFile out(folder.path("a.png"));
  io::PictureRows rows(out, io::PictureRows::Format::png, 64, 48);
  left_by(rows);
  expect_refused(said, [&] { rows.finish(); });

  SceneEdges edges(scene);
  left_by(edges);
  expect_refused("out of range", [&] { (void)edges.find(0); });
}

// A terrain, an environment, a prepared mesh or colours were moved. Right: the source stays
// usable, because its contents are shared. Immutable objects that share their contents: a move
// is a copy and leaves the source unchanged.
TEST(OddMoved, FromIsShared) {
  const Ball ball;
  PreparedMesh prepared(ball.scene.meshes[0].view(), 1);
  const PreparedMesh others = std::move(prepared);
  EXPECT_EQ(prepared.cluster_count(), others.cluster_count());

  terrain::Terrain map = small_map();
  const terrain::Terrain other_map = std::move(map);
  EXPECT_EQ(map.height_at(1, 1), other_map.height_at(1, 1));

  Image<Vec3> bright(16, 8);
  std::ranges::fill(bright.pixels(), Vec3{1, 2, 3});
  Environment sky(std::as_const(bright).view(), 1);
  const Environment other_sky = std::move(sky);
  EXPECT_EQ(sky.mean().x, other_sky.mean().x);

  ScalarColors colors({}, {0, 1});
  const ScalarColors other_colors = std::move(colors);
  EXPECT_EQ(colors(0.5).x, other_colors(0.5).x);

  // A copy outlives what it was made of.
  std::optional<SceneBinding> first(std::in_place, ball.scene);
  const SceneBinding copy = *first;
  first.reset();
  EXPECT_EQ(copy.view().instances.size(), 1U);
  EXPECT_EQ(primitive_count(copy.view().instances[0].geometry), ball.scene.primitive_count());
}

// A rank returns while the others wait for it. Right: an Error that names it, on all ranks
// (LocalRanks::run).
TEST(OddRanks, OneReturns) {
  for (const int who : {0, 1, 2}) {
    LocalRanks ranks(3);
    const auto run = [&] {
      ranks.run([who](Communicator& communicator) {
        if (communicator.rank() != who) (void)communicator.max(1);
      });
    };
    expect_refused("rank " + std::to_string(who) + " has returned", run);
    // The ranks work again.
    ranks.run([](Communicator& communicator) { EXPECT_EQ(communicator.max(7), 7U); });
  }
}

// A rank runs its own ranks. Right: an Error (LocalRanks::run).
TEST(OddRanks, RunWithinRun) {
  LocalRanks ranks(2);
  expect_refused("run already",
                 [&] { ranks.run([&](Communicator&) { ranks.run([](Communicator&) {}); }); });
  ranks.run([](Communicator& communicator) { EXPECT_EQ(communicator.max(7), 7U); });
}

// A vertex of a prepared mesh moves by 0.1 %, or a corner names another vertex. Right: check()
// finds it, and so do frames of a library built without NDEBUG (prepared_mesh.hpp).
TEST(OddPrepared, MeshChanges) {
  Mesh mesh = shapes::torus_knot(2, 3, 400, 24);
  const auto twin = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back(mesh.positions[mesh.indices[0]]);
  mesh.normals.values.push_back(mesh.normals.values[mesh.indices[0]]);
  const PreparedMesh prepared(mesh.view(), 1);
  prepared.check();
  const InstanceView instance{.geometry = prepared.view()};
  const SceneView scene{{&instance, 1}, {}, {}, {}};
  const Camera camera = fit_camera(scene, 0.8F, false);
  const auto draw = [&] {
    (void)render(scene, camera, {.width = 64, .height = 48}, {.threads = 1});
  };
  draw();
  for (std::size_t i = 0; i < mesh.positions.size(); i += 501) {
    const Vec3 before = std::exchange(mesh.positions[i], mesh.positions[i] * 1.001F);
    expect_refused("prepare it again", [&] { prepared.check(); });
#if !defined(NDEBUG)
    expect_refused("prepare it again", draw);
#endif
    mesh.positions[i] = before;
  }
  // Another vertex at the same place may have another normal.
  const std::uint32_t before = std::exchange(mesh.indices[0], twin);
  expect_refused("triangle 0 ", [&] { prepared.check(); });
  mesh.indices[0] = before;
  std::swap(mesh.indices[3000], mesh.indices[3001]);
  expect_refused("triangle 1000", [&] { prepared.check(); });
}

}  // namespace

}  // namespace rastrum::test::library_troubles
