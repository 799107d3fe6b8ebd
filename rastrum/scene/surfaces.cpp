// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/scene.hpp>
#include <rastrum/scene/polylines.hpp>
#include <rastrum/surfaces.hpp>

namespace rastrum {

std::size_t TubesView::size() const {
  if (offsets.empty()) return positions.empty() ? 0 : positions.size() - 1;
  return polylines::segments_before(offsets, offsets.size() - 1);
}

std::size_t TubesView::begin(std::uint64_t segment) const {
  const auto s = static_cast<std::size_t>(segment);
  return offsets.empty() ? s : polylines::begin_of(offsets, s);
}

std::uint64_t primitive_count(GeometryRef geometry) {
  const auto count = [](const auto& g) -> std::uint64_t {
    if constexpr (requires { g.triangle_count(); })
      return g.triangle_count();
    else
      return g.size();
  };
  return geometry.visit(count);
}

SpheresView Spheres::view() const {
  return {centers, radii, radius, colors, material, {}};
}

CylindersView Cylinders::view() const {
  return {positions, indices, radii, radius, colors, caps, material, {}};
}

TubesView Tubes::view() const {
  return {positions, offsets, radii, radius, colors, material, {}};
}

DiscsView Discs::view() const {
  return {centers, normals, radii, radius, colors, material, {}};
}

}  // namespace rastrum
