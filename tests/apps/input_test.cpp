// SPDX-License-Identifier: BSD-3-Clause
// INPUT…: several at once, builtins and their places, materials, cameras, messages of readers.
#include <algorithm>
#include <set>

#include <rastrum/shapes.hpp>

#include "job/inputs.hpp"
#include "program.hpp"
#include "tests/io/gltf_document.hpp"

#include "tests/support/painter.hpp"

namespace rastrum::test::input_test {
namespace {

class Inputs : public Program {
 protected:
  /// The visible ids left and right of the middle of an 80 × 40 picture.
  struct Halves {
    std::set<std::int64_t> left, right;
  };
  [[nodiscard]] Halves ids_of(const Args& inputs) const {
    must("render --look plain" + inputs + "--ids i.npy --size 80x40");
    const std::vector<std::int64_t> ids = npy("i.npy").values<std::int64_t>();
    Halves halves;
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] >= 0) (i % 80 < 40 ? halves.left : halves.right).insert(ids[i]);
    return halves;
  }
};

TEST_F(Inputs, IdsCountThroughThemInCommandOrder) {
  write("a.obj", "v -2 0 0\nv -1 0 0\nv -1 1 0\nf 1 2 3\n");
  write("b.obj", "v 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3 4\n");
  using Ids = std::set<std::int64_t>;
  const Halves ab = ids_of({"a.obj", "b.obj"});
  EXPECT_EQ(ab.left, (Ids{0}));
  EXPECT_EQ(ab.right, (Ids{1, 2}));
  const Halves ba = ids_of({"b.obj", "a.obj"});
  EXPECT_EQ(ba.left, (Ids{2}));
  EXPECT_EQ(ba.right, (Ids{0, 1}));
  const Halves aba = ids_of({"a.obj", "b.obj", "a.obj"});
  EXPECT_EQ(aba.left, (Ids{0})) << "the first submitted wins equal depths";
}

TEST_F(Inputs, BuiltinsStandWhereTheyArePlaced) {
  Scene scene = scene_of(shapes::boxes(1));
  scene.append(scene_of(shapes::sphere(8, 12)));
  Mat4d& m = scene.instances[1].object_to_world;
  m.m[0][0] = m.m[1][1] = m.m[2][2] = 0.75;
  m.m[0][3] = 2.5;
  m.m[1][3] = -1;
  m.m[2][3] = 0.125;
  RenderOptions options({.width = 90, .height = 60});
  const Drawn expected = draw(scene, fit(scene, options), options);
  for (const std::string sphere :
       {"builtin:sphere?rings=8,segments=12,x=2.5,y=-1,z=0.125,scale=0.75",
        "builtin:sphere?scale=0.75&x=2.5&rings=8&y=-1&segments=12&z=0.125"}) {
    EXPECT_TRUE(same_pixels(drawn("render --look plain builtin:boxes?count=1 --ids i.npy --size "
                                  "90x60 " +
                                  sphere),
                            expected.color8))
        << sphere;
    EXPECT_TRUE(npy("i.npy").holds(expected.ids)) << sphere;
  }
}

TEST_F(Inputs, MaterialIsTheShaderWhereAFileHasMaterials) {
  write("m.mtl", "newmtl red\nKd 0.8 0.1 0.1\n");
  write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
  const Args args("render --look plain m.obj --size 32x32");
  EXPECT_TRUE(same_pixels(drawn(args), drawn(args + "--shader material")));
  EXPECT_FALSE(same_pixels(drawn(args), drawn(args + "--shader phong")));
}

TEST_F(Inputs, CameraOfAFileIsUsedOnlyWhenAskedFor) {
  // One triangle; two cameras, the second (at z = 5, 40° high) behind a node's translation.
  GltfDocument d;
  d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  write(
      "c.gltf",
      d.text(
          R"("nodes":[{"mesh":0},{"camera":0,"translation":[0,0,3]},{"camera":1,"translation":[0.5,0,5]}],)"
          R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1,"aspectRatio":1}},)"
          R"({"type":"perspective","perspective":{"yfov":0.6981317,"znear":0.25,"zfar":50,"aspectRatio":1}}],)"
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])"));
  Camera camera{.eye = {0.5F, 0, 5},
                .target = {0.5F, 0, 4},
                .fov_rad = 0.6981317F,
                .near_plane = 0.25F,
                .far_plane = 50};
  const Scene scene = scene_of({.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
  RenderOptions options({.width = 48, .height = 48});
  const auto expect = [&](const Args& extra, const Camera& its) {
    must("render --look plain c.gltf --depth d.npy --size 48x48" + extra);
    EXPECT_TRUE(npy("d.npy").holds(draw(scene, its, options).depth)) << extra;
  };
  expect("--camera 1", camera);
  expect({}, fit(scene, options));
  camera.near_plane = 1;
  expect("--camera 1 --near 1", camera);
  refused("render --look plain c.gltf -o p.png --camera 2",
          "--camera: the inputs have cameras 0 to 1");
}

TEST_F(Inputs, WarningsOfReadersAreShown) {
  write("w.obj", "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
  const std::string said = must("render --look plain w.obj -o p.png --size 8x8");
  EXPECT_EQ(said.find("warning: "), 0U) << said;
  EXPECT_TRUE(holds(said, "gone.mtl"));
}

TEST_F(Inputs, AnEmptySceneIsDrawnAndSaid) {
  write("e.obj", "v 0 0 0\n");
  EXPECT_TRUE(holds(must("render --look plain e.obj -o p.png --size 8x8 --background #010203"),
                    "warning: nothing is seen: there are no triangles to draw"));
  EXPECT_EQ(png("p.png")(3, 3), (Rgba8{1, 2, 3, 255}));
}

TEST_F(Inputs, InfoTellsWhatAFileHolds) {
  write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\n");
  const Outcome r = run("info t.obj builtin:sphere?rings=4,segments=6");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(r.out.find("t.obj\n"), 0U) << r.out;
  EXPECT_TRUE(holds(r.out, "2 triangles"));
  EXPECT_TRUE(holds(r.out, "builtin:sphere?rings=4,segments=6\n"));
  EXPECT_TRUE(holds(r.out, "36 triangles"));  // 2 (4 − 1) 6
  EXPECT_EQ(run("info gone.obj").status, 1);
}

}  // namespace
}  // namespace rastrum::test::input_test
