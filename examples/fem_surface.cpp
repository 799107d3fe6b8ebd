// SPDX-License-Identifier: BSD-3-Clause
// A result of finite elements: the stress around a hole in the wall of a pipe, with isolines, the
// elements' edges and a colour bar. The solver's arrays are drawn in place.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <vector>

#include <rastrum/annotate.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/io.hpp>

int main() {
  constexpr int kAround = 96, kOutward = 16;  // elements
  constexpr double kPipe = 3;                 // its radius; the hole's is 1
  std::vector<double> nodes, stress;          // three numbers per node, and one
  std::vector<std::int64_t> elements;         // four nodes each
  for (int j = 0; j <= kOutward; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround, part = double(j) / kOutward;
      const double c = std::cos(angle), s = std::sin(angle);
      const double edge = 4.5 / std::max(std::abs(c), std::abs(s));  // the elements end in a square
      const double r = 1 + (edge - 1) * part * part, x = r * c, y = r * s / kPipe;
      nodes.insert(nodes.end(), {x, kPipe * std::sin(y), kPipe * std::cos(y)});
      // Kirsch's solution for a plate that is pulled along x by 100 MPa.
      const double q = 1 / (r * r), cos2 = c * c - s * s, sin2 = 2 * s * c;
      const double radial = 50 * (1 - q + (1 - 4 * q + 3 * q * q) * cos2);
      const double hoop = 50 * (1 + q - (1 + 3 * q * q) * cos2);
      const double shear = -50 * (1 + 2 * q - 3 * q * q) * sin2;
      stress.push_back(
          std::sqrt(radial * radial - radial * hoop + hoop * hoop + 3 * shear * shear));
      if (j == kOutward) continue;
      const std::int64_t a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      elements.insert(elements.end(), {a, a + kAround, b + kAround, b});
    }

  const rastrum::MeshView mesh{.positions = nodes,
                               .indices = elements,
                               .faces = {rastrum::FaceKind::quads},
                               .scalars = {stress}};
  const rastrum::InstanceView instance{mesh};
  const rastrum::ScalarMapping colors{.map = rastrum::color_map("turbo"),
                                      .isolines = {50, 100, 150, 200, 250}};
  const rastrum::SceneView scene{.instances = {&instance, 1}, .scalar_mappings = {&colors, 1}};

  const rastrum::FrameOptions frame{
      .width = 640, .height = 400, .background = {1, 1, 1, 1}, .samples = 4};
  const rastrum::Annotations annotations{.edges = rastrum::EdgeLines{.width_px = 0.5},
                                         .bar = rastrum::BarWords{"von Mises", "MPa"}};
  const rastrum::Camera view{.eye = {-1, 1.6, 4}, .fov_rad = 0.6F};
  rastrum::Camera camera = rastrum::fit_picture(scene, view, frame.width, frame.height);
  camera = rastrum::with_room(annotations, camera, scene, frame.width, frame.height);
  rastrum::Renderer renderer;
  rastrum::Image<rastrum::Rgba8> picture(frame.width, frame.height);
  rastrum::Annotator().render(renderer, scene, camera, frame, annotations, {.color8 = picture});
  rastrum::io::write_png("fem_surface.png", picture);
  std::printf("up to %.1f MPa\n", rastrum::scalar_colors(scene).range().high);
}
