// The images of the surface at each pixel, and what differs between two of them.
#pragma once

#include <cstdint>

#include <gtest/gtest.h>

#include <rastrum/frame.hpp>

namespace rastrum::test {

struct Surfaces {
  Image<float> depth;
  Image<std::int64_t> ids, instances, primitives;
  Image<Vec2> barycentrics;
  Image<Vec3> positions, normals, camera_normals;
  Image<float> view_depth, distance;
  Image<Vec4> albedo;

  /// They hold nonsense, so that a pixel which nobody wrote shows.
  Surfaces(int width, int height);
  [[nodiscard]] Targets targets();
};

/// Calls f(image) for each.
template <class F>
void for_each_image(const Surfaces& s, const F& f) {
  f(s.ids);
  f(s.depth);
  f(s.instances);
  f(s.primitives);
  f(s.barycentrics);
  f(s.positions);
  f(s.normals);
  f(s.camera_normals);
  f(s.view_depth);
  f(s.distance);
  f(s.albedo);
}

/// All bits; the message names the image and the first pixel that differs.
[[nodiscard]] testing::AssertionResult same_bits(const Surfaces& a, const Surfaces& b);

}  // namespace rastrum::test
