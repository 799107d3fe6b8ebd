// SPDX-License-Identifier: BSD-3-Clause
// How missing parts of a camera are filled in.
#include "job/camera.hpp"

#include <cmath>
#include <limits>

#include <rastrum/fit.hpp>
#include <rastrum/shapes.hpp>

#include "parse/arguments.hpp"
#include "program.hpp"

namespace rastrum::test::view_test {
namespace {

/// Half of the diagonal from (0, 0, 0) to (2, 4, 4) is r = 3; the centre is (1, 2, 2).
Scene box_scene() {
  Scene scene;
  scene.meshes.emplace_back().positions = {{0, 0, 0}, {2, 4, 4}, {2, 0, 0}};
  scene.instances.emplace_back();
  return scene;
}

Camera choose(const cli::ViewOptions& options, const Scene& scene = box_scene()) {
  return cli::choose_camera(options, scene, SceneBinding(scene).view(), {160, 90});
}
cli::ViewOptions sphere() {
  cli::ViewOptions o;
  o.fit = cli::Fit::sphere;
  return o;
}

TEST(ChooseCamera, NothingGivenFillsThePicture) {
  const Scene scene = box_scene();
  const SceneBinding binding(scene);
  const auto same = [](const Camera& a, const Camera& b) {
    return a.eye == b.eye && a.target == b.target && a.near_plane == b.near_plane;
  };
  EXPECT_TRUE(same(choose({}), fit_picture(binding.view(), {}, 160, 90)));
  cli::ViewOptions o;
  o.turns = true;
  EXPECT_TRUE(same(choose(o), fit_picture(binding.view(), {}, 160, 90, {.turns = true})));
  o = {};
  o.up = Vec3{1, 1, 0};
  Camera up{.up = {1, 1, 0}};
  EXPECT_TRUE(same(choose(o), fit_picture(binding.view(), up, 160, 90)));
  o.up = Vec3{0, 0, 1};
  EXPECT_THROW((void)choose(o), cli::UsageError);
}

TEST(ChooseCamera, TheSphereIsTheFitOfBefore) {
  const Camera c = choose(sphere());
  EXPECT_EQ(c.target, (Vec3{1, 2, 2}));
  EXPECT_NEAR(c.eye.z, 2 + 3 / std::sin(std::acos(-1.0) / 6), 1e-5);
  EXPECT_TRUE(std::isinf(c.far_plane));
}

TEST(ChooseCamera, EyeAloneLooksAtTheCentreFromOutside) {
  cli::ViewOptions o;
  o.eye = Vec3{1, 2, 22};
  const Camera c = choose(o);
  EXPECT_EQ(c.eye, (Vec3{1, 2, 22}));
  EXPECT_EQ(c.target, (Vec3{1, 2, 2}));
  EXPECT_NEAR(c.near_plane, 20 - 1.001 * 3, 1e-4);
  EXPECT_TRUE(std::isinf(c.far_plane));
}

TEST(ChooseCamera, EyeInsideHasANearPlaneAboveZero) {
  cli::ViewOptions o;
  o.eye = Vec3{1, 2, 3};
  EXPECT_NEAR(choose(o).near_plane, 0.003, 1e-6);
  o.eye = Vec3{1, 2, 2};
  o.target = Vec3{0, 2, 2};
  EXPECT_NEAR(choose(o).near_plane, 0.003, 1e-6);
}

TEST(ChooseCamera, TargetAloneKeepsTheEye) {
  cli::ViewOptions o;
  o.target = Vec3{0, 0, 0};
  const Camera fit = choose(sphere()), c = choose(o);
  EXPECT_EQ(c.eye, fit.eye);
  EXPECT_EQ(c.near_plane, fit.near_plane);
  EXPECT_EQ(c.target, (Vec3{0, 0, 0}));
}

TEST(ChooseCamera, OrthographicHasAFarPlaneBehindTheScene) {
  cli::ViewOptions o;
  o.orthographic = true;
  o.orthographic_height = 5;
  o.eye = Vec3{1, 2, 22};
  const Camera c = choose(o);
  EXPECT_TRUE(c.orthographic);
  EXPECT_EQ(c.orthographic_height, 5);
  EXPECT_NEAR(c.far_plane, 20 + 1.001 * 3, 1e-4);
}

TEST(ChooseCamera, FovMovesTheFitCamera) {
  cli::ViewOptions o = sphere();
  o.fov_deg = 90;
  const Camera c = choose(o);
  EXPECT_NEAR(c.fov_rad, std::acos(-1.0) / 2, 1e-6);
  EXPECT_NEAR(c.eye.z, 2 + 3 * std::sqrt(2.0), 1e-5);
}

TEST(ChooseCamera, FileCameraTakesWhatIsGiven) {
  Scene scene = box_scene();
  scene.cameras.resize(2);
  scene.cameras[1].eye = {7, 8, 9};
  scene.cameras[1].near_plane = 0.5F;
  cli::ViewOptions o;
  o.file_camera = 1;
  EXPECT_EQ(choose(o, scene).eye, (Vec3{7, 8, 9}));
  EXPECT_EQ(choose(o, scene).near_plane, 0.5F);
  o.far_plane = 30;
  EXPECT_EQ(choose(o, scene).far_plane, 30);
  o.fov_deg = 90;
  EXPECT_NEAR(choose(o, scene).fov_rad, std::acos(-1.0) / 2, 1e-6);
  o.file_camera = 2;
  EXPECT_THROW((void)choose(o, scene), cli::UsageError);
}

TEST(CheckView, Planes) {
  const auto refused = [](auto change) {
    cli::ViewOptions o;
    change(o);
    EXPECT_THROW(cli::check_view(o), cli::UsageError);
  };
  refused([](cli::ViewOptions& o) { o.near_plane = 0; });
  refused([](cli::ViewOptions& o) { o.near_plane = o.far_plane = 2; });
  refused([](cli::ViewOptions& o) {
    o.orthographic = true;
    o.far_plane = std::numeric_limits<double>::infinity();
  });
  cli::ViewOptions behind;
  behind.orthographic = true;
  behind.near_plane = -5;
  EXPECT_NO_THROW(cli::check_view(behind));
}

}  // namespace
}  // namespace rastrum::test::view_test
