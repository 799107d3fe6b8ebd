#include "tests/support/surfaces.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace rastrum::test {
namespace {

template <class T>
void spoil(Image<T>& image, int width, int height) {
  image = Image<T>(width, height);
  std::memset(static_cast<void*>(image.pixels().data()), 0x5A, image.pixels().size_bytes());
}

template <class T>
void compare(const Image<T>& a, const Image<T>& b, const char* name, std::string& problem) {
  if (!problem.empty()) return;
  const auto differs = [](const T& v, const T& w) { return std::memcmp(&v, &w, sizeof v) != 0; };
  const auto [at, other] = std::mismatch(a.pixels().begin(), a.pixels().end(), b.pixels().begin(),
                                         [&](const T& v, const T& w) { return !differs(v, w); });
  if (at == a.pixels().end()) return;
  const auto i = at - a.pixels().begin();
  problem = std::string(name) + " differs at " + std::to_string(i % a.width()) + ", " +
            std::to_string(i / a.width());
}

}  // namespace

Surfaces::Surfaces(int width, int height) {
  spoil(depth, width, height);
  spoil(ids, width, height);
  spoil(instances, width, height);
  spoil(primitives, width, height);
  spoil(barycentrics, width, height);
  spoil(positions, width, height);
  spoil(normals, width, height);
  spoil(camera_normals, width, height);
  spoil(view_depth, width, height);
  spoil(distance, width, height);
  spoil(albedo, width, height);
}

Targets Surfaces::targets() {
  Targets t;
  t.depth = depth;
  t.ids = ids;
  t.instances = instances;
  t.primitives = primitives;
  t.barycentrics = barycentrics;
  t.positions = positions;
  t.normals = normals;
  t.camera_normals = camera_normals;
  t.view_depth = view_depth;
  t.distance = distance;
  t.albedo = albedo;
  return t;
}

testing::AssertionResult same_bits(const Surfaces& a, const Surfaces& b) {
  std::string problem;
  compare(a.ids, b.ids, "ids", problem);
  compare(a.depth, b.depth, "depth", problem);
  compare(a.instances, b.instances, "instances", problem);
  compare(a.primitives, b.primitives, "primitives", problem);
  compare(a.barycentrics, b.barycentrics, "barycentrics", problem);
  compare(a.positions, b.positions, "positions", problem);
  compare(a.normals, b.normals, "normals", problem);
  compare(a.camera_normals, b.camera_normals, "camera_normals", problem);
  compare(a.view_depth, b.view_depth, "view_depth", problem);
  compare(a.distance, b.distance, "distance", problem);
  compare(a.albedo, b.albedo, "albedo", problem);
  if (problem.empty()) return testing::AssertionSuccess();
  return testing::AssertionFailure() << problem;
}

}  // namespace rastrum::test
