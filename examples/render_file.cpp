// SPDX-License-Identifier: BSD-3-Clause
// Renders a mesh file as `rastrum render FILE -o OUT.png` does.
#include <cstdio>

#include <rastrum/fit.hpp>
#include <rastrum/io.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/render.hpp>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: render_file MESH OUT.png\n");
    return 2;
  }
  try {
    rastrum::Scene scene = rastrum::io::read_scene(argv[1]);
    for (const std::string& w : scene.warnings) std::fprintf(stderr, "warning: %s\n", w.c_str());
    // A mesh without normals is drawn faceted; this makes smooth ones, but for edges beyond 40°.
    for (rastrum::Mesh& mesh : scene.meshes)
      if (mesh.normals.empty())
        mesh.normals = rastrum::crease_normals(mesh.positions, mesh.indices, 40);

    rastrum::FrameOptions frame;
    frame.width = 1280;
    frame.height = 720;
    const rastrum::SceneBinding binding(scene);
    const rastrum::Camera along_z;  // looks along −z, 60° wide
    const rastrum::Camera camera =
        rastrum::fit_picture(binding.view(), along_z, frame.width, frame.height);

    // A Renderer keeps its threads and memory for later frames.
    rastrum::Renderer renderer;
    rastrum::Image<rastrum::Rgba8> image(frame.width, frame.height);
    const rastrum::FrameStats stats =
        renderer.render(binding.view(), camera, frame, {.color8 = image});
    std::printf("%llu triangles, %llu pixels covered, %.2f ms\n",
                static_cast<unsigned long long>(stats.triangles.input),
                static_cast<unsigned long long>(stats.pixels_covered), stats.frame_ms);
    rastrum::io::write_png(argv[2], image);
  } catch (const rastrum::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
