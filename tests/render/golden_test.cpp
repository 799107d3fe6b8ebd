// SPDX-License-Identifier: BSD-3-Clause
// Golden pictures of the procedural shapes, drawn by the serial device; threads must give the same
// bits.
#include <gtest/gtest.h>

#include <cmath>

#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::golden_test {
namespace {

struct Picture {
  const char* name;
  Mesh (*mesh)();
  Shader shader;
  int width, height;
};

std::ostream& operator<<(std::ostream& out, const Picture& p) {
  return out << p.name;
}

constexpr Picture kPictures[] = {
    {"teapot_phong", [] { return shapes::teapot(12); }, Shader::phong, 200, 150},
    {"torus_knot_normal", [] { return shapes::torus_knot(2, 3, 160, 16); }, Shader::normal, 150,
     150},
    {"soup_wireframe", [] { return shapes::soup(40, 0.3F, 1.2F); }, Shader::wireframe, 160, 120},
};

// From above and the side, off every axis. The near plane touches the bounding sphere, so that
// depths use their whole range.
Camera oblique_camera(const SceneView& scene) {
  Camera c = fit_camera(scene, 0.8F, false);
  const float distance = length(Vec3(c.eye) - Vec3(c.target));
  const float radius = distance * std::sin(c.fov_rad / 2);
  c.eye = Vec3(c.target) + normalize(Vec3{0.45F, 0.4F, 1}) * (1.05F * distance);
  c.near_plane = 1.05F * distance - 1.01F * radius;
  return c;
}

class Golden : public testing::TestWithParam<Picture> {};

TEST_P(Golden, Picture) {
  const Picture& p = GetParam();
  const Scene scene = single(p.mesh());
  const Camera camera = oblique_camera(SceneBinding(scene).view());
  RenderOptions options(
      {.width = p.width, .height = p.height, .shader = p.shader, .background = {1, 1, 1, 1}},
      {.device = Device::serial});
  const Frame serial = draw(options, scene, camera);
  EXPECT_TRUE(matches_golden(p.name, serial.color8));
  options.device = Device::threads;
  EXPECT_TRUE(same_picture(draw(options, scene, camera), serial, 0));
}

INSTANTIATE_TEST_SUITE_P(Shapes, Golden, testing::ValuesIn(kPictures),
                         [](const testing::TestParamInfo<Picture>& p) {
                           return std::string(p.param.name);
                         });

}  // namespace
}  // namespace rastrum::test::golden_test
