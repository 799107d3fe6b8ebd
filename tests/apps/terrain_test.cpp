// SPDX-License-Identifier: BSD-3-Clause
// `rastrum terrain`: with each option the picture equals the library's with the same choice; inputs
// that cannot be drawn.
#include <numbers>

#include <rastrum/io.hpp>
#include <rastrum/parallel/cuda/status.hpp>
#include <rastrum/terrain.hpp>
#include <rastrum/terrain/color_map.hpp>
#include <rastrum/terrain_light.hpp>

#include "hills.hpp"

#include "tests/io/dem_file.hpp"
#include "tests/support/painter.hpp"

namespace rastrum::test::terrain_test {
namespace {

using namespace terrain;

constexpr double kRadians = std::numbers::pi / 180;

class TerrainProgram : public ProgramOnHills {
 protected:
  void SetUp() override {
    ProgramOnHills::SetUp();
    camera_ = {kMap / 2.0, kMap * (800.0 / 1024), 40, 0, 20, 0};
  }

  [[nodiscard]] static Args base() {
    return "terrain --height h.png --color c.png -o p.png --size 96x64 --altitude 40 --horizon 20";
  }
  [[nodiscard]] Image<Rgba8> drawn(const HeightMap& map) const {
    Image<Rgba8> image(options_.width, options_.height);
    TerrainPainter(options_).render(Terrain(HeightMap{map.heights, map.colors}), camera_,
                                    {.color8 = image.view()});
    return image;
  }
  /// Compares the program's picture with `extra` options with the library's of `map`.
  void expect(const Args& extra, const HeightMap& map) const {
    must(base() + extra);
    EXPECT_TRUE(same_pixels(png("p.png"), drawn(map))) << extra;
  }
  void expect(const Args& extra) const { expect(extra, map_); }
  /// Usage errors (2) and errors of files (1) leave no file and say `part`.
  void refuse(int status, const std::string& part, const Args& args) const {
    const auto before = files();
    refused("terrain" + args, part, status);
    EXPECT_EQ(files(), before);
  }
};

TEST_F(TerrainProgram, Defaults) {
  expect({});
  const Image<Rgba8> plain = Program::drawn("terrain --height h.png --color c.png");
  EXPECT_EQ(plain.width(), 1280);
  EXPECT_EQ(plain.height(), 720);
}

TEST_F(TerrainProgram, Camera) {
  camera_.x = -7.5;
  camera_.y = 21;
  camera_.angle_rad = 33 * kRadians;
  camera_.roll_rad = -20 * kRadians;
  expect("--position -7.5,21 --angle 33 --roll -20");
  options_.ground_clearance = 100;
  expect("--position -7.5,21 --angle 33 --roll -20 --clearance 100");
}

TEST_F(TerrainProgram, Picture) {
  options_.distance = 250;
  options_.fov_rad = 60 * kRadians;
  options_.scale_px = 70;
  options_.step = 1;
  options_.dz = 0.01;
  options_.sky = {1, 2, 3, 255};
  options_.fog = {0.01, 20, Rgba8{255, 128, 0, 255}};
  const Args picture("--distance 250 --fov 60 --scale 70 --dz 0.01 --sky #010203");
  expect(picture + "--fog 0.01,20,#ff8000");
  expect("--distance 250 --fov 60 --scale 70 --dz 0.01 --sky 010203 --fog 0.01,20,ff8000");
  options_.fog = {0.01, 0, Rgba8{255, 255, 255, 255}};
  expect(picture + "--fog 0.01,white");
  options_.fog = {0.02, 0, {}};
  expect(picture + "--fog 0.02");
}

TEST_F(TerrainProgram, FiltersTilesProjectionMachine) {
  for (const auto& [option, filter] : {std::pair("--filter none", MapFilter::none),
                                       {"--filter bilinear", MapFilter::bilinear},
                                       {"--filter mip", MapFilter::mip}}) {
    options_.filter = filter;
    expect(option);
  }
  options_.filter = MapFilter::bilinear;
  for (const auto& [option, tiling] : {std::pair("--tile repeat", Tiling::repeat),
                                       {"--tile mirror", Tiling::mirror},
                                       {"--tile none", Tiling::none},
                                       {"--tile clamp", Tiling::clamp}}) {
    options_.tiling = tiling;
    expect(option);
  }
  options_.projection = Projection::cylindrical;
  expect("--tile clamp --projection cylindrical --device serial");
  expect("--tile clamp --projection cylindrical --isa scalar --threads 2 --method words");
}

// --step or --dz alone keeps the other at its default; filters that show cells step by a cell.
TEST_F(TerrainProgram, Steps) {
  options_.step = 0.25;
  expect("--step 0.25");
  options_.dz = 0.02;
  expect("--step 0.25 --dz 0.02");
  expect("--dz 0.02 --step 0.25");
  options_.step = 1;
  expect("--dz 0.02");
  options_.dz = 0.005;
  for (const auto& [option, filter] :
       {std::pair("--filter none", MapFilter::none), {"--filter mip", MapFilter::mip}}) {
    options_.filter = filter;
    expect(option);
  }
}

TEST_F(TerrainProgram, Classic) {
  options_.classic = true;
  options_.filter = MapFilter::none;
  expect("--classic");
  camera_.altitude = 78;
  camera_.horizon_px = 100;
  EXPECT_TRUE(same_pixels(
      Program::drawn("terrain --height h.png --color c.png --size 96x64 --classic"), drawn(map_)))
      << "78 up, horizon at 100";
}

TEST_F(TerrainProgram, LightAndShadows) {
  const Sun sun{250, 25};
  options_.sky = sky_in(kSky, sun);
  std::vector<Image<Rgba8>> pictures;
  for (const auto& [option, shadows] :
       {std::pair("--shadows accumulated", terrain::Shadows::accumulated),
        {"--shadows sharp", terrain::Shadows::sharp},
        {"--shadows soft", terrain::Shadows::soft}}) {
    const terrain::Light light{.sun = sun, .shadows = shadows, .sun_radius_deg = 4};
    expect(Args("--sun 250,25 --sun-radius 4") + option, {map_.heights, lit_colors(map_, light)});
    for (const Image<Rgba8>& other : pictures) EXPECT_FALSE(same_pixels(png("p.png"), other));
    pictures.push_back(png("p.png"));
  }
}

TEST_F(TerrainProgram, TheSkyDimsWithTheSunButNotTheOriginals) {
  options_.sky = {80, 160, 255, 255};
  expect("--sky #50a0ff --dim-sky --sun 315,30");
  options_.sky = {43, 85, 135, 255};  // half way to a sixteenth: 17/32
  expect("--sky #50a0ff --dim-sky --sun 315,12");
  expect("--dim-sky --sky #50a0ff --sun 315,12");
  options_.sky = {5, 10, 16, 255};
  expect("--sky #50a0ff --dim-sky --sun 315,-6");
  options_.sky = kSky;
  expect("--sun 315,30");
  options_.sky = sky_in(kSky, {315, 12});
  expect("--sun 315,12");
  options_.sky = kSky;
  options_.classic = true;
  options_.filter = MapFilter::none;
  expect("--classic --sun 315,-6");
}

TEST_F(TerrainProgram, ASkyOfOnesOwnStaysUnderALowSun) {
  options_.sky = {255, 176, 112, 255};
  for (const char* sun : {"270,6", "270,-6", "270,60"}) expect({"--sky", "#ffb070", "--sun", sun});
  EXPECT_EQ(png("p.png")(0, 0), options_.sky);
}

// Cells are twice as large as texels: without interpolated light, shadows would be blocks.
TEST_F(TerrainProgram, LightIsSmoothUnderFinerColours) {
  Image<Rgba8> fine(2 * kMap, 2 * kMap);
  for (Rgba8& c : fine.pixels()) c = {240, 240, 240, 255};
  io::write_png(path("c.png"), fine.view());
  map_.colors = std::move(fine);
  const terrain::Light light{
      .sun = {250, 25}, .shadows = terrain::Shadows::soft, .sun_radius_deg = 4};
  terrain::Light smooth = light;
  smooth.smooth = true;
  options_.sky = sky_in(kSky, light.sun);
  const Args args("--sun 250,25 --shadows soft --sun-radius 4");
  expect(args, {map_.heights, lit_colors(map_, smooth)});
  const Image<Rgba8> shown = png("p.png");
  options_.filter = MapFilter::none;
  expect(args + "--filter none", {map_.heights, lit_colors(map_, light)});
  EXPECT_FALSE(same_pixels(png("p.png"), shown));
}

TEST_F(TerrainProgram, WithoutColours) {
  options_.sky = sky_in(kSky, {10, 20});
  const HeightMap bare{map_.heights, {}};
  EXPECT_TRUE(same_pixels(
      Program::drawn("terrain --height h.png --size 96x64 --altitude 40 --horizon 20 --sun 10,20"),
      drawn({map_.heights, lit_colors(bare, {.sun = {10, 20}, .hill_shading = true})})));
}

TEST_F(TerrainProgram, Functions) {
  const auto picture = [&](const HeightFunction& f, double low, double high) {
    Image<Rgba8> image(kWidth, kHeight);
    TerrainPainter(options_).render(function_terrain(f, low, high, {.hill_shading = true}),
                                    {512, 800, 90, 0, 16, 0}, {.color8 = image.view()});
    return image;
  };
  for (const FunctionInfo& f : named_functions()) {
    EXPECT_TRUE(same_pixels(
        Program::drawn("terrain --size 96x64 --altitude 90 --function " + std::string(f.name)),
        picture(named_function(f.name), f.low, f.high)))
        << f.name;
  }
  const Outcome r = run("terrain --function 20*sin(x/30) -o p.png --size 96x64 --altitude 90");
  if (r.err.find("libmuparser-dev") != std::string::npos) return;
  ASSERT_EQ(r.status, 0) << r.err;
  const HeightFunction f = expression_function("20*sin(x/30)");
  const HeightRange range = sampled_range(f);
  EXPECT_TRUE(same_pixels(png("p.png"), picture(f, range.low, range.high)));
}

TEST_F(TerrainProgram, RawHeightsOfASizeAndScale) {
  std::string raw;
  for (int i = 0; i < kMap * kMap; ++i) {
    const auto v = static_cast<int>(map_.heights.pixels()[static_cast<std::size_t>(i)]) * 257;
    raw += static_cast<char>(v & 255);
    raw += static_cast<char>(v >> 8);
  }
  write("h.raw", raw);
  Args args = base();
  args[2] = "h.raw";
  const auto with = [&](const Args& more) { return must(args + more); };
  const Image<float> bytes = map_.heights;
  const auto expect_scale = [&](float scale, const char* what) {
    for (std::size_t i = 0; i < bytes.pixels().size(); ++i)
      map_.heights.pixels()[i] = bytes.pixels()[i] * 257 * scale;
    EXPECT_TRUE(same_pixels(png("p.png"), drawn(map_))) << what;
  };
  // 257 to 7710, on 60 cells: a twelfth of them is 5, and 5/7453 is 0.00067 to two digits.
  const std::string said = with({});
  expect_scale(0.00067F, "a relief of a twelfth");
  for (const char* part : {"note: h.raw: ", "257 to 7710", "--height-scale 0.00067"})
    EXPECT_TRUE(holds(said, part));
  EXPECT_EQ(with("--quiet"), "");
  expect_scale(0.00067F, "quietly");
  EXPECT_FALSE(holds(with("--height-scale 0.00067"), "note"));
  expect_scale(0.00067F, "what was said, given");
  with("--height-size 60x60 --height-scale 0.5");
  expect_scale(0.5F, "one's own");
  EXPECT_FALSE(holds(with("--classic"), "note"));
  options_.classic = true;
  options_.filter = MapFilter::none;
  map_.heights = bytes;
  EXPECT_TRUE(same_pixels(png("p.png"), drawn(map_))) << "--classic: 16 bits have the range of 8";
}

TEST_F(TerrainProgram, ScalesThatAFileKnowsAreItsOwn) {
  EXPECT_FALSE(holds(must(base()), "note")) << "8 bits: a unit a cell";
  // All heights are equal: there is nothing to choose.
  write("flat.raw", std::string(2 * 16 * 16, '\x10'));
  Args args = base();
  args[2] = "flat.raw";
  EXPECT_FALSE(holds(must(args), "note"));
}

TEST_F(TerrainProgram, DepthAndStats) {
  must(base() + "--depth d.npy --stats s.json --frames 3 --distance 90");
  options_.distance = 90;
  Image<float> depth(kWidth, kHeight);
  const TerrainStats stats = TerrainPainter(options_).render(
      Terrain(HeightMap{map_.heights, map_.colors}), camera_, {.depth = depth.view()});
  EXPECT_TRUE(npy("d.npy").holds(depth));
  const nlohmann::ordered_json json = this->json("s.json");
  EXPECT_EQ(json["size"], (nlohmann::ordered_json{96, 64}));
  EXPECT_EQ(json["map"], (nlohmann::ordered_json{kMap, kMap}));
  EXPECT_EQ(json["slices"], stats.slices);
  EXPECT_EQ(json["frame_ms"]["frames"], 3);
  EXPECT_EQ(json["camera"]["altitude"], 40);
}

TEST_F(TerrainProgram, AutoTakesADeviceAndSaysWhy) {
  const parallel::CudaStatus status = parallel::cuda_status();
  const auto drawn = [&](const Args& more) {
    must(base() + "--stats s.json" + more);
    return json("s.json");
  };
  const auto chosen = drawn("--device auto --shadows sharp");
  EXPECT_TRUE(status.usable || chosen["device"] == "threads");
  const std::string why = chosen["device_why"];
  EXPECT_TRUE(holds(why, status.usable ? status.name : status.why_not));
  EXPECT_EQ(chosen["device_bytes"] == 0, chosen["device"] != "cuda");
  const auto asked = drawn("--device serial");
  EXPECT_EQ(asked["device"], "serial");
  EXPECT_EQ(asked["device_why"], "");
  EXPECT_EQ(asked["threads"], 1);
}

TEST_F(TerrainProgram, AVideoHasThePicturesOfThePath) {
  // Two and a half seconds, 4 pictures in each.
  write("p.json",
        R"({"keys": [{"position": [30, 50]}, {"time": 2.5, "position": [20, 9], "angle": 70,
                               "altitude": 55, "roll": 20}]})");
  expect_film(
      "terrain --height h.png --color c.png --size 160x96 --altitude 40 --horizon 20 --path p.json "
      "--fps 4",
      11, "160,96", 24);
}

TEST_F(TerrainProgram, ADemEndsAtItsEdge) {
  std::vector<DemProfile> profiles(20);
  for (std::size_t i = 0; i < profiles.size(); ++i)
    profiles[i] = {30.0 * static_cast<double>(i), 0, 0, std::vector<int>(20, 900)};
  write("g.dem", dem(profiles));
  const auto picture = [&](const Args& extra) {
    return Program::drawn("terrain --height g.dem --size 40x40" + extra);
  };
  const Image<Rgba8> usual = picture({});
  EXPECT_TRUE(same_pixels(usual, picture("--tile none")));
  EXPECT_FALSE(same_pixels(usual, picture("--tile repeat")));
  refuse(1, "does not end (tiling none)", "--height g.dem -o p.png --classic --tile none");
  EXPECT_TRUE(same_pixels(picture("--classic"), picture("--classic --tile repeat")));
}

TEST_F(TerrainProgram, RefusesWhatItCannotDraw) {
  refuse(2, "-o:", "--height h.png");
  refuse(2, "--height:", "-o p.png");
  refuse(2, "--height:", "--height h.png --function expo -o p.png");
  refuse(2, "--color:", "--function expo --color c.png -o p.png");
  refuse(2, "--shadows: expected one of none, accumulated, sharp, soft",
         "--height h.png --shadows hard -o p.png");
  refuse(2, "--sun:", "--height h.png --sun 10 -o p.png");
  refuse(2, "--sun:", "--height h.png --sun 10,91 -o p.png");
  refuse(2, "--sun:", "--height h.png --sun 10,20,30 -o p.png");
  refuse(2, "--position:", "--height h.png --position 1, -o p.png");
  refuse(2, "--fog:", "--height h.png --fog 1,2,3 -o p.png");
  refuse(2, "--fog:", "--height h.png --fog 1,2,3,white -o p.png");
  refuse(2, "--fog:", "--height h.png --fog white -o p.png");
  refuse(2, "-o:", "--height h.png -o p.jpg");
  refuse(1, "gone.png", "--height gone.png -o p.png");
  refuse(1, "c.png: its pixel", "--height c.png -o p.png");
  refuse(1, "there are cosines", "--function hills -o p.png");
  if (!parallel::cuda_status().usable) refuse(1, "CUDA", "--height h.png --device cuda -o p.png");
  refuse(2, "--step: must be greater than 0", "--height h.png -o p.png --step 0");
  refuse(1, "leave them or the classic option out", "--height h.png -o p.png --classic --step 0.5");
  refuse(1, "leave them or the classic option out",
         "--height h.png -o p.png --filter bilinear --classic");
  refuse(2, "--dim-sky:", "--height h.png -o p.png --classic --dim-sky");
  write("bad.dem", "no dem");
  refuse(1, "bad.dem", "--height bad.dem -o p.png");
}

TEST_F(TerrainProgram, HelpNamesEveryFunctionAndAnExample) {
  const std::string help = run("terrain --help").out;
  for (const FunctionInfo& f : named_functions())
    EXPECT_TRUE(holds(help, std::string(f.description))) << f.name;
  EXPECT_TRUE(holds(help, "rastrum terrain --height D1.png"));
}

}  // namespace
}  // namespace rastrum::test::terrain_test
