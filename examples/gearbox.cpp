// A planetary gear, made here, twice: as a section, where a clip plane of its own opens the housing
// and nothing else, and as a translucent assembly, whose layers are blended in their exact order.
#include <cmath>
#include <deque>
#include <functional>
#include <numbers>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/transform.hpp>

using rastrum::Mat4d, rastrum::Mesh, rastrum::Vec3, rastrum::Vec4;

constexpr double kPi = std::numbers::pi, kModule = 0.05;
constexpr int kSun = 16, kPlanet = 14, kRing = kSun + 2 * kPlanet;  // teeth

using Radius = std::function<double(double angle)>;

/// The solid between two outlines about the z axis, from −thickness / 2 to thickness / 2.
Mesh extruded(const Radius& inner, const Radius& outer, double thickness, int steps = 720) {
  Mesh mesh;
  for (int i = 0; i < steps; ++i) {
    const double angle = 2 * kPi * i / steps;
    for (const double r : {outer(angle), inner(angle)})
      for (const double z : {-thickness / 2, thickness / 2})
        mesh.positions.push_back(Vec3(rastrum::Vec3d{r * std::cos(angle), r * std::sin(angle), z}));
  }
  const auto quad = [&](int a, int b, int c, int d) {
    for (const int k : {a, b, c, a, c, d}) mesh.indices.push_back(static_cast<std::uint32_t>(k));
  };
  for (int i = 0; i < steps; ++i) {
    const int a = 4 * i, b = 4 * ((i + 1) % steps);
    quad(a, b, b + 1, a + 1);          // outside
    quad(b + 2, a + 2, a + 3, b + 3);  // inside
    quad(a + 1, b + 1, b + 3, a + 3);  // above
    quad(b, a, a + 2, b + 2);          // below
  }
  mesh.normals = rastrum::crease_normals(mesh.positions, mesh.indices, 35);
  return mesh;
}

Radius circle(double radius) {
  return [radius](double) { return radius; };
}
/// A tooth at angle 0.
Radius gear(int teeth) {
  return [teeth](double angle) {
    const double wave = std::cos(teeth * angle) * 2;
    return kModule * (teeth / 2.0 + 0.9 * (wave < -1 ? -1 : wave > 1 ? 1 : wave));
  };
}

int main() {
  const double center = kModule * (kSun + kPlanet) / 2, ring = kModule * kRing / 2;
  const Mesh sun = extruded(circle(0.12), gear(kSun), 0.5);
  const Mesh planet = extruded(circle(0.1), gear(kPlanet), 0.45);
  const Mesh annulus = extruded(gear(kRing), circle(ring + 0.14), 0.5);
  const Mesh shaft = extruded(circle(0.0001), circle(0.119), 2.6);
  const Mesh pin = extruded(circle(0.0001), circle(0.099), 0.8);
  const Mesh carrier = extruded(circle(0.121), circle(center + 0.16), 0.08);
  const Mesh housing = extruded(circle(ring + 0.15), circle(ring + 0.2), 1.5);
  const Mesh lid = extruded(circle(0.16), circle(ring + 0.15), 0.06);

  std::vector<rastrum::InstanceView> parts;
  std::deque<rastrum::MeshView> views;  // parts refer to them
  const auto add = [&](const Mesh& mesh, const Mat4d& place, Vec3 color, float opacity) {
    rastrum::InstanceView& part = parts.emplace_back();
    part.geometry = views.emplace_back(mesh.view());
    part.object_to_world = place;
    part.color = Vec4{color.x, color.y, color.z, 1};
    part.opacity = opacity;
  };
  const auto turn = [](double angle) {
    return rastrum::rotation(rastrum::rotation_about({0, 0, 1}, angle));
  };
  const auto along = [](double z) { return rastrum::translation({0, 0, z}); };
  constexpr Vec3 kSteel{0.62F, 0.66F, 0.72F}, kBrass{0.86F, 0.66F, 0.3F}, kRed{0.8F, 0.3F, 0.24F};
  constexpr Vec3 kBlue{0.3F, 0.5F, 0.78F}, kDark{0.4F, 0.43F, 0.48F};
  add(sun, turn(0), kRed, 1);
  add(shaft, along(0.5), kSteel, 1);
  for (int i = 0; i < 3; ++i) {
    const double at = 2 * kPi * i / 3;
    const Mat4d place = rastrum::translation({center * std::cos(at), center * std::sin(at), 0});
    // It has rolled around the sun, a gap to the sun's tooth.
    add(planet, place * turn(at * (1 + double(kSun) / kPlanet) + kPi + kPi / kPlanet), kBrass,
        0.55F);
    add(pin, place * along(-0.1), kDark, 1);
  }
  add(carrier, along(-0.4), kDark, 0.5F);
  add(annulus, turn(0), kBlue, 0.35F);
  const std::size_t shell = parts.size();
  add(housing, along(0), kSteel, 0.18F);
  add(lid, along(0.72), kSteel, 0.18F);
  add(lid, along(-0.72), kSteel, 0.18F);

  rastrum::Camera camera;
  camera.eye = {2.7, 1.9, 3.3};
  camera.target = {0, -0.05, 0.12};
  camera.fov_rad = 0.7F;
  camera.near_plane = 0.5F;
  rastrum::FrameOptions frame;
  frame.width = 520;
  frame.height = 480;
  frame.samples = 8;
  frame.background = {1, 1, 1, 1};
  rastrum::Renderer renderer;
  rastrum::Image<rastrum::Rgba8> picture(frame.width, frame.height);
  renderer.render({.instances = parts}, camera, frame, {.color8 = picture});
  rastrum::io::write_png("gearbox.png", picture);

  const rastrum::ClipPlane open{{-0.75, -0.1, -0.65}, 0.1};  // keeps what is farther away
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].opacity = 1;
    if (i >= shell) parts[i].clip_planes = {&open, 1};
  }
  renderer.render({.instances = parts}, camera, frame, {.color8 = picture});
  rastrum::io::write_png("section.png", picture);
}
