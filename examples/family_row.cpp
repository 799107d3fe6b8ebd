// SPDX-License-Identifier: BSD-3-Clause
// Draws by the rows of the papers' table: ways to find what triangles cover, and ways to resolve a
// pixel. Each row draws the same picture as a plain renderer and prints its time.
#include <cstdio>

#include <rastrum/digest.hpp>
#include <rastrum/family.hpp>
#include <rastrum/io.hpp>
#include <rastrum/shapes.hpp>

int main() {
  const rastrum::Mesh mesh = rastrum::shapes::gyroid(64, 3);
  const rastrum::MeshView view = mesh.view();
  const rastrum::InstanceView instance{view};
  const rastrum::SceneView scene{.instances = {&instance, 1}};
  const rastrum::Camera camera{.eye = {2, 1.5, 3}};
  const rastrum::FrameOptions frame{.width = 480, .height = 360, .background = {1, 1, 1, 1}};
  const rastrum::Image<rastrum::Rgba8> plain = rastrum::render(scene, camera, frame);
  rastrum::io::write_png("family_row.png", plain);

  bool same = true;
  rastrum::Image<rastrum::Rgba8> picture(frame.width, frame.height);
  for (const rastrum::family::AxisInfo& rasterizer : rastrum::family::rasterizer_axis())
    for (const rastrum::family::AxisInfo& visibility : rastrum::family::visibility_axis()) {
      rastrum::Renderer renderer = rastrum::family::make_renderer(
          {}, {.rasterizer = rasterizer.name, .visibility = visibility.name});
      const rastrum::FrameStats stats = renderer.render(scene, camera, frame, {.color8 = picture});
      std::printf("%-10s %-10s %7.2f ms\n", rasterizer.name.c_str(), visibility.name.c_str(),
                  stats.frame_ms);
      same = same && rastrum::digest(picture) == rastrum::digest(plain);
    }
  std::puts(same ? "all pictures are the same" : "pictures differ");
  return same ? 0 : 1;
}
