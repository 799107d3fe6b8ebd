// Spheres, cylinders, tubes, discs, points and lines in many memories: a geometry's arrays as other
// types and strides, which must give the picture of the packed ones.
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

/// `n` places in a ball of radius 4, a radius each in 64ths and a size of up to 9 px, colours of
/// whole 255ths, pairs and runs of them.
struct Cloud {
  std::vector<Vec3> positions, normals;
  std::vector<float> radii, sizes;
  std::vector<Vec4> colors;
  std::vector<std::uint8_t> colors8;
  std::vector<std::uint32_t> pairs, offsets{0};

  explicit Cloud(int n, std::uint64_t seed = 1) {
    Random r(seed);
    const auto real = [&](double a, double b) { return static_cast<float>(r.real(a, b)); };
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
  /// Points and lines, the last three geometries, transform float64 places in float64: their
  /// picture may be another one.
  bool wide = false;
};
inline constexpr std::size_t kPointsAndLinesFrom = 4;

namespace layouts_detail {

template <class C>
CloudLayout cloud_indices(const char* name, std::ptrdiff_t stride = sizeof(C)) {
  return {name, [=](const Cloud& c, Memory& m, CloudViews& v) {
            const auto other = [&](const std::vector<std::uint32_t>& from) {
              const std::vector<C> values(from.begin(), from.end());
              return IndexView::of(m.put(values.data(), 1, values.size(), stride, 1), values.size(),
                                   stride);
            };
            v.pairs = other(c.pairs);
            v.offsets = other(c.offsets);
          }};
}

inline std::vector<double> wide(const std::vector<Vec3>& from) {
  std::vector<double> all;
  for (const Vec3& p : from) all.insert(all.end(), {p.x, p.y, p.z});
  return all;
}

}  // namespace layouts_detail

/// Layouts for clouds of fewer than 128 places; those with integers of 8 and 16 bits come first.
inline std::vector<CloudLayout> cloud_layouts() {
  using namespace layouts_detail;
  std::vector<CloudLayout> all;
  all.push_back(cloud_indices<std::uint8_t>("indices uint8"));
  all.push_back(cloud_indices<std::int8_t>("indices int8"));
  all.push_back(cloud_indices<std::uint16_t>("indices uint16"));
  all.push_back(cloud_indices<std::int16_t>("indices int16 backwards", -2));
  all.push_back(cloud_indices<std::int32_t>("indices int32"));
  all.push_back(cloud_indices<std::uint32_t>("indices uint32 with a stride", 12));
  all.push_back(cloud_indices<std::int64_t>("indices int64"));
  all.push_back(cloud_indices<std::uint64_t>("indices uint64 backwards", -8));
  all.push_back({"float64 positions, normals and radii",
                 [](const Cloud& c, Memory& m, auto& v) {
                   const std::size_t n = c.positions.size();
                   v.positions = ArrayView<Vec3>::of(m.put(wide(c.positions).data(), 3, n, 24), n);
                   v.normals =
                       ArrayView<Vec3>::of(m.put(wide(c.normals).data(), 3, n, 32, 4), n, 32);
                   const std::vector<double> radii(c.radii.begin(), c.radii.end());
                   v.radii = ArrayView<float>::of(m.put(radii.data(), 1, n, -8), n, -8);
                   const std::vector<double> sizes(c.sizes.begin(), c.sizes.end());
                   v.sizes = ArrayView<float>::of(m.put(sizes.data(), 1, n, 16), n, 16);
                 },
                 true});
  all.push_back({"one interleaved buffer, unaligned", [](const Cloud& c, Memory& m, auto& v) {
                   const std::size_t n = c.positions.size();
                   v.positions = ArrayView<Vec3>::of(m.put(&c.positions[0].x, 3, n, 21, 3), n, 21);
                   v.normals = ArrayView<Vec3>::of(m.put(&c.normals[0].x, 3, n, -12), n, -12);
                   v.radii = ArrayView<float>::of(m.put(c.radii.data(), 1, n, 7, 1), n, 7);
                   v.sizes = ArrayView<float>::of(m.put(c.sizes.data(), 1, n, -5, 2), n, -5);
                 }});
  all.push_back({"RGBA8", [](const Cloud& c, Memory& m, auto& v) {
                   const std::size_t n = c.positions.size();
                   v.colors = ArrayView<Vec4>::of(m.put(c.colors8.data(), 4, n, 4), n);
                 }});
  all.push_back({"RGB8 of RGBA8", [](const Cloud& c, Memory& m, auto& v) {
                   const std::size_t n = c.positions.size();
                   v.colors = ArrayView<Vec4>::rgb(m.put(c.colors8.data(), 4, n, 4), n, 4);
                 }});
  return all;
}

}  // namespace rastrum::test
