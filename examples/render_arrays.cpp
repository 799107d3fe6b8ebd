// Renders arrays that the program owns, here a wave over a grid that moves from frame to frame, and
// reads the depth and the triangle under a pixel besides the colour. Nothing is copied: the scene
// borrows positions, indices and colours, and the images are the caller's too.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>

int main() {
  const std::uint32_t n = 200;  // quads a side
  std::vector<rastrum::Vec3> positions((n + 1) * (n + 1));
  std::vector<rastrum::Vec4> colors(positions.size());
  std::vector<std::uint32_t> indices;
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      indices.insert(indices.end(), {a, c, b, b, c, d});
    }

  rastrum::Camera camera;
  camera.eye = {0, 1.2F, 2};
  rastrum::FrameOptions options;
  options.width = options.height = 512;
  rastrum::Renderer renderer;
  rastrum::Image<rastrum::Rgba8> image(512, 512);
  rastrum::Image<float> depth(512, 512);
  rastrum::Image<std::int64_t> ids(512, 512);

  for (int frame = 0; frame < 3; ++frame) {
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
      const float x = static_cast<float>(i % (n + 1)) / n * 2 - 1;
      const float z = static_cast<float>(i / (n + 1)) / n * 2 - 1;
      const float wave = std::sin(12 * std::hypot(x, z) - static_cast<float>(frame));
      positions[i] = {x, 0.08F * wave, z};
      colors[i] = {0.5F + 0.4F * wave, 0.6F, 0.9F, 1};
    }
    const std::vector<rastrum::Vec3> normals = rastrum::vertex_normals(positions, indices);
    rastrum::MeshView mesh;
    mesh.positions = positions;
    mesh.indices = indices;
    mesh.normals.values = normals;
    mesh.colors.values = colors;
    const rastrum::InstanceView instance{mesh};
    rastrum::SceneView scene;
    scene.instances = {&instance, 1};
    const rastrum::FrameStats stats =
        renderer.render(scene, camera, options, {.color8 = image, .depth = depth, .ids = ids});
    std::printf("frame %d: %.2f ms; in the middle triangle %lld at depth %.5f\n", frame,
                stats.frame_ms, static_cast<long long>(ids(256, 256)), depth(256, 256));
    rastrum::io::write_png("wave" + std::to_string(frame) + ".png", image);
  }
}
