// SPDX-License-Identifier: BSD-3-Clause
// Random quadrics (surfaces.hpp) in the cube [−1, 1]³: spheres, cylinders and discs, each in the
// colour of its place. torus_knot.cpp has the tube.

#include <algorithm>
#include <utility>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/scene/shapes/place_color.hpp>
#include <rastrum/scene/shapes/random.hpp>
#include <rastrum/scene/shapes/require.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::shapes {
namespace {

constexpr double kMostPrimitives = 1 << 30;

Vec3d place_in(Random& random, double room) {
  const double x = random.uniform(-room, room), y = random.uniform(-room, room);
  return {x, y, random.uniform(-room, room)};
}

/// Radii are drawn so that each size covers about as much of the picture.
double radius_between(Random& random, double least, double most) {
  const double u = random.uniform();
  return least * most / (most + (least - most) * u);
}

/// Spheres or discs. also(random, made) draws their other attributes.
template <class Round, class Also>
Round round_ones(const char* shape, int count, float min_radius, float max_radius,
                 std::uint64_t seed, const Also& also) {
  const FloatScope floats;
  require_range(shape, "count", count, 1, kMostPrimitives);
  require_range(shape, "max_radius", max_radius, 1e-6, 1);
  require_range(shape, "min_radius", min_radius, 1e-6, max_radius);
  Round made;
  made.name = shape;
  for (int i = 0; i < count; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i));
    const double r = radius_between(random, double{min_radius}, double{max_radius});
    const Vec3d p = place_in(random, 1 - r);
    made.centers.push_back(static_cast<Vec3>(p));
    made.radii.push_back(static_cast<float>(r));
    made.colors.push_back(place_color(p));
    also(random, made);
  }
  return made;
}

}  // namespace

Spheres spheres(int count, float min_radius, float max_radius, std::uint64_t seed) {
  return round_ones<Spheres>("spheres", count, min_radius, max_radius, seed,
                             [](Random&, Spheres&) {});
}

Cylinders cylinders(int count, float length, float radius, std::uint64_t seed) {
  const FloatScope floats;
  require_range("cylinders", "count", count, 1, kMostPrimitives);
  require_range("cylinders", "length", length, 1e-6, 1);
  require_range("cylinders", "radius", radius, 1e-6, 0.5);
  Cylinders c;
  c.name = "cylinders";
  const double half = double{length} / 2, room = 1 - half - double{radius};
  for (int i = 0; i < count; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i));
    const Vec3d axis = random.unit_vector() * half;
    const Vec3d middle = place_in(random, std::max(room, 0.0));
    const double thin = random.uniform() * double{radius};
    for (const auto& [p, r] : {std::pair{middle - axis, double{radius}}, {middle + axis, thin}}) {
      c.positions.push_back(static_cast<Vec3>(p));
      c.radii.push_back(static_cast<float>(r));
      c.colors.push_back(place_color(p));
    }
  }
  return c;
}

Discs discs(int count, float min_radius, float max_radius, std::uint64_t seed) {
  return round_ones<Discs>("discs", count, min_radius, max_radius, seed,
                           [](Random& random, Discs& d) {
                             d.normals.push_back(static_cast<Vec3>(random.unit_vector()));
                           });
}

}  // namespace rastrum::shapes
