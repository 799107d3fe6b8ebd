// Several meshes and several passes: balls on a meadow, then 60,000 blades of grass with a program
// of their own. The second pass loads the visibility words of the first, so that the nearer wins.
#include <algorithm>
#include <cstdio>
#include <utility>

#include <rastrum/io/io.hpp>
#include <rastrum/raster/program.hpp>
#include <rastrum/render/render.hpp>
#include <rastrum/scene/shapes/shapes.hpp>

using rastrum::Vec3, rastrum::Vec4;
using rastrum::raster::Draw, rastrum::raster::Fragment, rastrum::raster::VertexOutput;

int main() {
  constexpr std::uint32_t kBlades = 60000;
  rastrum::RenderOptions options;
  options.width = 480;
  options.height = 360;
  options.background = {0.6F, 0.78F, 0.95F, 1};
  rastrum::Camera camera;
  camera.eye = {0, 1.6F, 6};
  camera.target = {0, 0.5F, 0};
  const rastrum::Mat4 to_clip(rastrum::world_to_clip(camera, options.width, options.height));

  rastrum::Mesh balls;  // positions and, as normals, where they are on the unit sphere
  const rastrum::Mesh ball = rastrum::shapes::sphere(24, 48);
  for (const Vec4 place :
       {Vec4{-1.7F, 0.5F, 0, 0.6F}, {0.3F, 1, -1, 1.1F}, {1.8F, 0.3F, 2, 0.4F}}) {
    const auto first = static_cast<std::uint32_t>(balls.positions.size());
    for (const std::uint32_t i : ball.indices) balls.indices.push_back(first + i);
    for (const Vec3 n : ball.positions)
      balls.positions.push_back(n * place.w + Vec3{place.x, place.y, place.z});
    balls.normals.values.insert(balls.normals.values.end(), ball.positions.begin(),
                                ball.positions.end());
  }
  const rastrum::raster::Program first(
      [&](std::uint32_t i) {
        return VertexOutput<Vec3>{transform_point(to_clip, balls.positions[i]),
                                  balls.normals.values[i]};
      },
      [](Vec3 n, const Fragment&) {
        const float light =
            0.2F + 0.8F * std::max(dot(normalize(n), Vec3{0.32F, 0.81F, 0.49F}), 0.0F);
        return Vec4{0.95F * light, 0.55F * light, 0.2F * light, 1};
      });
  const auto blade = [&](std::uint32_t i) {  // left, right, tip
    const auto random = [&](std::uint32_t salt) {
      std::uint32_t h = (i / 3 * 8 + salt) * 0x9e3779b9U;
      h = (h ^ h >> 15) * 0x85ebca6bU;
      return static_cast<float>((h ^ h >> 13) & 0xffffU) / 65536;
    };
    const bool tip = i % 3 == 2;
    const float side = tip ? 0.3F * random(2) - 0.15F : i % 3 == 0 ? -0.012F : 0.012F;
    const Vec3 p{14 * random(0) - 7 + side, tip ? 0.1F + 0.3F * random(3) : 0, 12 * random(1) - 7};
    return VertexOutput<float>{transform_point(to_clip, p),
                               (tip ? 0.75F : 0.2F) + 0.2F * random(4)};
  };
  const rastrum::raster::Program second(blade, [](float green, const Fragment&) {
    return Vec4{0.5F * green, green, 0.15F * green, 1};
  });

  rastrum::Renderer renderer(options);
  rastrum::Image<rastrum::Rgba8> image(options.width, options.height);
  rastrum::Image<std::uint64_t> words(options.width, options.height);
  rastrum::Targets targets;
  targets.color8 = image.view();
  targets.words = words.view();
  Draw draw = first.draw(balls.positions.size(), balls.indices);
  renderer.draw({&draw, 1}, first, first.test(), targets);
  targets.load = true;
  targets.first_id = draw.primitive_count;
  draw = second.draw(std::size_t{3} * kBlades);
  renderer.draw({&draw, 1}, second, second.test(), targets);
  rastrum::io::write_png("grass.png", std::as_const(image).view());
}
