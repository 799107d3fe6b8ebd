// SPDX-License-Identifier: BSD-3-Clause
// The parts of the window that need no window: camera control, the choice of the resolution.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "window/mesh_control.hpp"
#include "window/resolution.hpp"

namespace rastrum::test::window_control_test {
namespace {

using namespace cli::window;

constexpr double kPi = std::numbers::pi;

Event down(const char* name) {
  return {.kind = Event::Kind::key_down, .key = name};
}
Event up(const char* name) {
  return {.kind = Event::Kind::key_up, .key = name};
}
Event mouse(Event::Kind kind, double x, double y, Button button = Button::left) {
  return {.kind = kind, .button = button, .x = x, .y = y};
}

double distance(Vec3d a, Vec3d b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

class Control : public testing::Test {
 protected:
  Control() : control({{0, 0, 10}, {0, 0, 0}}, {{0, 0, 0}, 2}, true) { control.resize(400, 200); }
  void hold(const char* name, double seconds, int steps) {
    control.handle(down(name));
    for (int i = 0; i < steps; ++i) control.advance(seconds / steps);
    control.handle(up(name));
  }
  void drag(double dx, double dy, Button button = Button::left) {
    control.handle(mouse(Event::Kind::button_down, 50, 50, button));
    control.handle(mouse(Event::Kind::move, 50 + dx, 50 + dy));
    control.handle(mouse(Event::Kind::button_up, 50 + dx, 50 + dy, button));
  }
  [[nodiscard]] const Camera& camera() const { return control.camera(); }
  MeshControl control;
};

TEST_F(Control, UntouchedIsTheCameraGiven) {
  Camera odd{{0.1F, 0.2F, 0.3F}, {1e-9F, 5, 3}, {0, 2, 0.1F}};
  odd.near_plane = 0.123F;
  MeshControl c(odd, {{0, 0, 0}, 2}, true);
  c.advance(10);
  EXPECT_EQ(c.camera().eye, odd.eye);
  EXPECT_EQ(c.camera().target, odd.target);
  EXPECT_EQ(c.camera().up, odd.up);
  EXPECT_EQ(c.camera().near_plane, odd.near_plane);
}

TEST_F(Control, FlyingDependsOnTimeNotOnFrames) {
  hold("w", 2, 1);
  const Camera once = camera();
  control.go_home();
  hold("w", 2, 1000);
  EXPECT_NEAR(once.eye.z, 8, 1e-5);  // half a radius a second
  EXPECT_NEAR(camera().eye.z, once.eye.z, 1e-5);
  EXPECT_NEAR(once.target.z, -2, 1e-5);
}

TEST_F(Control, EachKeyMovesItsWay) {
  const auto after = [&](const char* name) {
    control.go_home();
    hold(name, 1, 10);
    return camera();
  };
  EXPECT_NEAR(after("s").eye.z, 11, 1e-5);
  EXPECT_NEAR(after("d").eye.x, 1, 1e-5);
  EXPECT_NEAR(after("d").target.x, 1, 1e-5);
  EXPECT_NEAR(after("a").eye.x, -1, 1e-5);
  EXPECT_NEAR(after("e").eye.y, 1, 1e-5);
  EXPECT_NEAR(after("q").eye.y, -1, 1e-5);
  EXPECT_GT(after("right").eye.x, 5);
  EXPECT_LT(after("left").eye.x, -5);
  EXPECT_GT(after("up").eye.y, 5);
  EXPECT_LT(after("down").eye.y, -5);
  EXPECT_NEAR(after("=").eye.z, 5, 1e-4);
  EXPECT_NEAR(after("-").eye.z, 20, 1e-4);
}

TEST_F(Control, OrbitKeepsDistanceAndTarget) {
  drag(100, 0);  // half of the smaller side: a quarter turn
  EXPECT_NEAR(camera().eye.x, -10, 1e-4);
  EXPECT_NEAR(camera().eye.z, 0, 1e-4);
  EXPECT_EQ(camera().target, (Vec3{0, 0, 0}));
  drag(13, 31);
  EXPECT_NEAR(distance(camera().eye, camera().target), 10, 1e-4);
  EXPECT_GT(camera().eye.y, 0);
}

TEST_F(Control, OrbitStopsBeforeThePoles) {
  for (int i = 0; i < 10; ++i) drag(0, 500);
  EXPECT_LT(camera().eye.y, 10);
  EXPECT_NEAR(camera().eye.y, 10, 0.01);
  EXPECT_GT(camera().eye.z, 0);  // does not go over the top
  drag(0, -100);
  EXPECT_NEAR(camera().eye.y, -10 * std::sin(0.01), 1e-3);  // a quarter turn from there
}

TEST_F(Control, LookingTurnsAboutTheEye) {
  drag(-100, 0, Button::right);
  EXPECT_EQ(camera().eye, (Vec3{0, 0, 10}));
  EXPECT_NEAR(camera().target.x, -10 * std::sin(kPi / 4), 1e-4);
}

TEST_F(Control, WhatIsPannedStaysUnderThePointer) {
  drag(30, -20, Button::middle);
  const double unit = 2 * 10 * std::tan(60 / 360.0 * kPi) / 200;
  EXPECT_NEAR(camera().target.x, -30 * unit, 1e-5);
  EXPECT_NEAR(camera().target.y, -20 * unit, 1e-5);
  EXPECT_NEAR(camera().eye.x, camera().target.x, 1e-6);
}

TEST_F(Control, WheelZoomsWithinBounds) {
  Event wheel;
  wheel.kind = Event::Kind::wheel;
  wheel.y = 1;
  control.handle(wheel);
  EXPECT_NEAR(camera().eye.z, 10 / 1.15, 1e-5);
  wheel.y = 1e4;
  control.handle(wheel);
  EXPECT_NEAR(camera().eye.z, 2e-4, 1e-8);
  wheel.y = -1e4;
  control.handle(wheel);
  EXPECT_NEAR(camera().eye.z, 2e4, 1);
}

TEST_F(Control, PlanesFollowUnlessTheyAreGiven) {
  hold("w", 2, 1);
  EXPECT_NEAR(camera().near_plane, 8 - 1.001 * 2, 1e-5);
  Camera given{{0, 0, 10}, {0, 0, 0}};
  given.near_plane = 0.5F;
  MeshControl fixed(given, {{0, 0, 0}, 2}, false);
  fixed.handle(down("w"));
  fixed.advance(1);
  EXPECT_EQ(fixed.camera().near_plane, 0.5F);
  EXPECT_NE(fixed.camera().eye, given.eye);
}

TEST_F(Control, OrthographicZoomsByItsHeight) {
  Camera flat{{0, 0, 10}, {0, 0, 0}};
  flat.orthographic = true;
  flat.orthographic_height = 4;
  flat.far_plane = 20;
  MeshControl c(flat, {{0, 0, 0}, 2}, true);
  c.handle(down("="));
  c.advance(1);
  EXPECT_NEAR(c.camera().orthographic_height, 2, 1e-5);
  EXPECT_EQ(c.camera().eye, flat.eye);
}

TEST_F(Control, MovingIsWhatKeepsMoving) {
  EXPECT_FALSE(control.moving());
  control.handle(down("w"));
  EXPECT_TRUE(control.moving());
  control.handle(up("w"));
  EXPECT_FALSE(control.moving());
  control.handle(mouse(Event::Kind::button_down, 1, 1));
  EXPECT_TRUE(control.moving());
  Event leave;
  control.handle(leave);
  EXPECT_FALSE(control.moving());
  control.handle(down("x"));
  EXPECT_FALSE(control.moving());
}

TEST_F(Control, ShiftIsFasterAndLostFocusLetsGo) {
  control.handle(down("left shift"));
  hold("w", 1, 1);
  EXPECT_NEAR(camera().eye.z, 6, 1e-5);
  control.go_home();
  control.handle(Event{});
  hold("w", 1, 1);
  EXPECT_NEAR(camera().eye.z, 9, 1e-5);
}

TEST_F(Control, EveryChangeIsANewVersion) {
  unsigned long last = control.version();
  const auto changed = [&] { return std::exchange(last, control.version()) != control.version(); };
  hold("w", 1, 1);
  EXPECT_TRUE(changed());
  drag(5, 5);
  EXPECT_TRUE(changed());
  control.advance(1);
  EXPECT_FALSE(changed());
  control.handle(down("home"));
  EXPECT_TRUE(changed());
  EXPECT_EQ(camera().eye, (Vec3{0, 0, 10}));
}

/// Simulates a scene that takes fixed + rate · pixels until the resolution has settled.
std::size_t settled(double target, double fixed, double rate) {
  Resolution r(target);
  const auto cost = [&](std::size_t s) { return fixed + rate * kScales[s] * kScales[s]; };
  r.add(kScales.size() - 1, cost(kScales.size() - 1));
  std::size_t step = 0;
  for (int i = 0; i < 20; ++i) {
    step = r.moving_step();
    r.add(step, cost(step));
  }
  return step;
}

TEST(Resolution, FastScenesAreDrawnInFull) {
  EXPECT_EQ(settled(33, 1, 20), 0U);
  EXPECT_EQ(settled(33, 30, 2), 0U);
}

TEST(Resolution, SlowPixelsAreFewer) {
  // 400 ms a picture: a quarter of the side takes 25 ms, three eighths 56 ms.
  EXPECT_EQ(settled(33, 0.1, 400), 4U);
  EXPECT_EQ(settled(33, 10, 90), 2U);
}

TEST(Resolution, PixelsAreKeptWhereTrianglesCost) {
  // Twenty times the target at any size: the smallest picture would take 500.6 ms.
  EXPECT_EQ(settled(25, 500, 40), 0U);
  EXPECT_EQ(settled(25, 500, 400), 2U);  // half the side takes 600 ms of 506 · 1.25
}

TEST(Resolution, StillPicturesBecomeFull) {
  Resolution r(33);
  r.add(6, 1);
  EXPECT_EQ(r.still_step(6), 0U);
  Resolution slow(33);
  slow.add(6, 60);
  EXPECT_EQ(slow.still_step(6), 4U);
  slow.add(4, 240);
  EXPECT_EQ(slow.still_step(4), 2U);
  slow.add(2, 960);
  EXPECT_EQ(slow.still_step(2), 0U);
}

TEST(Resolution, OneSlowFrameChangesLittle) {
  Resolution r(33);
  r.add(6, 0.5);
  for (int i = 0; i < 5; ++i) r.add(0, 20);
  r.add(0, 40);
  EXPECT_EQ(r.moving_step(), 0U);
  for (int i = 0; i < 5; ++i) r.add(0, 60);
  EXPECT_GT(r.moving_step(), 0U);
}

}  // namespace
}  // namespace rastrum::test::window_control_test
