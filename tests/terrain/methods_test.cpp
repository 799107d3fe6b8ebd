// SPDX-License-Identifier: BSD-3-Clause
// All ways to draw a picture give the same bits: serial, threads, every instruction set; for maps
// and functions, filters, tilings, projections and fog, with depth.
#include <cmath>
#include <random>
#include <stop_token>
#include <string>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/terrain.hpp>

#include "tests/support/stop_trigger.hpp"
#include "tests/terrain/picture.hpp"

namespace rastrum::terrain::methods_test {
namespace {

using test::TerrainLook;
using test::TerrainPainter;
using Picture = test::TerrainPicture;

/// Compares the serial reference with everything else.
void expect_same_everywhere(const Terrain& terrain, const TerrainCamera& camera,
                            TerrainLook options, const std::string& what) {
  options.device = Device::serial;
  const Picture reference(terrain, camera, options);
  const auto expect_equal = [&](const std::string& way) {
    EXPECT_TRUE(same_picture(reference, {terrain, camera, options})) << what << ", " << way;
  };
  options.added = &family::terrain_words();
  expect_equal("words, serial");
  options.device = Device::threads;
  options.threads = 3;
  expect_equal("words, 3 threads");
  options.added = nullptr;
  for (const int threads : {1, 2, 8})
    for (const Isa isa : available_isas()) {
      options.threads = threads;
      options.isa = isa;
      expect_equal("fast, " + std::string(name(isa)) + ", threads " + std::to_string(threads));
    }
}

TEST(Methods, GiveTheSamePicture) {
  std::mt19937 random(5);
  const int sizes[][2] = {{64, 64}, {100, 60}, {1, 1}, {1, 37}, {53, 1}, {129, 65}};
  for (int i = 0; i < 120; ++i) {
    auto [map, options, camera] = test::random_case(random, i, sizes, 400);
    expect_same_everywhere(Terrain(std::move(map)), camera, options, "case " + std::to_string(i));
    if (HasFailure()) return;
  }
}

TEST(Methods, GiveTheSamePictureOfFunctions) {
  const Terrain waves = Terrain::of(
      [](double x, double y) { return static_cast<float>(20 * std::cos(x / 9) * std::sin(y / 7)); },
      [](double x, double y) {
        return Rgba8{static_cast<std::uint8_t>(std::fmod(std::abs(x), 255)),
                     static_cast<std::uint8_t>(std::fmod(std::abs(y), 255)), 99, 255};
      });
  TerrainLook options(
      {.width = 133, .height = 70, .distance = 300, .fog = {0.01, 20, Rgba8{200, 100, 0, 255}}});
  expect_same_everywhere(waves, {.x = 5, .y = -8, .altitude = 40, .horizon_px = 20}, options,
                         "waves");
}

// A stopped frame ends after a bounded number of samples, and the next one is complete.
TEST(Methods, EndSoonWhenStopped) {
  test::StopTrigger* trigger = nullptr;
  const Terrain hills = Terrain::of(
      [&](double x, double y) {
        if (trigger != nullptr) trigger->call();
        return static_cast<float>(20 * std::cos(x / 9) * std::sin(y / 7));
      },
      [](double x, double) {
        return Rgba8{static_cast<std::uint8_t>(std::abs(x)), 7, 99, 255};
      });
  TerrainLook options({.width = 640, .height = 120, .distance = 4000}, {.threads = 2});
  const TerrainCamera camera{.x = 5, .y = -8, .altitude = 400, .horizon_px = 100};
  struct Case {
    const AddedMethod* added;
    Device device;
    std::int64_t most;
    bool classic = false;
  };
  constexpr std::int64_t kColumns = 64, kSlices = 8;  // between queries of the token (fast.cpp)
  const auto slices = static_cast<std::int64_t>(Picture(hills, camera, options).stats.slices);
  for (const Case& c : {Case{nullptr, Device::threads, 2 * kColumns * kSlices},
                        Case{&family::terrain_words(), Device::threads, 2 * 4096},
                        Case{nullptr, Device::serial, slices},
                        // Classic draws a function's terrain slice by slice.
                        Case{nullptr, Device::serial, options.width, true}}) {
    SCOPED_TRACE(std::string(c.added == nullptr ? "fast" : "words") + ", device " +
                 std::to_string(static_cast<int>(c.device)) + (c.classic ? ", classic" : ""));
    options.classic = c.classic;
    options.added = c.added;
    options.device = c.device;
    const Picture expected(hills, camera, options);
    TerrainPainter renderer(options);
    test::StopTrigger at(10000);
    trigger = &at;
    {
      const std::stop_token token = at.token();
      const StopScope scope(token);
      EXPECT_THROW(Picture(renderer, hills, camera), Stopped);
    }
    trigger = nullptr;
    EXPECT_LE(at.after(), c.most);
    EXPECT_TRUE(same_picture({renderer, hills, camera}, expected));
  }
}

}  // namespace
}  // namespace rastrum::terrain::methods_test
