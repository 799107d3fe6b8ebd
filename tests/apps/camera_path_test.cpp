// SPDX-License-Identifier: BSD-3-Clause
// Camera paths: interpolation against its definition, the file's errors, --path against single
// pictures, and videos.
#include "job/camera_path.hpp"

#include <sys/stat.h>

#include <cmath>
#include <limits>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "job/key_curve.hpp"
#include "parse/arguments.hpp"
#include "parse/output.hpp"
#include "program.hpp"

namespace rastrum::test::camera_path_test {
namespace {

using cli::Interpolation;
using cli::KeyCurve;
using cli::Tangent;

const std::vector<double> kTimes{0, 1, 3, 4.5};

TEST(KeyCurve, GoesThroughItsKeys) {
  const std::vector<double> values{0.1, -3, 1e6, 0.7};
  for (const Tangent tangent : {Tangent::curve, Tangent::monotone})
    for (const Interpolation how : {Interpolation::smooth, Interpolation::linear}) {
      const KeyCurve curve(kTimes, values, how, tangent);
      for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(curve.at(kTimes[i]), values[i]);
      EXPECT_EQ(curve.at(-1), values.front());
      EXPECT_EQ(curve.at(99), values.back());
    }
}

TEST(KeyCurve, AParabolaIsKeptBetweenInnerKeys) {
  std::vector<double> values;
  for (const double t : kTimes) values.push_back(t * t - 2 * t);
  const KeyCurve curve(kTimes, values, Interpolation::smooth, Tangent::curve);
  for (double t = 1; t <= 3; t += 0.125) EXPECT_NEAR(curve.at(t), t * t - 2 * t, 1e-12) << t;
}

TEST(KeyCurve, VelocityIsContinuous) {
  const KeyCurve curve(kTimes, {0, 4, -1, 2}, Interpolation::smooth, Tangent::curve);
  constexpr double kStep = 1e-6;
  for (const double t : {1.0, 3.0}) {
    const double before = (curve.at(t) - curve.at(t - kStep)) / kStep;
    const double after = (curve.at(t + kStep) - curve.at(t)) / kStep;
    EXPECT_NEAR(before, after, 1e-4) << t;
  }
}

TEST(KeyCurve, MonotoneStaysBetweenNeighbours) {
  const std::vector<double> values{1, 100, 101, 2};
  const KeyCurve curve(kTimes, values, Interpolation::smooth, Tangent::monotone);
  for (std::size_t i = 0; i + 1 < values.size(); ++i)
    for (int k = 0; k <= 64; ++k) {
      const double t = kTimes[i] + (kTimes[i + 1] - kTimes[i]) * k / 64;
      EXPECT_GE(curve.at(t), std::min(values[i], values[i + 1]) - 1e-12) << t;
      EXPECT_LE(curve.at(t), std::max(values[i], values[i + 1]) + 1e-12) << t;
    }
  // The other kind must overshoot here, or the test proves nothing.
  const KeyCurve free(kTimes, values, Interpolation::smooth, Tangent::curve);
  double most = 0;
  for (double t = 1; t <= 3; t += 0.01) most = std::max(most, free.at(t));
  EXPECT_GT(most, 102);
}

TEST(NumberedName, Numbers) {
  using cli::NumberedName;
  EXPECT_EQ(NumberedName("-o", "a_%04d.png").at(12), "a_0012.png");
  EXPECT_EQ(NumberedName("-o", "%d%%.png").at(123456), "123456%.png");
  EXPECT_EQ(NumberedName("-o", "%3d").at(7), "  7");
  EXPECT_EQ(NumberedName("-o", "plain.png").at(7), "plain.png");
  EXPECT_FALSE(NumberedName("-o", "100%%.png").has_number());
  for (const char* bad : {"%", "%s.png", "%04", "%d_%d", "%999999999999d", "%-4d", "%n"})
    EXPECT_THROW(static_cast<void>(NumberedName("-o", bad)), cli::UsageError) << bad;
}

TEST(FrameTimes, CountsBothEnds) {
  EXPECT_EQ(cli::frame_times(0, 1, 25).size(), 26U);
  EXPECT_EQ(cli::frame_times(0.1, 0.4, 10).size(), 4U);  // as floats, 3 / 10 < 0.4 - 0.1
  EXPECT_EQ(cli::frame_times(2, 2, 30), std::vector<double>{2});
  EXPECT_THROW(static_cast<void>(cli::frame_times(0, 1e9, 60)), Error);
}

class CameraPathFile : public Program {
 protected:
  [[nodiscard]] cli::CameraPath path_of(const std::string& text) const {
    write("path.json", text);
    return cli::read_path(path("path.json"), Camera{});
  }
};

TEST_F(CameraPathFile, WhatAKeyLeavesOutIsTheKeysBefore) {
  const auto p = path_of(R"({"keys": [{"eye": [1, 2, 3], "fov": 90},
                                      {"time": 2, "target": [0, 1, 0]},
                                      {"time": 4, "eye": [5, 2, 3], "fov": 45}]})");
  EXPECT_EQ(p.first_s(), 0);
  EXPECT_EQ(p.last_s(), 4);
  EXPECT_EQ(p.at(0).eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(p.at(0).target, Camera{}.target);
  EXPECT_EQ(p.at(2).eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(p.at(2).target, (Vec3{0, 1, 0}));
  EXPECT_NEAR(p.at(2).fov_rad, std::acos(-1.0) / 2, 1e-6);
  EXPECT_EQ(p.at(4).eye, (Vec3{5, 2, 3}));
  EXPECT_FALSE(p.first().has_planes);
}

TEST_F(CameraPathFile, WrittenAndReadHasTheSameBits) {
  cli::PathKey key{0.1, {}, true};
  key.camera.eye = {0.1F, -1e-30F, 3e20F};
  key.camera.target = {1 / 3.0F, 2, -7};
  key.camera.fov_rad = 0.7F;
  key.camera.near_plane = 0.3F;
  cli::PathKey other = key;
  other.time_s = 1 / 3.0;
  other.camera.fov_rad = std::nextafter(0.7F, 1.0F);
  const cli::PathKey keys[] = {key, other};
  cli::write_path(path("out.json"), keys);
  const auto p = cli::read_path(path("out.json"), Camera{});
  for (const cli::PathKey& k : keys) {
    const Camera c = p.at(k.time_s);
    EXPECT_EQ(c.eye, k.camera.eye);
    EXPECT_EQ(c.target, k.camera.target);
    EXPECT_EQ(c.fov_rad, k.camera.fov_rad);
    EXPECT_EQ(c.near_plane, k.camera.near_plane);
    EXPECT_EQ(c.far_plane, std::numeric_limits<float>::infinity());
  }
  EXPECT_TRUE(p.first().has_planes);
}

TEST_F(CameraPathFile, ErrorsNameThePlace) {
  const auto expect = [&](const std::string& text, const std::string& words) {
    SCOPED_TRACE(text);
    const std::string said = refusal_of([&] { (void)path_of(text); }, Errc::bad_format);
    EXPECT_TRUE(holds(said, "path.json"));
    EXPECT_TRUE(holds(said, words));
  };
  expect("", "is not JSON");
  expect("[1]", "expected an object");
  expect("{}", "keys: a path needs at least one key");
  expect(R"({"keys": {}})", "keys: expected an array");
  expect(R"({"keys": [{}], "speed": 2})", "unknown name 'speed'");
  expect(R"({"keys": [{"eye": [0, 0]}]})", "keys[0]: eye: expected an array of 3 numbers");
  expect(R"({"keys": [{"near": 1e99}]})", "keys[0]: near: the number is too large");
  expect(R"({"keys": [{"eye": [0, 0, 1e999]}]})", "path.json");
  expect(R"({"keys": [{}, {"eye": [0, 0, 5]}]})", "keys[1]: time: is needed");
  expect(R"({"keys": [{"time": 2}, {"time": 2}]})", "keys[1]: time: must be greater");
  expect(R"({"keys": [{"eye": [0, 0, 0]}]})", "eye and target must differ");
  expect(R"({"keys": [{"up": [0, 0, 1]}]})", "keys[0]: up");
  expect(R"({"keys": [{"fov": 180}]})", "keys[0]: fov");
  expect(R"({"keys": [{"fov": 60, "orthographic": 2}]})", "keys[0]: orthographic");
  expect(R"({"keys": [{"near": 0}]})", "keys[0]: near");
  expect(R"({"keys": [{"far": 10}]})", "keys[0]: far: needs near");
  expect(R"({"keys": [{"near": 2, "far": 1}]})", "keys[0]: far: must be greater than near");
  expect(R"({"keys": [{}, {"time": 1, "near": 1}]})", "keys[1]: near");
  expect(R"({"keys": [{"fov": 60}, {"time": 1, "orthographic": 3}]})", "keys[1]");
  expect(R"({"keys": [{}], "interpolation": "cubic"})", "interpolation");
}

constexpr const char* kPath =
    R"({"keys": [{"eye": [6, 4, 6], "target": [0, 1, 0]}, {"time": 1, "eye": [-6, 4, 6]}]})";

TEST_F(CameraPathFile, PicturesAreThoseOfTheirCameras) {
  write("p.json", kPath);
  must(
      "render --look plain builtin:torus_knot --size 80x60 --path p.json --fps 2 -o f_%02d.png "
      "--depth d%d.npy");
  for (int i = 0; const std::string eye : {"6,4,6", "0,4,6", "-6,4,6"}) {
    const std::string n = std::to_string(i++);
    must(
        "render --look plain builtin:torus_knot --size 80x60 --target 0,1,0 -o one.png --depth "
        "one.npy --eye " +
        eye);
    EXPECT_TRUE(same_pixels(png("one.png"), png("f_0" + n + ".png"))) << eye;
    EXPECT_TRUE(read("one.npy") == read("d" + n + ".npy")) << eye;
  }
  EXPECT_FALSE(std::filesystem::exists(path("f_03.png")));
}

TEST_F(CameraPathFile, RefusesWhatCannotBeMeant) {
  write("p.json", kPath);
  const auto refused = [&](Args more, const std::string& words) {
    const Outcome r = run("render --look plain builtin:sphere" + more);
    EXPECT_NE(r.status, 0) << words;
    EXPECT_TRUE(holds(r.err, words));
    EXPECT_EQ(files(), Args("p.json")) << words;
  };
  refused("--path p.json -o one.png", "number them, as in frame_%04d.png");
  refused("--path p.json -o %s.png", "%04d");
  refused("--path no.json -o %d.png", "no.json: cannot be read: No such file");
  refused("--path p.json --frames 3 -o %d.png", "--frames");
  refused("--fps 3 -o a.png", "--fps: needs --path");
  refused("--path p.json --fps 0 -o %d.png", "--fps");
  refused("-o a.mp4", "give --path");
  refused("--path p.json --size 31x20 -o a.mp4", "");
}

TEST_F(CameraPathFile, AVideoHasThePicturesOfThePath) {
  write("p.json", kPath);
  expect_film(
      "render --look plain builtin:torus_knot --size 160x120 --background #204060 --path p.json "
      "--fps 4",
      5, "160,120", 6);
}

/// A stand-in for ffmpeg in PATH.
class FakeFfmpeg : public CameraPathFile {
 protected:
  void make(const std::string& script) {
    std::filesystem::create_directory(path("bin"));
    write("bin/ffmpeg", "#!/bin/sh\n" + script);
    ::chmod(path("bin/ffmpeg").c_str(), 0755);
    write("p.json", kPath);
    before_ = std::getenv("PATH");
    ::setenv("PATH", path("bin").c_str(), 1);
  }
  void TearDown() override {
    ::setenv("PATH", before_.c_str(), 1);
    CameraPathFile::TearDown();
  }
  /// The film fails with this message. Existing files stay, and no other file appears.
  void expect_failure(const std::string& says, const Args& there) const {
    refused("render --look plain builtin:sphere --size 640x480 --path p.json -o v.mp4", says, 1);
    EXPECT_EQ(files(), there);
  }
  std::string before_;
};

TEST_F(FakeFfmpeg, ItsFailureIsOursInItsWords) {
  make("echo 'no codec today' >&2; exit 3\n");
  expect_failure("v.mp4: cannot be written: ffmpeg failed: no codec today", "bin p.json");
}

TEST_F(FakeFfmpeg, AFailureAfterAllPicturesCountsToo) {
  make("/bin/cat >/dev/null; exit 1\n");
  expect_failure("ffmpeg failed", "bin p.json");
}

TEST_F(FakeFfmpeg, MissingIsSaidBeforeAnythingIsDrawn) {
  make("");
  std::filesystem::remove(path("bin/ffmpeg"));
  expect_failure("install it (Debian: ffmpeg)", "bin p.json");
}

}  // namespace
}  // namespace rastrum::test::camera_path_test
