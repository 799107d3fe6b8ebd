// All ways to a picture give the same bits: serial, threads, every instruction set; maps and
// functions, filters, tilings, projections, fog, with depth.
#include <cmath>
#include <limits>
#include <random>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/family.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/terrain.hpp>

#include "tests/support/painter.hpp"
#include "tests/support/stop_trigger.hpp"
#include "tests/terrain/maps.hpp"

namespace rastrum::terrain::methods_test {
namespace {

using test::TerrainLook;
using test::TerrainPainter;

struct Picture {
  Image<Rgba8> colors;
  Image<float> depth;
  std::uint64_t visible = 0;

  Picture(const Terrain& terrain, const TerrainCamera& camera, const TerrainLook& options)
      : colors(options.width, options.height), depth(options.width, options.height) {
    visible =
        TerrainPainter(options).render(terrain, camera, {colors.view(), depth.view()}).visible;
  }
  void expect_equal(const Picture& other, const std::string& what) const {
    std::size_t different = 0;
    for (std::size_t i = 0; i < colors.pixels().size(); ++i)
      different += !(colors.pixels()[i] == other.colors.pixels()[i]) ||
                   depth.pixels()[i] != other.depth.pixels()[i];
    EXPECT_EQ(different, 0U) << what;
    EXPECT_EQ(visible, other.visible) << what;
  }
};

/// The serial reference against everything else.
void expect_same_everywhere(const Terrain& terrain, const TerrainCamera& camera,
                            TerrainLook options, const std::string& what) {
  options.device = Device::serial;
  const Picture reference(terrain, camera, options);
  options.added = &family::terrain_words();
  reference.expect_equal({terrain, camera, options}, what + ", words, serial");
  options.device = Device::threads;
  options.threads = 3;
  reference.expect_equal({terrain, camera, options}, what + ", words, 3 threads");
  options.added = nullptr;
  for (const int threads : {1, 2, 8})
    for (const Isa isa : available_isas()) {
      options.threads = threads;
      options.isa = isa;
      reference.expect_equal(
          {terrain, camera, options},
          what + ", fast, " + std::string(name(isa)) + ", threads " + std::to_string(threads));
    }
}

TEST(Methods, GiveTheSamePicture) {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const int sizes[][2] = {{64, 64}, {100, 60}, {1, 1}, {1, 37}, {53, 1}, {129, 65}};
  for (int i = 0; i < 120; ++i) {
    const auto& size = sizes[random() % 6];
    HeightMap map = test::random_map(size[0], size[1], random, between(0, 0.5));
    if (i % 5 == 1) map.colors = test::random_map(37, 91, random).colors;
    if (i % 6 == 1)
      for (int k = 0; k < 20; ++k)
        map.heights.pixels()[random() % map.heights.pixels().size()] =
            std::numeric_limits<float>::quiet_NaN();
    TerrainLook options;
    options.width = 1 + static_cast<int>(random() % 150);
    options.height = 1 + static_cast<int>(random() % 90);
    options.distance = between(1, 400);
    options.filter = static_cast<MapFilter>(i % 3);
    options.tiling = static_cast<Tiling>(i / 3 % 4);
    options.projection = static_cast<Projection>(i / 9 % 2);
    options.fov_rad = between(0.3, options.projection == Projection::planar ? 2.5 : 6.28);
    options.dz = i % 4 == 0 ? 0.1 : 0.005;
    if (i % 2 == 1) options.step = 0;
    options.scale_px = i % 3 == 0 ? 240 : 0;
    if (i % 4 == 1) options.fog = {between(0, 0.02), between(0, 50), {}};
    TerrainCamera camera;
    const double far = i % 7 == 0 ? 1e9 : 500;
    camera.x = between(-far, far);
    camera.y = between(-far, far);
    camera.altitude = i % 11 == 0 ? between(-1e6, 1e6) : between(-50, 400);
    camera.angle_rad = between(-7, 7);
    camera.horizon_px = between(-50, 100);
    camera.roll_rad = i % 10 == 9 ? between(-7, 7) : 0;
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
  TerrainLook options;
  options.width = 133;
  options.height = 70;
  options.distance = 300;
  options.fog = {0.01, 20, Rgba8{200, 100, 0, 255}};
  expect_same_everywhere(waves, {.x = 5, .y = -8, .altitude = 40, .horizon_px = 20}, options,
                         "waves");
}

// A frame that is stopped ends after a bounded number of samples, and the next one is whole.
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
  TerrainLook options;
  options.width = 640;
  options.height = 120;
  options.distance = 4000;
  options.threads = 2;
  const TerrainCamera camera{.x = 5, .y = -8, .altitude = 400, .horizon_px = 100};
  struct Case {
    const AddedMethod* added;
    Device device;
    std::int64_t most;
    bool classic = false;
  };
  constexpr std::int64_t kColumns = 64, kSlices = 8;  // of a look at the token, see fast.cpp
  const std::int64_t slices = [&] {
    Image<Rgba8> colors(options.width, options.height);
    return static_cast<std::int64_t>(
        TerrainPainter(options).render(hills, camera, {.color8 = colors.view()}).slices);
  }();
  for (const Case& c : {Case{nullptr, Device::threads, 2 * kColumns * kSlices},
                        Case{&family::terrain_words(), Device::threads, 2 * 4096},
                        Case{nullptr, Device::serial, slices},
                        // Classic draws the terrain of a function slice by slice.
                        Case{nullptr, Device::serial, options.width, true}}) {
    SCOPED_TRACE(std::string(c.added == nullptr ? "fast" : "words") + ", device " +
                 std::to_string(static_cast<int>(c.device)) + (c.classic ? ", classic" : ""));
    options.classic = c.classic;
    options.added = c.added;
    options.device = c.device;
    const Picture expected(hills, camera, options);
    TerrainPainter renderer(options);
    Image<Rgba8> colors(options.width, options.height);
    Image<float> depth(options.width, options.height);
    test::StopTrigger at(10000);
    trigger = &at;
    {
      const std::stop_token token = at.token();
      const parallel::StopScope scope(token);
      EXPECT_THROW(renderer.render(hills, camera, {colors.view(), depth.view()}),
                   parallel::Stopped);
    }
    trigger = nullptr;
    EXPECT_LE(at.after(), c.most);
    renderer.render(hills, camera, {colors.view(), depth.view()});
    EXPECT_TRUE(std::equal(colors.pixels().begin(), colors.pixels().end(),
                           expected.colors.pixels().begin()));
    EXPECT_TRUE(
        std::equal(depth.pixels().begin(), depth.pixels().end(), expected.depth.pixels().begin()));
  }
}

}  // namespace
}  // namespace rastrum::terrain::methods_test
