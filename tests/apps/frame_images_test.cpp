// SPDX-License-Identifier: BSD-3-Clause
// `--image NAME=FILE` and `--clip-plane`, the program's options for the library's Targets.
#include <string>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "program.hpp"

namespace rastrum::test::frame_images_test {
namespace {

using FrameImages = Program;

TEST_F(FrameImages, HoldWhatTheLibraryHas) {
  constexpr int kW = 40, kH = 30;
  must(
      "render --look plain builtin:sphere --size 40x30 --eye 0,0.5,3 --target 0,0,0 --near 1 "
      "--clip-plane 1,0,0,0.25 --image positions=p.npy --image instances=i.npy --image "
      "barycentrics=b.npy --image distance=d.npy");
  const Mesh mesh = shapes::sphere();
  const MeshView view = mesh.view();
  const InstanceView instance{view};
  FrameOptions frame{.width = kW, .height = kH, .clip_planes = {{{1, 0, 0}, 0.25}}};
  Camera camera{.eye = {0, 0.5, 3}, .near_plane = 1};
  Image<Vec3> positions(kW, kH);
  Image<std::int64_t> instances(kW, kH);
  Image<Vec2> barycentrics(kW, kH);
  Image<float> distance(kW, kH);
  Targets targets{.instances = instances,
                  .barycentrics = barycentrics,
                  .positions = positions,
                  .distance = distance};
  Renderer().render({.instances = {&instance, 1}}, camera, frame, targets);
  EXPECT_TRUE(npy("i.npy").holds(instances));
  EXPECT_TRUE(npy("p.npy").holds(positions));
  EXPECT_TRUE(npy("b.npy").holds(barycentrics));
  EXPECT_TRUE(npy("d.npy").holds(distance));
  EXPECT_TRUE(holds(npy("p.npy").header, "(30, 40, 3)"));
}

TEST_F(FrameImages, AreNumberedInSequences) {
  must("render --look plain builtin:boxes --size 16x16 --turntable 3 --image normals=n%d.npy");
  EXPECT_NE(read("n0.npy"), read("n1.npy"));
}

TEST_F(FrameImages, RefuseWhatIsNone) {
  const auto refused = [&](const Args& more, const char* part) {
    Program::refused("render --look plain builtin:sphere --size 8x8" + more, part);
  };
  refused("--image position=p.npy", "instances, primitives");
  refused("--image positions", "NAME=FILE");
  refused("--image positions=p.png", ".npy, .exr");
  refused("--image instances=i.exr", ".npy");
  refused("--image positions=p.npy --image normals=p.npy", "give each its own");
  refused("-o a.png --clip-plane 1,0,0", "four numbers");
  refused("-o a.png --clip-plane 0,0,0,1", "the normal must not be 0");
}

}  // namespace
}  // namespace rastrum::test::frame_images_test
