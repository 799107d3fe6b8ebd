// SPDX-License-Identifier: BSD-3-Clause
// fit_picture shows everything, as large as possible.
#include <rastrum/fit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/core/angle.hpp>
#include <rastrum/error.hpp>
#include <rastrum/shapes.hpp>
#include <rastrum/transform.hpp>

namespace rastrum::test::fit_test {
namespace {

struct Size {
  int width, height;
};
constexpr Size kSizes[] = {{1280, 720}, {720, 1280}, {100, 100}, {300, 100}};
constexpr double kUsual = FitOptions{}.fill;

Scene scene_of(Mesh mesh, const Mat4d& placed = Mat4d::identity()) {
  Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({0, placed});
  return scene;
}

/// The scene's extent in NDC, −1 to 1.
struct Box {
  double x0 = 9, x1 = -9, y0 = 9, y1 = -9, z0 = 9, z1 = -9;
};
void add_projected(Box& b, const Scene& scene, const Camera& camera, Size size) {
  const Mat4d m = world_to_clip(camera, size.width, size.height);
  for (const Instance& instance : scene.instances) {
    const Mat4 all = static_cast<Mat4>(m * instance.object_to_world);
    for (const Vec3 p : scene.meshes[instance.mesh].positions) {
      const Vec4 q = transform_point(all, p);
      ASSERT_GT(q.w, 0);
      const double x = static_cast<double>(q.x / q.w), y = static_cast<double>(q.y / q.w);
      const double z = static_cast<double>(q.z / q.w);
      b = {std::min(b.x0, x), std::max(b.x1, x), std::min(b.y0, y),
           std::max(b.y1, y), std::min(b.z0, z), std::max(b.z1, z)};
    }
  }
}

/// Expects that all is inside, that this share of one side is filled, and that margins are equal.
void expect_filled(const Box& b, double fill = kUsual) {
  constexpr double kTolerance = 2e-5;
  EXPECT_NEAR(std::max(b.x1, b.y1), fill, kTolerance);
  EXPECT_NEAR(b.x0, -b.x1, kTolerance);
  EXPECT_NEAR(b.y0, -b.y1, kTolerance);
  EXPECT_GE(b.z0, 0);
  EXPECT_LT(b.z1, 1);
}

Camera view_from(Vec3 eye, Vec3 up, float fov_rad, bool orthographic) {
  return Camera{
      .eye = eye, .target = {}, .up = up, .fov_rad = fov_rad, .orthographic = orthographic};
}

TEST(FitPicture, FillsPicturesOfEveryShapeFromEverySide) {
  const Mat4d placed = translation({30, -7, 11}) * scaling({2, 0.5F, 1});
  for (const Scene& scene :
       {scene_of(shapes::teapot(4)), scene_of(shapes::torus_knot(2, 3, 64, 8), placed),
        scene_of(shapes::boxes(1, 1))})
    for (const Size size : kSizes)
      for (const bool orthographic : {false, true})
        for (const float fov : {0.2F, 1.0472F, 1.4F})
          for (const auto& [eye, up] : {std::pair{Vec3{0, 0, 1}, Vec3{0, 1, 0}},
                                        {Vec3{1, 2, 3}, Vec3{0, 1, 0}},
                                        {Vec3{0, 5, 0}, Vec3{1, 0, 1}}}) {
            const Camera view = view_from(eye, up, fov, orthographic);
            const Camera c = fit_picture(SceneBinding(scene).view(), view, size.width, size.height);
            Box b;
            add_projected(b, scene, c, size);
            SCOPED_TRACE(testing::Message() << size.width << "x" << size.height << " ortho "
                                            << orthographic << " fov " << fov);
            expect_filled(b);
            const Vec3 looks = normalize(Vec3(c.eye - c.target)), wants = normalize(eye);
            EXPECT_NEAR(length(looks - wants), 0, 1e-5);
          }
}

TEST(FitPicture, LeavesTheRoomThatIsAskedFor) {
  const Scene scene = scene_of(shapes::teapot(4));
  const SceneBinding binding(scene);
  for (const bool orthographic : {false, true})
    for (const double fill : {0.3, 0.8, 1.0}) {
      const Camera view = view_from({1, 2, 3}, {0, 1, 0}, 1, orthographic);
      Box b;
      add_projected(b, scene, fit_picture(binding.view(), view, 300, 200, {.fill = fill}),
                    {300, 200});
      expect_filled(b, fill);
    }
}

TEST(FitPicture, LooksTheWayOfAMatrix) {
  const Scene scene = scene_of(shapes::teapot(4));
  const SceneBinding binding(scene);
  const double h = std::sqrt(0.5);
  // Looks along +x, rolled by 45°.
  const Mat4d pose = pose_from({0, h, h, 0, -h, h, 1, 0, 0}, {0, 0, 5});
  for (const bool orthographic : {false, true})
    for (const bool turns : {false, true}) {
      Camera view = camera_from_opencv({100, 100, 50, 50}, pose, 100, 100);
      view.orthographic = orthographic;
      const Mat4d wanted = world_to_camera(view);
      const Camera c = fit_picture(binding.view(), view, 300, 200, {.turns = turns});
      EXPECT_FALSE(c.matrix);
      const Mat4d found = world_to_camera(c);
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
          EXPECT_NEAR(found.m[row][column], wanted.m[row][column], 1e-9);
      if (turns) continue;
      Box b;
      add_projected(b, scene, c, {300, 200});
      expect_filled(b);
    }
}

TEST(FitPicture, IsLargerThanTheSphereInAWidePicture) {
  const Scene scene = scene_of(shapes::teapot(4));
  const SceneBinding binding(scene);
  Box tight, sphere;
  constexpr Size kWide{1280, 720};
  const Camera camera = fit_picture(binding.view(), {}, kWide.width, kWide.height);
  add_projected(tight, scene, camera, kWide);
  add_projected(sphere, scene, fit_camera(binding.view(), camera.fov_rad, false), kWide);
  const auto area = [](const Box& b) { return (b.x1 - b.x0) * (b.y1 - b.y0); };
  EXPECT_GT(area(tight), 1.8 * area(sphere));
}

TEST(FitPicture, WideFieldsKeepOffTheNearestVertex) {
  // A spike towards the eye: the nearest eye for its base would be inside of it.
  Mesh spike{.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, 20}},
             .indices = {0, 1, 3, 1, 2, 3, 2, 0, 3}};
  const Scene scene = scene_of(spike);
  const Camera c = fit_picture(SceneBinding(scene).view(), {}, 100, 100);
  const double r = std::sqrt(1.0 + 1 + 100);
  EXPECT_NEAR(c.eye.z, 20 + r / 20, 1e-5);
  EXPECT_NEAR(c.near_plane, 0.99 * r / 20, 1e-5);
}

TEST(FitPicture, DegenerateScenes) {
  Mesh point{.positions = {{5, 6, 7}, {5, 6, 7}, {5, 6, 7}}};
  Mesh line;  // along the view axis
  line.positions = {{0, 0, -3}, {0, 0, 3}, {0, 0, 0}};
  Mesh nothing_finite{
      .positions = {{std::numeric_limits<float>::quiet_NaN(), 0, 0}, {0, 0, 0}, {1, 1, 1}},
      .indices = {0, 0, 0}};
  for (const Scene& scene :
       {Scene{}, scene_of(point), scene_of(line), scene_of(Mesh{}), scene_of(nothing_finite)})
    for (const bool orthographic : {false, true})
      for (const bool turns : {false, true}) {
        const SceneBinding binding(scene);
        const Camera view = view_from({0, 0, 1}, {0, 1, 0}, 1, orthographic);
        const Camera c = fit_picture(binding.view(), view, 160, 90, {.turns = turns});
        EXPECT_NO_THROW(static_cast<void>(world_to_clip(c, 160, 90)));
        EXPECT_TRUE(is_finite(c.eye));
        EXPECT_GT(c.near_plane, 0);
        EXPECT_GT(c.eye.z, c.target.z);
      }
}

TEST(FitPicture, RefusesWhatNoPictureHas) {
  const Scene scene = scene_of(shapes::boxes(1));
  const SceneBinding binding(scene);
  const auto refused = [&](const Camera& view, int width, int height) {
    EXPECT_THROW(static_cast<void>(fit_picture(binding.view(), view, width, height)), Error);
  };
  refused({}, 0, 5);
  for (const double fill : {0.0, -1.0, 1.1, std::nan("")})
    EXPECT_THROW((void)fit_picture(binding.view(), {}, 5, 5, {.fill = fill}), Error);
  refused(view_from({0, 0, 1}, {0, 1, 0}, 0, false), 5, 5);
  refused(view_from({0, 0, 1}, {0, 1, 0}, 4, false), 5, 5);
  refused(view_from({0, 1, 0}, {0, 1, 0}, 1, false), 5, 5);
  Scene broken = scene_of(shapes::boxes(1));
  broken.meshes[0].indices[0] = 99;
  EXPECT_THROW(static_cast<void>(fit_picture(SceneBinding(broken).view(), {}, 5, 5)), Error);
  // Three balls, but radii for two.
  const std::vector<Vec3> centers(3);
  const std::vector<float> radii(2, 1.0F);
  const SpheresView spheres{.centers = centers, .radii = radii};
  const InstanceView ball{spheres};
  SceneView balls{.instances = {&ball, 1}};
  EXPECT_THROW(static_cast<void>(fit_picture(balls, {}, 5, 5)), Error);
}

TEST(FitPicture, OneCameraServesEveryAngle) {
  const Mesh mesh = shapes::teapot(3);
  const Scene still = scene_of(mesh, translation({3, 4, 5}));
  for (const Size size : kSizes)
    for (const bool orthographic : {false, true})
      for (const Vec3 eye : {Vec3{0, 0, 1}, Vec3{0, 1, 2}, Vec3{1, -3, 1}}) {
        const Camera view = view_from(eye, {0, 1, 0}, 1, orthographic);
        const Camera c =
            fit_picture(SceneBinding(still).view(), view, size.width, size.height, {.turns = true});
        Box all;
        constexpr int kAngles = 720;
        for (int i = 0; i < kAngles; ++i) {
          const SinCos a = sin_cos_degrees(360.0 * i / kAngles);
          Mat4d turn = Mat4d::identity();
          turn.m[0][0] = turn.m[2][2] = a.cos;
          turn.m[0][2] = a.sin;
          turn.m[2][0] = -a.sin;
          const Scene turned = scene_of(
              mesh, translation(c.target) * turn * translation(-c.target) * translation({3, 4, 5}));
          add_projected(all, turned, c, size);
        }
        SCOPED_TRACE(testing::Message() << size.width << "x" << size.height << " ortho "
                                        << orthographic << " eye " << eye.x << "," << eye.y);
        // This many angles come close to the sweep of a full turn.
        EXPECT_NEAR(std::max(all.x1, all.y1), kUsual, 2e-3);
        EXPECT_LE(std::max(all.x1, all.y1), kUsual + 2e-5);
        EXPECT_NEAR(all.x0, -all.x1, 2e-3);
        EXPECT_NEAR(all.y0, -all.y1, 2e-3);
        EXPECT_GE(all.z0, 0);
        EXPECT_LT(all.z1, 1);
      }
}

}  // namespace
}  // namespace rastrum::test::fit_test
