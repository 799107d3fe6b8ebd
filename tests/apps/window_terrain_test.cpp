// SPDX-License-Identifier: BSD-3-Clause
// Terrains in the window's code without a window: keys and time move the camera, path files, and
// pictures that equal those of `rastrum terrain` bit for bit.
#include <cmath>
#include <cstdio>

#include <filesystem>
#include <numbers>
#include <random>

#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/io.hpp>

#include "job/terrain_path.hpp"
#include "program.hpp"
#include "window/same_terrain.hpp"
#include "window/terrain_control.hpp"
#include "window/terrain_subject.hpp"

namespace rastrum::test::window_terrain_test {
namespace {

using namespace cli::window;
using cli::TerrainInput;
using cli::TerrainPath;
using cli::TerrainPathKey;
using terrain::TerrainCamera;

constexpr double kPi = std::numbers::pi;

Event key(const char* name, Event::Kind kind = Event::Kind::key_down) {
  return {.kind = kind, .key = name};
}
Event mouse(Event::Kind kind, double x, double y) {
  return {.kind = kind, .x = x, .y = y};
}
TerrainPose pose_at(const TerrainCamera& camera) {
  TerrainPose pose;
  pose.camera = camera;
  return pose;
}

class TerrainKeys : public testing::Test {
 protected:
  TerrainKeys() : control(pose_at({100, 200, 50, 0, 80, 0})) { control.resize(640, 400); }
  /// The pose after `name` was held for a second, starting at home.
  const TerrainPose& after(const char* name, int steps = 10) {
    control.handle(key("home"));
    control.handle(key(name));
    for (int i = 0; i < steps; ++i) control.advance(1.0 / steps);
    control.handle(key(name, Event::Kind::key_up));
    return control.pose();
  }
  TerrainControl control;
};

TEST_F(TerrainKeys, EachMovesItsWay) {
  EXPECT_NEAR(after("w").camera.y, 110, 1e-9);  // 90 cells towards the north
  EXPECT_NEAR(after("s").camera.y, 290, 1e-9);
  EXPECT_EQ(after("s").camera.x, 100);
  EXPECT_NEAR(after("a").camera.angle_rad, 1, 1e-9);
  EXPECT_NEAR(after("d").camera.angle_rad, -1, 1e-9);
  EXPECT_NEAR(after("q").camera.horizon_px, 280, 1e-9);  // half the height more
  EXPECT_NEAR(after("e").camera.horizon_px, -120, 1e-9);
  EXPECT_NEAR(after("r").camera.altitude, 140, 1e-9);
  EXPECT_NEAR(after("f").camera.altitude, -40, 1e-9);
  EXPECT_NEAR(after("left").camera.roll_rad, 0.5, 1e-9);
  EXPECT_NEAR(after("right").camera.roll_rad, -0.5, 1e-9);
  EXPECT_NEAR(after("up").distance, 1600, 1e-6);
  EXPECT_NEAR(after("down").distance, 400, 1e-6);
  EXPECT_NEAR(after("o").fov_rad, kPi / 2 + kPi / 6, 1e-9);
  EXPECT_NEAR(after("l").fov_rad, kPi / 2 - kPi / 6, 1e-9);
  const terrain::Sun home;
  EXPECT_NEAR(after("u").sun.elevation_deg, home.elevation_deg + 15, 1e-9);
  EXPECT_NEAR(after("j").sun.elevation_deg, home.elevation_deg - 15, 1e-9);
  EXPECT_NEAR(std::remainder(after("m").sun.azimuth_deg - home.azimuth_deg, 360), 45, 1e-9);
  EXPECT_NEAR(std::remainder(after("n").sun.azimuth_deg - home.azimuth_deg, 360), -45, 1e-9);
}

TEST_F(TerrainKeys, ForwardIsWhereItLooks) {
  control.place(pose_at({0, 0, 50, kPi / 2, 80, 0}));
  control.handle(key("w"));
  control.advance(1);
  EXPECT_NEAR(control.pose().camera.x, -90, 1e-9);  // a quarter turn to the left: west
  EXPECT_NEAR(control.pose().camera.y, 0, 1e-9);
}

TEST_F(TerrainKeys, TimeCountsNotFramesAndShiftIsFaster) {
  const double few = after("w", 2).camera.y;
  EXPECT_NEAR(after("w", 1000).camera.y, few, 1e-6);
  control.handle(key("left shift"));
  EXPECT_NEAR(after("w").camera.y, 200 - 4 * 90, 1e-9);
}

TEST_F(TerrainKeys, BoundsHoldWhatKeysReach) {
  control.handle(key("l"));
  control.handle(key("down"));
  control.handle(key("u"));
  control.advance(100);
  EXPECT_EQ(control.pose().fov_rad, 0.1);
  EXPECT_EQ(control.pose().distance, 10);
  EXPECT_EQ(control.pose().sun.elevation_deg, 90);
  control.handle(Event{});  // the window lost the keyboard
  control.handle(key("o"));
  control.handle(key("up"));
  control.advance(100);
  EXPECT_EQ(control.pose().fov_rad, 3);
  EXPECT_EQ(control.pose().distance, 1e6);
}

TEST_F(TerrainKeys, TheHorizonKeepsItsPartOfTheWindow) {
  control.resize(640, 800);
  EXPECT_EQ(control.pose().camera.horizon_px, 160);
  control.handle(key("home"));
  EXPECT_EQ(control.pose().camera.horizon_px, 160);
}

TEST_F(TerrainKeys, ADragTurnsAndTheWheelClimbs) {
  control.handle(mouse(Event::Kind::move, 5, 5));
  EXPECT_EQ(control.pose().camera, (TerrainCamera{100, 200, 50, 0, 80, 0})) << "nothing is held";
  control.handle(mouse(Event::Kind::button_down, 10, 10));
  control.handle(mouse(Event::Kind::move, 40, 30));
  control.handle(mouse(Event::Kind::button_up, 40, 30));
  EXPECT_GT(control.pose().camera.angle_rad, 0);
  EXPECT_EQ(control.pose().camera.horizon_px, 100);
  control.handle(mouse(Event::Kind::wheel, 0, 2));
  EXPECT_EQ(control.pose().camera.altitude, 68);
}

TEST_F(TerrainKeys, MovingAndVersionTellWhatHappens) {
  const unsigned long at_rest = control.version();
  control.advance(1);
  EXPECT_EQ(control.version(), at_rest);
  control.handle(key("x"));
  control.handle(key("left shift"));
  EXPECT_FALSE(control.moving());
  for (const char* name : {"w", "u", "left"}) {
    const unsigned long before = control.version();
    control.handle(key(name));
    EXPECT_TRUE(control.moving()) << name;
    control.advance(0.1);
    EXPECT_NE(control.version(), before) << name;
    control.handle(key(name, Event::Kind::key_up));
    EXPECT_FALSE(control.moving()) << name;
  }
}

class TerrainPathFile : public Program {
 protected:
  [[nodiscard]] TerrainPath path_of(const std::string& text) const {
    write("p.json", text);
    return cli::read_path(path("p.json"), {1, 2, 3, 0.5, 4, 0.25});
  }
};

TEST_F(TerrainPathFile, WhatAKeyLeavesOutIsTheKeysBefore) {
  const TerrainPath p = path_of(R"({"interpolation": "linear", "keys": [{"altitude": 9},
      {"time": 2, "position": [5, 6], "angle": 90}, {"time": 3, "roll": -180, "horizon": 7}]})");
  EXPECT_EQ(p.first_s(), 0);
  EXPECT_EQ(p.last_s(), 3);
  EXPECT_EQ(p.at(0), (TerrainCamera{1, 2, 9, 0.5, 4, 0.25}));
  EXPECT_EQ(p.at(2), (TerrainCamera{5, 6, 9, kPi / 2, 4, 0.25}));
  EXPECT_EQ(p.at(3), (TerrainCamera{5, 6, 9, kPi / 2, 7, -kPi}));
  EXPECT_EQ(p.at(1).x, 3);  // half way
  EXPECT_EQ(p.at(1).y, 4);
  EXPECT_EQ(p.at(99), p.at(3));
}

TEST_F(TerrainPathFile, WrittenAndReadHasTheSameBits) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> angle(-4, 4);
  std::vector<TerrainPathKey> keys;
  for (int i = 0; i < 200; ++i)
    keys.push_back({0.25 * i, {1.0 / 3, 2, 3, angle(random), 4, angle(random)}});
  keys.push_back({50.1, {1 / 3.0, -1e-30, 3e20, 0.7, 12.25, -2}});
  keys.push_back({50 + 1 / 3.0, {0, 0, 0, -9, 1e-3, 1e-9}});
  cli::write_path(path("out.json"), keys);
  const TerrainPath p = cli::read_path(path("out.json"), TerrainCamera{});
  for (const TerrainPathKey& k : keys) EXPECT_EQ(p.at(k.time_s), k.camera) << k.time_s;
}

TEST_F(TerrainPathFile, ErrorsNameThePlace) {
  const auto expect = [&](const std::string& text, const std::string& words) {
    SCOPED_TRACE(text);
    const std::string said = refusal_of([&] { (void)path_of(text); }, Errc::bad_format);
    EXPECT_TRUE(holds(said, "p.json"));
    EXPECT_TRUE(holds(said, words));
  };
  expect("{", "is not JSON");
  expect("{}", "keys: a path needs at least one key");
  expect(R"({"keys": [{"angle": 1, "angle_rad": 1}]})", "angle_rad");
  expect(R"({"keys": [{"position": [1]}]})", "keys[0]: position: expected an array of 2 numbers");
  expect(R"({"keys": [{"eye": [1, 2, 3]}]})", "unknown name 'eye'");
  expect(R"({"keys": [{}, {"roll": 1}]})", "keys[1]: time: is needed");
  expect(R"({"keys": [{"time": 2}, {"time": 2}]})", "keys[1]: time: must be greater");
}

class TerrainInWindow : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    Image<Rgba8> grey(64, 64);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const auto h = static_cast<std::uint8_t>(30 + 20 * std::sin(x * 0.2) * std::cos(y * 0.3));
        grey(x, y) = {h, h, h, 255};
      }
    io::write_png(path("h.png"), grey.view());
    arguments.options.width = 96;
    arguments.options.height = 64;
    TerrainInput map, function;
    map.height = path("h.png");
    function.function = "noise";
    subject =
        std::make_unique<TerrainSubject>(arguments, cli::GroundShown{}, std::vector{map, function});
  }
  /// The window's picture now.
  [[nodiscard]] Image<Rgba8> shown() const { return subject->draw(96, 64, false)().image; }
  /// The picture that `rastrum terrain` draws with the camera of the window.
  [[nodiscard]] Image<Rgba8> rendered(const Args& options) const {
    subject->write_camera(path("camera.json"));
    must("terrain --size 96x64 --path camera.json -o r.png" + options);
    return png("r.png");
  }
  /// Expects that the command line has these words and draws what the window shows.
  void expect_said(const std::string& words) const {
    const auto texts = subject->same_picture(96, 64, "said.png");
    const std::string& line = texts.front().second;
    ASSERT_TRUE(line.starts_with("rastrum terrain --")) << line;
    EXPECT_TRUE(holds(line, words));
    run_line(line);
    EXPECT_TRUE(same_pixels(shown(), png("said.png"))) << line;
    std::filesystem::remove(path("said.png"));
  }
  cli::TerrainSceneArguments arguments;
  std::unique_ptr<TerrainSubject> subject;
};

TEST_F(TerrainInWindow, PicturesAreTheCommands) {
  const Image<Rgba8> home = shown();
  EXPECT_TRUE(same_pixels(home, rendered("--height h.png")));
  subject->handle(key("a"));
  subject->handle(key("w"));
  subject->advance(0.1);
  EXPECT_FALSE(same_pixels(shown(), home));
  EXPECT_TRUE(same_pixels(shown(), rendered("--height h.png")));
  subject->handle(Event{});
  subject->set_options("--shadows sharp --sun 200,20 --distance 300");
  EXPECT_TRUE(
      same_pixels(shown(), rendered("--height h.png --shadows sharp --sun 200,20 --distance 300")));
}

// The command line covers all that the window shows, also angles from keys and drags.
TEST_F(TerrainInWindow, ACommandLineDrawsTheSamePicture) {
  expect_said("--height ");
  for (const char* name : {"a", "w", "left", "o", "m", "j", "down", "q"}) {
    subject->handle(key(name));
    subject->advance(0.173);
    subject->handle(key(name, Event::Kind::key_up));
    expect_said("--angle ");
  }
  subject->handle(mouse(Event::Kind::button_down, 40, 30));
  for (int i = 1; i < 12; ++i) subject->handle(mouse(Event::Kind::move, 40 + 1.37 * i, 30 - i));
  subject->handle(mouse(Event::Kind::button_up, 55, 19));
  expect_said("--horizon ");
  subject->set_options("--shadows soft --sun-radius 3 --sky #ffb070 --fog 0.003,20,#405060");
  expect_said("--fog '0.003,20,#405060'");
  subject->set_options("--sun 270,6 --dim-sky --projection cylindrical --filter mip");
  expect_said("--dim-sky");
  subject->set_options("--step 0.75 --dz 0.01 --scale 90 --filter bilinear --projection planar");
  subject->handle(key("t"));
  expect_said("--tile mirror");
  EXPECT_TRUE(
      holds(subject->same_picture(9, 9, "a.png").back().second, "does not have it: --step, --dz"));
}

TEST_F(TerrainInWindow, LightsAndWhatIsOverTheGroundAreTheCommands) {
  const std::string sky =
      "--light environment:sky --light directional:1,-1,0.3:intensity=2 --shadows sharp --tone "
      "aces "
      "--exposure -0.5 --environment-behind --axes --bounds";
  const Image<Rgba8> by_sun = shown();
  subject->set_options(sky);
  const Image<Rgba8> lit = shown();
  EXPECT_FALSE(same_pixels(lit, by_sun));
  EXPECT_TRUE(same_pixels(lit, rendered("--height h.png " + sky)));
  expect_said("--environment-behind");
  const std::string python = subject->same_picture(96, 64, "said.png").back().second;
  for (const char* const part :
       {"lights=[rr.Light.environment(\"sky\"", "rr.Light.directional((1, -1, 0.3", "tone=\"aces\"",
        "exposure=-0.5", "environment_behind=True", "\"axes\"", "\"bounds\""})
    EXPECT_TRUE(holds(python, part)) << part << '\n' << python;

  // In the command line the panel's lights replace the given ones. A headlight moves with the
  // camera.
  for (const char* const name : {"studio", "headlight", "sun"}) {
    TerrainSubject::Settings s = subject->settings();
    s.lights = name;
    s.shown.ground.bounds = false;
    subject->set(s);
    expect_said(std::string(name) == "sun" ? "--shadows sharp" : name);
    subject->handle(key("w"));
    subject->advance(0.1);
    subject->handle(key("w", Event::Kind::key_up));
    expect_said("--axes");
  }
  EXPECT_FALSE(holds(subject->same_picture(9, 9, "a.png").front().second, "--light"));
  TerrainSubject::Settings s = subject->settings();
  s.lights.clear();
  subject->set(s);
  expect_said("environment:sky");

  subject->set_options("--cmap plasma --steps 6 --bar Height --bar-unit m");
  expect_said("--cmap plasma");
  const std::string numbers = subject->same_picture(9, 9, "a.png").back().second;
  EXPECT_TRUE(holds(numbers, "cmap=rr.ColorMapping(\"plasma\", steps=6)"));
  EXPECT_TRUE(holds(numbers, "\"unit\": \"m\""));
  EXPECT_THROW(subject->set_options("--sun 10,10"), Error) << "lights are in its place";
  EXPECT_THROW(subject->set_options("--light point:0,0,0:intensity=-1"), Error);
  expect_said("--cmap plasma");
}

TEST_F(TerrainInWindow, OtherInputsAreSaidToo) {
  for (const char* function : {"noise", "20*sin(x/9)"}) {
    TerrainInput input;
    input.function = function;
    subject = std::make_unique<TerrainSubject>(arguments, cli::GroundShown{}, std::vector{input});
    expect_said("--function ");
  }
}

// Every angle that a hand can leave is a number of degrees.
TEST(TerrainAngles, AreThoseThatDegreesLeadTo) {
  double rad = -7;
  int others = 0;
  for (int i = 0; i < 2000; ++i, rad += 0.00717) {
    const double angle = angle_in_degrees(rad);
    EXPECT_NEAR(angle, rad, 2e-15);
    EXPECT_EQ(angle_in_degrees(angle), angle);
    others += angle != rad;
  }
  EXPECT_GT(others, 0) << "some have no degrees, else none of this is needed";
}

// The keys own sun, distance and field of view; the options only give their start.
TEST_F(TerrainInWindow, HeldKeysChangeThePicture) {
  Image<Rgba8> before = shown();
  const auto hold = [&](const char* name) {
    subject->handle(key(name));
    subject->advance(0.5);
    subject->handle(key(name, Event::Kind::key_up));
    EXPECT_FALSE(same_pixels(shown(), before)) << name;
    before = shown();
  };
  const auto exact = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return std::string(text);
  };
  for (const char* name : {"j", "m", "down"}) hold(name);
  const TerrainPose& pose = subject->control().pose();
  EXPECT_TRUE(same_pixels(
      shown(), rendered("--height h.png --sun " + exact(pose.sun.azimuth_deg) + "," +
                        exact(pose.sun.elevation_deg) + " --distance " + exact(pose.distance))));
  hold("o");
}

TEST_F(TerrainInWindow, KeysChangeOptionsBothWays) {
  const auto shows = [&](const char* name, const Args& options) {
    const std::uint64_t before = subject->version();
    subject->handle(key(name));
    EXPECT_NE(subject->version(), before) << name;
    EXPECT_TRUE(same_pixels(shown(), rendered("--height h.png" + options))) << name;
    Event back = key(name);
    back.shift = true;
    subject->handle(back);
  };
  const Image<Rgba8> home = shown();
  shows("b", "--filter mip");
  shows("c", "--shadows accumulated");
  shows("g", "--fog 0.002");
  shows("t", "--tile mirror");
  EXPECT_TRUE(same_pixels(shown(), home));
  subject->set_options("--sky #ffb070 --sun 270,6");
  EXPECT_TRUE(same_pixels(shown(), rendered("--height h.png --sky #ffb070 --sun 270,6")));
  subject->set_options("--dim-sky --step 0.5");
  EXPECT_TRUE(same_pixels(
      shown(), rendered("--height h.png --sky #ffb070 --sun 270,6 --dim-sky --step 0.5")));
}

TEST_F(TerrainInWindow, TheOriginalHasNoFilter) {
  subject->set_options("--classic");
  EXPECT_TRUE(same_pixels(shown(), rendered("--height h.png --classic")));
}

TEST_F(TerrainInWindow, PaperThreesScansShowTheSame) {
  const Image<Rgba8> home = shown();
  subject->handle(key("v"));
  EXPECT_EQ(subject->settings().options.added, &family::terrain_words());
  EXPECT_TRUE(same_pixels(shown(), home)) << "the same picture by paper 3's scans";
}

TEST_F(TerrainInWindow, OtherMapsAndFiles) {
  subject->handle(key("f1"));
  EXPECT_EQ(subject->title(), "noise");
  EXPECT_TRUE(same_pixels(shown(), rendered("--function noise")));
  subject->handle(key("1"));
  EXPECT_EQ(subject->title(), path("h.png").string());
  write("bad.png", "nonsense");
  EXPECT_THROW(static_cast<void>(subject->open(path("bad.png"))()), Error);
  EXPECT_TRUE(same_pixels(shown(), rendered("--height h.png"))) << "the map stays";
  EXPECT_THROW(subject->set_options("--filter nonsense"), std::exception);
}

TEST_F(TerrainInWindow, RecordedKeysAreFollowed) {
  subject->record(path("p.json"));
  const TerrainCamera home = subject->control().pose().camera;
  subject->handle(key("w"));
  subject->advance(1);
  subject->handle(Event{});
  subject->record(path("p.json"));
  const TerrainCamera away = subject->control().pose().camera;
  EXPECT_NE(home.y, away.y);
  EXPECT_EQ(subject->follow(path("p.json")), std::make_pair(0.0, kRecordStep_s));
  subject->go_to(0);
  EXPECT_EQ(subject->control().pose().camera.y, home.y);
  subject->go_to(kRecordStep_s);
  EXPECT_EQ(subject->control().pose().camera.y, away.y);
}

using TerrainAlongAPath = Program;

TEST_F(TerrainAlongAPath, PicturesAreThoseOfTheirCameras) {
  write("p.json", R"({"keys": [{"position": [10, 20], "altitude": 90, "horizon": 15},
                               {"time": 1, "position": [30, -40], "angle": 50, "roll": 20}],
                      "interpolation": "linear"})");
  must(
      "terrain --function noise --size 80x60 --path p.json --fps 2 -o f_%02d.png --depth d%d.npy "
      "--stats s.json");
  const struct {
    const char *position, *angle, *roll;
  } moments[] = {{"10,20", "0", "0"}, {"20,-10", "25", "10"}, {"30,-40", "50", "20"}};
  for (int i = 0; const auto& m : moments) {
    must("terrain --function noise --size 80x60 --altitude 90 --horizon 15 -o o.png --depth o.npy" +
         Args{"--position", m.position, "--angle", m.angle, "--roll", m.roll});
    const std::string n = std::to_string(i++);
    EXPECT_TRUE(same_pixels(png("o.png"), png("f_0" + n + ".png"))) << n;
    EXPECT_TRUE(read("o.npy") == read("d" + n + ".npy")) << n;
  }
  EXPECT_FALSE(std::filesystem::exists(path("f_03.png")));
  EXPECT_FALSE(same_pixels(png("f_00.png"), png("f_02.png")));
  EXPECT_EQ(json("s.json")["frame_ms"]["frames"], 3);
}

TEST_F(TerrainAlongAPath, RefusesWhatCannotBeMeant) {
  write("p.json", R"({"keys": [{}, {"time": 1, "altitude": 99}]})");
  write("q.json", R"({"keys": [{"eye": [1, 2, 3]}]})");
  const Args there = files();
  const auto refused = [&](const Args& more, const std::string& words) {
    const Outcome r = run("terrain --function noise --size 32x32" + more);
    EXPECT_NE(r.status, 0) << words;
    EXPECT_TRUE(holds(r.err, words));
    EXPECT_EQ(files(), there) << words;
  };
  refused("--path p.json -o one.png", "number them, as in frame_%04d.png");
  refused("--path p.json -o a%d.png --depth d.npy", "frame_%04d.npy");
  refused("--path p.json -o a%s.png", "expected a name with one %d");
  refused("--path p.json -o a%d.png --frames 3", "cannot go with --path");
  refused("--fps 3 -o a.png", "needs --path");
  refused("-o a.mp4", "give --path");
  refused("--path q.json -o a.png", "unknown name 'eye'");
  refused("--path none.json -o a.png", "none.json");
}

}  // namespace
}  // namespace rastrum::test::window_terrain_test
