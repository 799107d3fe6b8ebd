// SPDX-License-Identifier: BSD-3-Clause
// An empty picture comes with its reason and a remedy, and the remedy works.
#include <algorithm>
#include <array>

#include "program.hpp"
#include "tests/io/gltf_document.hpp"

namespace rastrum::test::nothing_seen_test {
namespace {

class NothingSeen : public Program {
 protected:
  /// Renders an empty picture: a warning with this reason and this remedy, and status 0. With
  /// `cure` instead of the options, something is visible and there is no warning.
  void expect(const Args& inputs, const Args& options, const std::string& reason,
              const std::string& remedy, const Args& cure) const {
    const std::string said = must(command(inputs, options));
    EXPECT_TRUE(holds(said, "warning: nothing is seen: " + reason + "; "));
    EXPECT_TRUE(holds(said, remedy));
    const Image<Rgba8> empty = png("p.png");
    EXPECT_TRUE(std::ranges::all_of(empty.pixels(), [](Rgba8 p) { return p.a == 0; }));
    EXPECT_EQ(must(command(inputs, options) + "--quiet"), "");

    const std::string cured = must(command(inputs, cure));
    EXPECT_FALSE(holds(cured, "nothing is seen"));
    EXPECT_TRUE(std::ranges::any_of(png("p.png").pixels(), [](Rgba8 p) { return p.a != 0; }));
  }
  static Args command(const Args& inputs, const Args& options) {
    return "render --look plain -o p.png --size 40x30" + inputs + options;
  }
  /// write_triangle's triangle with a material.
  void write_gltf(const std::string& material) const {
    GltfDocument d;
    d.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    write("s.gltf",
          d.text(R"("nodes":[{"mesh":0}],"materials":[)" + material +
                 R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}])"));
  }
  /// Counter-clockwise as seen from +z.
  void write_triangle() const { write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"); }
};

TEST_F(NothingSeen, OfShapes) {
  const std::string beyond = "all 12 triangles lie outside of the view";
  for (const auto& [input, options, reason, remedy, cure] : std::vector<std::array<std::string, 5>>{
           {"builtin:boxes?count=1", "--eye 0,0,5 --target 0,0,9",
            "all 12 triangles lie behind the camera", "--fit instead of --eye", "--fit"},
           {"builtin:boxes?count=1", "--eye 0,0,5 --target 9,0,4", beyond, "--fit instead of --eye",
            "--fit"},
           {"builtin:boxes?count=1", "--orthographic 1 --target 50,0,0 --eye 50,0,9", beyond,
            "--fit", "--orthographic fit"},
           {"builtin:boxes?count=1", "--near 100",
            "all 12 triangles lie in front of the near plane", "leave out --near", ""},
           {"builtin:sphere", "--eye 0,0,100000", "all 3968 triangles are smaller than a pixel",
            "--fit", "--fit"},
           {"builtin:sphere", "--opacity 0", "--opacity 0 makes all of it transparent", "larger",
            "--opacity 0.5"}})
    expect(input, options, reason, remedy, cure);
}

TEST_F(NothingSeen, Culled) {
  write_triangle();
  expect("t.obj", "--cull front", "the one triangle faces the side that --cull leaves out",
         "--cull none", "--cull none");
  expect("t.obj", "--cull back --eye 0,0,-3",
         "the one triangle faces the side that --cull leaves out", "--cull none",
         "--cull none --eye 0,0,-3");
}

TEST_F(NothingSeen, OfASingleSidedMaterial) {
  write_gltf("{}");
  expect("s.gltf", "--eye 0,0,-3", "the one triangle shows the back of a single-sided material",
         "--shader phong", "--eye 0,0,-3 --shader phong");
}

TEST_F(NothingSeen, CutOutByItsMaterial) {
  write_gltf(R"({"alphaMode":"MASK","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.25]}})");
  const std::string said = must(command("s.gltf", "--heatmap h.png"));
  EXPECT_TRUE(
      holds(said, "nothing is seen: the alpha of its materials (MASK) cuts all of it out; "));
  EXPECT_TRUE(holds(said, "--heatmap shows where it is"));
  const Image<Rgba8> heat = png("h.png");
  EXPECT_TRUE(std::ranges::any_of(heat.pixels(), [](Rgba8 p) { return p.r != 0; }));
}

TEST_F(NothingSeen, EdgeOn) {
  // A floor that the camera along -z sees edge-on.
  write("floor.obj", "v 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nf 1 2 3 4\n");
  expect("floor.obj", {}, "all 2 triangles are seen edge-on",
         "look from elsewhere, as with --eye 4.263,3.394,6.525", "--eye 4.263,3.394,6.525");
}

TEST_F(NothingSeen, ThinnerThanAPixel) {
  // A ribbon of 4 by 1e-3, seen from its front: no other eye would see more of it.
  write("wire.obj", "v -2 0 0\nv 2 0 0\nv 2 1e-3 0\nv -2 1e-3 0\nf 1 2 3 4\n");
  expect("wire.obj", "--eye 0.1,0.3,5 --target 0,0,0", "all 2 triangles are thinner than a pixel",
         "bring --eye nearer", "--eye 0,0,0.02 --target 0,0,0");
}

TEST_F(NothingSeen, BetweenTheSamples) {
  // 0.3 pixels high and many wide.
  write("sliver.obj", "v -4 0 0\nv 4 0 0\nv 4 0.1 0\nf 1 2 3\n");
  expect("sliver.obj", "--eye 0,0,9 --target 0,0,0",
         "the one triangle falls between the pixels' centres", "--samples 16",
         "--eye 0,0,9 --target 0,0,0 --samples 16");
}

TEST_F(NothingSeen, SeveralReasonsTheMostFrequentFirst) {
  write("m.obj",
        "v 0 0 9\nv 1 0 9\nv 0 1 9\nv 90 0 0\nv 91 0 0\nv 90 1 0\nv 0 0 8\nf 1 2 3\nf 4 5 6\n"
        "f 1 2 7\nf 1 1 1\n");
  expect("m.obj", "--eye 0,0,5 --target 0,0,0",
         "of 4 triangles 2 lie behind the camera, 1 has no area, 1 lies outside of the view",
         "--fit", "--eye 0,0,15 --target 0,0,0");
}

TEST_F(NothingSeen, NoTriangles) {
  write("loose.obj", "v 0 0 0\n");
  const std::string said = must(command("loose.obj", {}));
  EXPECT_TRUE(holds(said, "warning: nothing is seen: there are no triangles to draw"));
}

TEST_F(NothingSeen, AFileWithTheNameOfAnother) {
  write("solid.obj",
        "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid s\n");
  const Outcome r = run(command("solid.obj", {}));
  EXPECT_TRUE(holds(r.err, "it begins as a .stl file does: give it that name"));
  must("make sphere -o s.ply");
  std::filesystem::rename(path("s.ply"), path("s.stl"));
  EXPECT_TRUE(holds(run(command("s.stl", {})).err, "it begins as a .ply file does"));
}

TEST_F(NothingSeen, DamagedNumbers) {
  write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_TRUE(holds(must(command("nan.obj", {})), "the one triangle has a NaN or infinite vertex"));
}

TEST_F(NothingSeen, IsNotSaidOfTranslucentOrSampledPictures) {
  for (const char* options :
       {"--opacity 0.3", "--opacity 0.3 --samples 4", "--samples 8",
        "--opacity 0.5 --transparency filter:2", "--device serial --opacity 0.3"})
    EXPECT_FALSE(holds(must(command("builtin:sphere", options)), "nothing is seen"));
}

TEST_F(NothingSeen, PicturesOfAPath) {
  write("p.json", R"({"keys":[{"time":0,"eye":[0,0,5],"target":[0,0,0]},
                              {"time":1,"eye":[0,0,5],"target":[0.1,0,9]}]})");
  const std::string said = must(
      "render --look plain builtin:boxes?count=1 --size 32x24 --path p.json --fps 1 -o f%d.png");
  EXPECT_TRUE(holds(said,
                    "warning: nothing is seen in 1 of 2 pictures; in number 1, the first of "
                    "them, all 12 triangles lie behind the camera"));
}

}  // namespace
}  // namespace rastrum::test::nothing_seen_test
