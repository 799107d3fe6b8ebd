// SPDX-License-Identifier: BSD-3-Clause
// `rastrum terrain --mesh --sprite`: the picture equals the library's with the same objects, placed
// by the command line, on the ground if no height is given, and along paths. Invalid places are
// refused.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <rastrum/io.hpp>
#include <rastrum/on_terrain.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/terrain.hpp>

#include "hills.hpp"

#include "tests/support/painter.hpp"

namespace rastrum::test::terrain_objects_test {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

class TerrainObjectsProgram : public ProgramOnHills {
 protected:
  void SetUp() override {
    ProgramOnHills::SetUp();
    options_.distance = 120;
    options_.filter = terrain::MapFilter::none;  // objects stand on cells
    options_.step = 1;
    camera_ = {30, 58, 40, 0, 10, 0};
    sprite_ = Image<Rgba8>(4, 8);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 4; ++x)
        sprite_(x, y) = {200, static_cast<std::uint8_t>(30 * y), 20,
                         static_cast<std::uint8_t>(x == 0 ? 0 : 100 + 50 * x)};
    io::write_png(path("tree.png"), sprite_.view());
  }

  [[nodiscard]] static Args with(const Args& extra) {
    const Args args(
        "terrain --height h.png --color c.png --size 96x64 --altitude 40 --horizon 10 --position "
        "30,58 --distance 120");
    const auto says = [&](const char* option) {
      return std::ranges::find(extra, option) != extra.end();
    };
    return args + (says("-o") ? "" : "-o p.png") +
           (says("--filter") || says("--classic") ? "" : "--filter none") + extra;
  }
  struct Drawn {
    Image<Rgba8> color{kWidth, kHeight};
    Image<float> depth{kWidth, kHeight};
  };
  /// The library's picture; without a scene only the terrain.
  [[nodiscard]] Drawn drawn(const Scene* scene, RenderOptions how = {},
                            const std::vector<std::size_t>& facing = {}) const {
    Drawn d;
    const terrain::Terrain ground(
        terrain::HeightMap{Image<float>(map_.heights), Image<Rgba8>(map_.colors)});
    const terrain::TerrainTargets targets{.color8 = d.color, .depth = d.depth};
    const terrain::TerrainStats stats = TerrainPainter(options_).render(ground, camera_, targets);
    if (scene == nullptr) return d;
    how.width = kWidth;
    how.height = kHeight;
    SceneOnTerrain(family::make_renderer(how, how))
        .draw({SceneBinding(*scene).view(), facing}, how, options_, stats.camera, targets);
    return d;
  }
  [[nodiscard]] static Mat4d at(double x, double up, double y, double scale, double turn_deg = 0) {
    const double s = std::sin(turn_deg * kRadians) * scale,
                 c = std::cos(turn_deg * kRadians) * scale;
    return {{{c, 0, s, x}, {0, scale, 0, up}, {-s, 0, c, y}, {0, 0, 0, 1}}};
  }
  [[nodiscard]] static Scene box(const Mat4d& where) {
    Scene scene = scene_of(shapes::from_spec("boxes?count=1&fill=1"));
    scene.instances[0].object_to_world = where;
    return scene;
  }
  void expect(const Drawn& wanted, const std::string& what, const char* file = "p.png") const {
    const Image<Rgba8> got = png(file);
    EXPECT_TRUE(same_pixels(got, wanted.color)) << what;
    EXPECT_FALSE(same_pixels(got, drawn(nullptr).color)) << what << ": nothing stands there";
  }

  Image<Rgba8> sprite_;
};

const std::string kBox = "builtin:boxes?count=1,fill=1";

TEST_F(TerrainObjectsProgram, AMeshStandsOnTheGround) {
  // The box is centred on its origin, so its lowest point is half of its size below.
  const double ground = static_cast<double>(map_.heights(20, 30));
  must(with("--mesh " + kBox + "@x=20.5,y=30.25,scale=8"));
  const Scene standing = box(at(20.5, ground + 4, 30.25, 8));
  expect(drawn(&standing), "on the ground");
  must(with("--mesh " + kBox + "@x=20.5,y=30.25,scale=8,height=30,turn=25"));
  const Scene above = box(at(20.5, 34, 30.25, 8, 25));
  expect(drawn(&above), "at a height, turned");
  must(with("--mesh builtin:boxes?count=1,fill=1,x=28,y=22,z=30,scale=7"));
  const Scene own = box(at(28, 22, 30, 7));
  expect(drawn(&own), "in the terrain's coordinates");
}

TEST_F(TerrainObjectsProgram, ASurfaceBetweenCellsIsTheGroundOfTheBilinearFilter) {
  options_.filter = terrain::MapFilter::bilinear;
  options_.step = 0;
  const auto h = [&](int x, int y) { return static_cast<double>(map_.heights(x, y)); };
  // (20.75, 30.25) lies a quarter past the centre of cell 20 and a quarter before that of row 30.
  const double above = 0.75 * h(20, 29) + 0.25 * h(21, 29),
               below = 0.75 * h(20, 30) + 0.25 * h(21, 30);
  const Scene standing = box(at(20.75, 0.25 * above + 0.75 * below + 4, 30.25, 8));
  must(with("--filter bilinear --mesh " + kBox + "@x=20.75,y=30.25,scale=8"));
  expect(drawn(&standing), "bilinear");
}

TEST_F(TerrainObjectsProgram, OptionsOfMeshesAreThoseOfRender) {
  RenderOptions how({.shader = Shader::normal, .cull = Cull::back, .opacity = 0.4F});
  const Scene standing = box(at(24, 25, 30, 9));
  for (const Args& machine : {Args(), Args("--threads 2 --memory-limit 3M")}) {
    Args args = with("--mesh " + kBox +
                     "@x=24,y=30,scale=9,height=20.5 --shader normal --opacity 0.4 --cull back "
                     "--depth d.npy --stats s.json");
    must(args + machine);
    const Drawn wanted = drawn(&standing, how);
    expect(wanted, "glass");
    EXPECT_TRUE(npy("d.npy").holds(wanted.depth));
    EXPECT_EQ(json("s.json")["objects"]["triangles"], 12);
    EXPECT_TRUE(json("s.json")["stages_ms"].contains("objects"));
  }
  options_.classic = true;
  const Scene higher = box(at(24, 36.5, 30, 9));
  must(with("--classic --mesh " + kBox +
            "@x=24,y=30,scale=9,height=32 --shader normal --opacity 0.4 --cull back"));
  expect(drawn(&higher, how), "classic");
}

TEST_F(TerrainObjectsProgram, AMeshTakesTheLookOfAnInput) {
  // A look does not change the place, on the ground or at coordinates.
  for (const auto& [place, at] :
       {std::pair{"@x=20.5,y=30.25,scale=8", ","}, {",x=28,y=22,z=30,scale=7", "@"}}) {
    must(with("--mesh " + kBox + place + " --opacity 0.4"));
    const Image<Rgba8> all = png("p.png");
    must(with("--mesh " + kBox + place + at + "opacity=0.4"));
    EXPECT_TRUE(same_pixels(png("p.png"), all)) << place;
  }
}

TEST_F(TerrainObjectsProgram, SpritesAndMeshesInCommandOrder) {
  Scene scene = sprite(Image<Rgba8>(sprite_));
  scene.instances[0].object_to_world = at(25, static_cast<double>(map_.heights(25, 40)), 40, 12);
  scene.append(box(at(34, 24, 30, 8)));
  Scene second = sprite(Image<Rgba8>(sprite_));
  second.instances[0].object_to_world = at(36, 25, 45, 5);
  scene.append(std::move(second));
  RenderOptions how({.shader = Shader::material});
  must(
      with("--sprite tree.png@x=25,y=40,size=12 --mesh " + kBox +
           "@x=34,y=30,height=20,scale=8 --sprite tree.png@height=25,x=36,y=45,size=5 --angle 10"));
  camera_.angle_rad = 10 * kRadians;
  expect(drawn(&scene, how, {0, 2}), "three objects");
}

TEST_F(TerrainObjectsProgram, AlongAPathAndForSeveralFrames) {
  write("p.json", R"({"keys": [{"angle": 0}, {"time": 1, "angle": 20, "roll": 15}]})");
  const std::string mesh = kBox + "@x=24,y=30,scale=9";
  must(with(
      {"--mesh", mesh, "--path", "p.json", "--fps", "1", "-o", "f%d.png", "--depth", "f%d.npy"}));
  const Scene standing = box(at(24, static_cast<double>(map_.heights(24, 30)) + 4.5, 30, 9));
  expect(drawn(&standing), "first", "f0.png");
  camera_.angle_rad = 20 * kRadians;
  camera_.roll_rad = 15 * kRadians;
  const Drawn last = drawn(&standing);
  expect(last, "last", "f1.png");
  EXPECT_TRUE(npy("f1.npy").holds(last.depth));
  camera_.angle_rad = camera_.roll_rad = 0;
  must(with("--mesh " + mesh + " --frames 3"));
  expect(drawn(&standing), "a frame is not drawn over the one before");
}

TEST_F(TerrainObjectsProgram, RefusesWhatCannotStand) {
  const auto refuse = [&](int status, const std::string& part, const Args& extra) {
    refused(with(extra), part, status);
    EXPECT_FALSE(std::filesystem::exists(path("p.png"))) << part;
  };
  refuse(1, "gone.obj", "--mesh gone.obj@x=1,y=1");
  refuse(1, "gone.png", "--sprite gone.png@x=1,y=1");
  refuse(2, "no shape 'castle'", "--mesh builtin:castle@x=1,y=1");
  refuse(2, "off the map, which has 60x60 cells", "--mesh " + kBox + "@x=60,y=1");
  refuse(2, "off the map", "--sprite tree.png@x=1,y=-0.5");
  refuse(2, "--mesh: x and y are missing", "--mesh " + kBox + "@x=1");
  refuse(2,
         "expected x, y, height, scale, turn, rx, ry, rz, color and opacity after @, got 'size=2'",
         "--mesh " + kBox + "@x=1,y=1,size=2");
  refuse(2, "--mesh scale: expected a number, got 'big'", "--mesh " + kBox + "@x=1,y=1,scale=big");
  refuse(2, "scale must be above 0", "--mesh " + kBox + "@x=1,y=1,scale=0");
  refuse(2, "say where it stands", "--sprite tree.png");
  refuse(2, "--projection planar", "--mesh " + kBox + "@x=1,y=1 --projection cylindrical");
  refuse(2, "depth needs a whole picture", "--mesh " + kBox + "@x=1,y=1 --shader depth");
  EXPECT_EQ(run(with("--mesh " + kBox + "@x=60,y=1,height=3")).status, 0)
      << "a height is ground enough";
}

}  // namespace
}  // namespace rastrum::test::terrain_objects_test
