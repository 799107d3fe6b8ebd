// SPDX-License-Identifier: BSD-3-Clause
// Compares Rastrum's `phong` with Embree's traced rays.
#include <bench/peers/compare.hpp>
#include <bench/peers/embree_peer.hpp>
#include <bench/scenes.hpp>

#include <optional>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/render.hpp>

#include "tests/support/painter.hpp"

namespace rastrum::bench::embree_peer_test {
namespace {

using test::RenderOptions;

TEST(EmbreePeer, TracesTheSamePicture) {
  std::optional<EmbreePeer> embree;
  try {
    embree.emplace(2);
  } catch (const Error& e) {
    if (e.code() != Errc::no_device) throw;
    GTEST_SKIP() << e.what();
  }
  const Mesh mesh = load(scene_by_name("torus-knot"));
  const MeshView view = mesh.view();
  embree->set_mesh(view);
  const InstanceView instance{view};
  const SceneView scene{.instances = {&instance, 1}};
  const Camera camera = fit_camera(scene, 1.04719755F, false);
  // Not a multiple of a packet or a tile.
  RenderOptions options({.width = 501, .height = 333});
  Image<Rgba8> traced(options.width, options.height);
  EXPECT_THROW(embree->trace(camera, traced.view()), Error);  // nothing is built yet
  embree->build();
  embree->trace(camera, traced.view());
  const ColorDifference d = compare_colors(render(scene, camera, options), traced, 1);
  EXPECT_GT(d.covered, 10'000U);
  EXPECT_GE(d.share(), 0.998);
}

}  // namespace
}  // namespace rastrum::bench::embree_peer_test
