// SPDX-License-Identifier: BSD-3-Clause
// Spheres, cylinders, tubes, discs, points and lines in many memory layouts: arrays of other types
// and strides, which must give the picture of the packed ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <rastrum/scene.hpp>

#include "tests/support/array_layouts.hpp"
#include "tests/support/random.hpp"

namespace rastrum::test {

/// `n` places in a ball of radius 4, with radii in 64ths, sizes of up to 9 px, colours in 255ths,
/// and pairs and runs of places.
struct Cloud {
  std::vector<Vec3> positions, normals;
  std::vector<float> radii, sizes;
  std::vector<Vec4> colors;
  std::vector<std::uint8_t> colors8;
  std::vector<std::uint32_t> pairs, offsets{0};

  explicit Cloud(int n, std::uint64_t seed = 1) {
    Random r(seed);
    const auto real = [&](double a, double b) { return r.real32(a, b); };
    for (int i = 0; i < n; ++i) {
      positions.push_back({real(-3, 3), real(-3, 3), real(-3, 3)});
      normals.push_back({real(-1, 1), real(-1, 1), real(-1, 1)});
      radii.push_back(static_cast<float>(r.integer(4, 24)) / 64);
      sizes.push_back(1 + static_cast<float>(i % 33) / 4);
      Vec4 c;
      for (float* const channel : {&c.x, &c.y, &c.z, &c.w}) {
        const int v = channel == &c.w ? 255 : r.integer(0, 255);
        colors8.push_back(static_cast<std::uint8_t>(v));
        *channel = static_cast<float>(v) / 255.0F;
      }
      colors.push_back(c);
      pairs.push_back(static_cast<std::uint32_t>(r.integer(0, n - 1)));
    }
    if (n % 2 != 0) pairs.pop_back();
    while (offsets.back() < positions.size())
      offsets.push_back(std::min<std::uint32_t>(offsets.back() + 1 + offsets.back() % 7,
                                                static_cast<std::uint32_t>(n)));
  }
};

/// The arrays of a cloud as views.
struct CloudViews {
  ArrayView<Vec3> positions, normals;
  ArrayView<float> radii, sizes;
  ArrayView<Vec4> colors;
  IndexView pairs, offsets;

  explicit CloudViews(const Cloud& c)
      : positions(c.positions),
        normals(c.normals),
        radii(c.radii),
        sizes(c.sizes),
        colors(c.colors),
        pairs(c.pairs),
        offsets(c.offsets) {}

  [[nodiscard]] std::vector<GeometryView> geometries() const {
    SpheresView spheres{.centers = positions, .radii = radii, .colors = colors};
    CylindersView cylinders{
        .positions = positions, .indices = pairs, .radii = radii, .colors = colors};
    TubesView tubes{.positions = positions, .offsets = offsets, .radii = radii, .colors = colors};
    DiscsView discs{.centers = positions, .normals = normals, .radii = radii, .colors = colors};
    PointsView points{.positions = positions,
                      .indices = pairs,
                      .normals = normals,
                      .colors = colors,
                      .sizes = sizes,
                      .round = true};
    LinesView segments{.positions = positions, .indices = pairs, .colors = colors, .line_width = 3};
    LinesView polylines{
        .positions = positions, .kind = LineKind::polylines, .offsets = offsets, .colors = colors};
    return {spheres, cylinders, tubes, discs, points, segments, polylines};
  }
};

struct CloudLayout {
  std::string name;
  std::function<void(const Cloud&, Memory&, CloudViews&)> change;
  /// float64 positions: the last three geometries (points and lines) are transformed in float64, so
  /// their picture may differ.
  bool wide = false;

  [[nodiscard]] std::vector<GeometryView> geometries(const Cloud& cloud, Memory& memory) const {
    CloudViews views(cloud);
    change(cloud, memory, views);
    return views.geometries();
  }
};
inline constexpr std::size_t kPointsAndLinesFrom = 4;

/// Layouts for clouds of fewer than 128 places; those with integers of 8 and 16 bits come first.
inline std::vector<CloudLayout> cloud_layouts() {
  std::vector<CloudLayout> all;
  const auto add_indices = [&]<class C>(const char* name, C, std::ptrdiff_t stride = sizeof(C)) {
    all.push_back({std::string("indices ") + name, [=](const Cloud& c, Memory& m, CloudViews& v) {
                     v.pairs = m.indices<C>(c.pairs, stride, 1);
                     v.offsets = m.indices<C>(c.offsets, stride, 1);
                   }});
  };
  add_indices("uint8", std::uint8_t{});
  add_indices("int8", std::int8_t{});
  add_indices("uint16", std::uint16_t{});
  add_indices("int16 backwards", std::int16_t{}, -2);
  add_indices("int32", std::int32_t{});
  add_indices("uint32 with a stride", std::uint32_t{}, 12);
  add_indices("int64", std::int64_t{});
  add_indices("uint64 backwards", std::uint64_t{}, -8);
  const auto add = [&](const char* name, auto change, bool wide = false) {
    all.push_back({name, change, wide});
  };
  add(
      "float64 positions, normals and radii",
      [](const Cloud& c, Memory& m, CloudViews& v) {
        const std::size_t n = c.positions.size();
        const std::vector<double> radii(c.radii.begin(), c.radii.end());
        const std::vector<double> sizes(c.sizes.begin(), c.sizes.end());
        v.positions = m.view<Vec3>(layouts_detail::wide(c.positions).data(), n, 24);
        v.normals = m.view<Vec3>(layouts_detail::wide(c.normals).data(), n, 32, 4);
        v.radii = m.view<float>(radii.data(), n, -8);
        v.sizes = m.view<float>(sizes.data(), n, 16);
      },
      true);
  add("one interleaved buffer, unaligned", [](const Cloud& c, Memory& m, CloudViews& v) {
    const std::size_t n = c.positions.size();
    v.positions = m.view<Vec3>(&c.positions[0].x, n, 21, 3);
    v.normals = m.view<Vec3>(&c.normals[0].x, n, -12);
    v.radii = m.view<float>(c.radii.data(), n, 7, 1);
    v.sizes = m.view<float>(c.sizes.data(), n, -5, 2);
  });
  add("RGBA8", [](const Cloud& c, Memory& m, CloudViews& v) {
    v.colors = m.view<Vec4>(c.colors8.data(), c.positions.size(), 4);
  });
  add("RGB8 of RGBA8", [](const Cloud& c, Memory& m, CloudViews& v) {
    const std::size_t n = c.positions.size();
    v.colors = ArrayView<Vec4>::rgb(m.put(c.colors8.data(), 4, n, 4), n, 4);
  });
  return all;
}

}  // namespace rastrum::test
