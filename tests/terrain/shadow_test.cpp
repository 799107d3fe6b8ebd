// SPDX-License-Identifier: BSD-3-Clause
// Shadows against oracles that share only the definition in shadows.hpp with the library.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/terrain_light.hpp>

#include "tests/support/isa.hpp"
#include "tests/support/random.hpp"
#include "tests/support/test_share.hpp"
#include "tests/terrain/maps.hpp"

namespace rastrum::terrain::shadow_test {
namespace {

using test::Random;

constexpr Tiling kTilings[] = {Tiling::repeat, Tiling::mirror, Tiling::clamp, Tiling::none};

Image<float> noise(int width, int height, float relief, std::uint64_t seed) {
  Random random(seed);
  Image<float> map(width, height);
  for (float& h : map.pixels()) h = static_cast<float>(random.real(0, relief));
  return map;
}

/// Sums of waves: slopes with long shadows and smooth edges.
Image<float> hills(int width, int height, float relief, std::uint64_t seed) {
  Random random(seed);
  Image<float> map(width, height);
  for (int wave = 0; wave < 6; ++wave) {
    const double u = random.real(-0.4, 0.4), v = random.real(-0.4, 0.4), phase = random.real(0, 7);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        map(x, y) += static_cast<float>(relief / 6 * (1 + std::sin(u * x + v * y + phase)) / 2);
  }
  return map;
}

std::int64_t oracle_tile(std::int64_t i, std::int64_t n, Tiling tiling) {
  if (tiling == Tiling::clamp) return std::min(std::max(i, std::int64_t{0}), n - 1);
  if (tiling == Tiling::repeat) {
    while (i < 0) i += n;
    while (i >= n) i -= n;
    return i;
  }
  while (i < 0 || i >= n) i = i < 0 ? -1 - i : 2 * n - 1 - i;
  return i;
}

/// −∞ outside.
float oracle_height(const Image<float>& map, std::int64_t x, std::int64_t y, Tiling tiling) {
  const bool inside = x >= 0 && y >= 0 && x < map.width() && y < map.height();
  if (tiling == Tiling::none && !inside) return -INFINITY;
  return map(static_cast<int>(oracle_tile(x, map.width(), tiling)),
             static_cast<int>(oracle_tile(y, map.height(), tiling)));
}

/// The definition by brute force: every cell of a surrounding square, cut by the ray's three slabs.
Image<std::uint8_t> oracle(const Image<float>& map, double azimuth, double elevation,
                           Tiling tiling) {
  const double radians = std::numbers::pi / 180;
  double dx = std::sin(azimuth * radians), dy = -std::cos(azimuth * radians);
  // Multiples of 45° are exact.
  if (std::fmod(azimuth, 90.0) == 0) (std::abs(dx) < 0.5 ? dx : dy) = 0;
  if (std::fmod(azimuth, 90.0) == 45)
    dx = std::copysign(std::numbers::sqrt2 / 2, dx), dy = std::copysign(dx, dy);
  const double rise = std::tan(elevation * radians);
  float low = INFINITY, high = -INFINITY;
  for (const float h : map.pixels())
    if (std::isfinite(h)) low = std::min(low, h), high = std::max(high, h);
  const int reach = static_cast<int>(std::ceil((high - low) / rise)) + 2;
  // All cells have the same ray: the cells that it enters, and where.
  struct Entered {
    int x, y;
    double t;
  };
  std::vector<Entered> ray;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      if (x == 0 && y == 0) continue;
      double in = 0, out = INFINITY;
      for (const auto& [d, cell] : {std::pair(dx, x), std::pair(dy, y)}) {
        const double a = (cell - 0.5) / d, b = (cell + 0.5) / d;
        if (d == 0) {
          if (cell != 0) out = -1;
        } else {
          in = std::max(in, std::min(a, b));
          out = std::min(out, std::max(a, b));
        }
      }
      if (out - in > 1e-9 * out) ray.push_back({x, y, in});
    }
  Image<std::uint8_t> shadow(map.width(), map.height());
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const double own = map(x, y);
      if (!std::isfinite(own)) continue;
      for (const Entered& e : ray) {
        const float h = oracle_height(map, x + e.x, y + e.y, tiling);
        if (std::isfinite(h) && static_cast<double>(h) > own + e.t * rise) {
          shadow(x, y) = 1;
          break;
        }
      }
    }
  return shadow;
}

std::vector<ShadowOptions> devices(Tiling tiling) {
  std::vector<ShadowOptions> all{{tiling, Device::serial, 1, {}}};
  for (const Isa isa : available_isas()) all.push_back({tiling, Device::threads, 1, isa});
  all.push_back({tiling, Device::threads, 4, {}});
  return all;
}

std::size_t count_dark(const Image<std::uint8_t>& shadow) {
  return static_cast<std::size_t>(std::ranges::count(shadow.pixels(), 1));
}

/// Compares all devices with `expected`. Returns the number of dark cells.
std::size_t check(const Image<float>& map, const Sun& sun, Tiling tiling,
                  const Image<std::uint8_t>& expected) {
  for (const ShadowOptions& options : devices(tiling)) {
    const Image<std::uint8_t> got = sharp_shadows(map.view(), sun, options);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < got.pixels().size(); ++i)
      wrong += got.pixels()[i] != expected.pixels()[i];
    EXPECT_EQ(wrong, 0U) << map.width() << "x" << map.height() << " azimuth " << sun.azimuth_deg
                         << " elevation " << sun.elevation_deg << " tiling "
                         << static_cast<int>(tiling) << " device "
                         << static_cast<int>(options.device) << " isa "
                         << (options.isa ? name(*options.isa) : "best") << " threads "
                         << options.threads;
  }
  return count_dark(expected);
}
/// Compares with the oracle.
std::size_t check_sharp(const Image<float>& map, double azimuth, double elevation, Tiling tiling) {
  return check(map, {azimuth, elevation}, tiling, oracle(map, azimuth, elevation, tiling));
}
/// Compares with the plain definition, where the oracle would be too slow.
std::size_t check_devices(const Image<float>& map, const Sun& sun, Tiling tiling) {
  return check(map, sun, tiling, sharp_shadows(map.view(), sun, devices(tiling)[0]));
}

TEST(SharpShadows, EqualTraversalOnRandomMapsAndSuns) {
  Random random(1);
  const int scenes = test::share_of(200, 20);
  std::size_t dark = 0, cells = 0;
  for (int i = 0; i < scenes; ++i) {
    const int width = random.integer(1, 70), height = random.integer(1, 70);
    const auto relief = static_cast<float>(random.real(0.5, 30));
    const Image<float> map = random.chance(0.5) ? noise(width, height, relief, random.bits())
                                                : hills(width, height, relief, random.bits());
    const double azimuth =
        random.chance(0.3) ? 45.0 * random.integer(-8, 8) : random.real(-400, 400);
    const double elevation = random.chance(0.2) ? random.real(80, 90) : random.real(8, 80);
    dark += check_sharp(map, azimuth, elevation, kTilings[i % 4]);
    cells += map.pixels().size();
  }
  EXPECT_GT(dark, cells / 20) << "too little shadow to test it";
  EXPECT_LT(dark, cells * 19 / 20);
}

TEST(SharpShadows, LowSunsOverManyTiles) {
  for (const Tiling tiling : kTilings)
    for (const double azimuth : {0.0, 45.0, 90.0, 200.0, 283.0, 359.9}) {
      const Image<float> map = hills(33, 20, 6, 5);
      const std::size_t dark = check_sharp(map, azimuth, 1.5, tiling);
      EXPECT_GT(dark, 0U);
    }
}

TEST(SharpShadows, NearTheAxesAndDiagonals) {
  const Image<float> map = noise(40, 30, 12, 6);
  for (const double base : {0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0})
    for (const double off : {-1e-3, -1e-7, 1e-7, 1e-3})
      check_sharp(map, base + off, 20, Tiling::repeat);
}

/// Longer than the 512 bands that a thread takes at a time, in both directions.
TEST(SharpShadows, LongMapsWithSeveralBlocksAndParts) {
  for (const auto& map : {hills(560, 90, 40, 7), hills(90, 560, 40, 8)})
    for (const auto& [azimuth, tiling] :
         {std::pair(70.0, Tiling::repeat), std::pair(160.0, Tiling::clamp),
          std::pair(250.0, Tiling::mirror), std::pair(340.0, Tiling::repeat)})
      EXPECT_GT(check_sharp(map, azimuth, 25, tiling), 1000U);
}

TEST(SharpShadows, RealMap) {
  const auto heights = test::saint_helens();
  if (!heights) GTEST_SKIP() << test::kNoRealMap;
  // The crater and the holes of the eastern edge, because the oracle is slow on the whole map.
  Image<float> part(200, 160);
  const int left = heights->width() - part.width(), top = (heights->height() - part.height()) / 2;
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x) part(x, y) = (*heights)(left + x, top + y);
  EXPECT_GT(std::ranges::count_if(part.pixels(), [](float h) { return std::isnan(h); }), 10);
  for (const auto& [azimuth, elevation] : {std::pair(90.0, 10.0), std::pair(100.0, 35.0),
                                           std::pair(225.0, 10.0), std::pair(315.0, 35.0)})
    EXPECT_GT(check_sharp(part, azimuth, elevation, Tiling::clamp), 10U);
}

/// Reliefs beyond float32's units, and rays from such that climb all of it within two columns to
/// such that climb a few units a column.
TEST(SharpShadows, ReliefsOfAllSizesAndShadowsOfAllLengths) {
  const Image<float> ground = noise(70, 90, 1, 9);
  for (const double relief : {1e-37, 1e-20, 1.0, 1e20, 6e38})
    for (const double length : {1.5, 4.0, 60.0, 5e3}) {
      Image<float> map = ground;
      for (float& h : map.pixels()) h = (2 * h - 1) * static_cast<float>(relief / 2);
      // So close to 90° that it rounds to it if the relief is large.
      const double elevation = std::atan(relief / length) * 180 / std::numbers::pi;
      for (const double azimuth : {20.0, 70.0, 90.0, 225.0}) {
        const std::size_t dark = check_devices(map, {azimuth, elevation}, Tiling::repeat);
        EXPECT_EQ(dark > 0, elevation < 90) << "relief " << relief << " length " << length;
      }
    }
}

/// Plains behind the edge on the sun's side: the sweep needs nothing beyond the map.
TEST(SharpShadows, NothingBeyondTheMapIsHighEnough) {
  Image<float> map = noise(64, 70, 20, 11);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < 48; ++x) map(x, y) = 0;
  for (const double azimuth : {75.0, 90.0, 100.0})
    EXPECT_GT(check_sharp(map, azimuth, 25, Tiling::repeat), 500U);
}

/// One unit of the whole relief is more than all hills.
TEST(SharpShadows, OneSpikeAmongHills) {
  for (const float height : {1e3F, 1e7F}) {
    Image<float> map = noise(12, 15, 20, 10);
    map(8, 9) = height;
    for (const double azimuth : {70.0, 225.0})
      EXPECT_GT(check_devices(map, {azimuth, 15}, Tiling::clamp), 2U);
  }
}

TEST(SharpShadows, HolesNeitherCastNorReceive) {
  Image<float> map(20, 20);
  map(10, 10) = 5;
  map(15, 10) = NAN;
  map(14, 10) = INFINITY;
  map(13, 10) = -INFINITY;
  map(8, 10) = NAN;
  for (const ShadowOptions& options : devices(Tiling::clamp)) {
    const Image<std::uint8_t> shadow = sharp_shadows(map.view(), {90, 45}, options);
    // 5 high at 45°: the ray enters at 0.5, 1.5, … 4.5, below 5.
    for (int x = 0; x < 20; ++x) EXPECT_EQ(shadow(x, 10), x >= 5 && x < 10 && x != 8 ? 1 : 0) << x;
    EXPECT_EQ(count_dark(shadow), 4U);
  }
}

TEST(SharpShadows, FlatMapsNightZenithAndOneCell) {
  Image<float> flat(30, 30), one(1, 1), holes(3, 3);
  for (float& h : holes.pixels()) h = NAN;
  one(0, 0) = 9;
  for (const ShadowOptions& options : devices(Tiling::repeat)) {
    EXPECT_EQ(count_dark(sharp_shadows(flat.view(), {10, 0.001}, options)), 0U);
    EXPECT_EQ(count_dark(sharp_shadows(one.view(), {10, 0.001}, options)), 0U);
    EXPECT_EQ(count_dark(sharp_shadows(holes.view(), {10, 40}, options)), 0U);
    EXPECT_EQ(count_dark(sharp_shadows(flat.view(), {10, 0}, options)), 900U);
    EXPECT_EQ(count_dark(sharp_shadows(flat.view(), {10, -30}, options)), 900U);
    const Image<float> rough = noise(30, 30, 1000, 3);
    EXPECT_EQ(count_dark(sharp_shadows(rough.view(), {10, 90}, options)), 0U);
    const std::size_t low = count_dark(sharp_shadows(rough.view(), {10, 1e-9}, options));
    EXPECT_GT(low, 850U) << "the sun is lifted, not switched off";
    EXPECT_LT(low, 900U) << "the highest cell sees it";
  }
}

TEST(SharpShadows, RefusesSunsThatAreNone) {
  const Image<float> map(4, 4);
  EXPECT_THROW((void)sharp_shadows(map.view(), {NAN, 40}), Error);
  EXPECT_THROW((void)sharp_shadows(map.view(), {0, INFINITY}), Error);
  EXPECT_THROW((void)sharp_shadows(map.view(), {0, 90.5}), Error);
  EXPECT_THROW((void)hidden_samples(map.view(), {0, 40}, {0, 256}), Error);
  EXPECT_THROW((void)hidden_samples(map.view(), {0, 40}, {1024, 1}), Error);
  EXPECT_THROW((void)soft_light(map.view(), {0, 40}, -1), Error);
}

TEST(SharpShadows, RefuseInstructionSetsThatAreNotThere) {
  const Image<float> map(4, 4);
  for (const Device device : {Device::serial, Device::threads}) {
    const ShadowOptions options{.device = device, .isa = test::missing_isa()};
    EXPECT_THROW((void)sharp_shadows(map.view(), {0, 40}, options), Error);
    EXPECT_THROW((void)hidden_samples(map.view(), {0, 40}, {}, options), Error);
    EXPECT_THROW((void)soft_light(map.view(), {0, 40}, 0.3, options), Error);
  }
}

TEST(SharpShadows, ReadMapsUpsideDownAndRefuseRowsThatOverlap) {
  Image<float> map(5, 4), turned(5, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x)
      map(x, y) = turned(x, 3 - y) = static_cast<float>((x * 7 + y * 5) % 4);
  const Sun sun{.azimuth_deg = 200, .elevation_deg = 30};
  const ImageView<const float> from_below{&turned(0, 3), 5, 4, -5},
      overlapping{&map(0, 0), 5, 4, 0};
  const auto equal = [](const auto& a, const auto& b) {
    return std::ranges::equal(a.pixels(), b.pixels());
  };
  EXPECT_TRUE(equal(sharp_shadows(map, sun), sharp_shadows(from_below, sun)));
  EXPECT_TRUE(equal(soft_light(map, sun, 0.3), soft_light(from_below, sun, 0.3)));
  EXPECT_TRUE(equal(hidden_samples(map, sun), hidden_samples(from_below, sun)));
  EXPECT_THROW(static_cast<void>(sharp_shadows(overlapping, sun)), Error);
  EXPECT_THROW(static_cast<void>(soft_light(overlapping, sun, 0.3)), Error);
  EXPECT_THROW(static_cast<void>(hidden_samples(overlapping, sun)), Error);
}

TEST(HiddenSamples, EqualThePapersLoop) {
  Random random(2);
  for (int scene = 0; scene < 60; ++scene) {
    const int width = random.integer(1, 150), height = random.integer(1, 60);
    Image<float> map = noise(width, height, static_cast<float>(random.real(1, 200)), random.bits());
    if (scene % 5 == 0) map(width / 2, height / 2) = NAN;
    const Sun sun{random.real(0, 360), random.real(-5, 90)};
    const March march{random.real(10, 1500), random.integer(2, 300)};
    const Tiling tiling = kTilings[scene % 4];
    const double radians = std::numbers::pi / 180;
    const double lx = std::sin(sun.azimuth_deg * radians) * std::cos(sun.elevation_deg * radians);
    const double ly = -std::cos(sun.azimuth_deg * radians) * std::cos(sun.elevation_deg * radians);
    const double lz = std::sin(sun.elevation_deg * radians);
    for (const ShadowOptions& options : devices(tiling)) {
      const Image<std::uint16_t> counts = hidden_samples(map.view(), sun, march, options);
      std::size_t wrong = 0;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          int n = 0;
          for (int k = 1; k < march.steps; ++k) {
            const double t = march.distance * k / march.steps;
            const auto sx = static_cast<std::int64_t>(std::floor(x + t * lx));
            const auto sy = static_cast<std::int64_t>(std::floor(y + t * ly));
            const float ray = map(x, y) + static_cast<float>(t * lz);
            n += ray < oracle_height(map, sx, sy, tiling);
          }
          wrong += counts(x, y) != n;
        }
      EXPECT_EQ(wrong, 0U) << "scene " << scene << " isa "
                           << (options.isa ? name(*options.isa) : "none");
    }
  }
}

TEST(SoftLight, APostsShadowFadesAwayFromIt) {
  Image<float> map(400, 9);
  map(380, 4) = 200;
  // The sun in the east, 45° high: the shadow of the post's top falls 200 cells to its west. With a
  // radius of 2° it fades between tan(47°) and tan(43°).
  const Image<std::uint8_t> soft = soft_light(map.view(), {90, 45}, 2, {Tiling::clamp});
  EXPECT_EQ(soft(100, 4), 255);
  EXPECT_LT(soft(375, 4), 20) << "close to the post the sun is hidden";
  const int first = static_cast<int>(380 - 200 / std::tan(43 * std::numbers::pi / 180));
  EXPECT_EQ(soft(first - 2, 4), 255);
  int partial = 0;
  for (int x = first; x < 380; ++x) partial += soft(x, 4) > 0 && soft(x, 4) < 255 ? 1 : 0;
  EXPECT_GT(partial, 50);
  const Image<std::uint8_t> point = soft_light(map.view(), {90, 45}, 0, {Tiling::clamp});
  const Image<std::uint8_t> sharp = sharp_shadows(map.view(), {90, 45}, {Tiling::clamp});
  for (std::size_t i = 0; i < sharp.pixels().size(); ++i)
    ASSERT_EQ(point.pixels()[i], sharp.pixels()[i] == 1 ? 0 : 255);
}

}  // namespace
}  // namespace rastrum::terrain::shadow_test
