// Blocks of pixels and the triangles that they see (shade/lit_seen-inl.hpp): lanes give the colours
// of the scalar form, whatever the ids, however many triangles a block sees, and whatever their
// normals are.
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/painter.hpp"
#include "tests/support/random.hpp"

namespace rastrum::test::seen_triangles_test {
namespace {

constexpr int kSize = 24;

/// Squares of `cell` px over the whole picture, two triangles each, whose ids are `apart` from one
/// another: what lies between them is nowhere. Every other square is in the second mesh.
std::array<Mesh, 2> squares(int cell, std::uint32_t apart, bool indexed, bool colored,
                            std::uint64_t seed) {
  Random random(seed);
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random.integer(0, static_cast<int>(n) - 1));
  };
  const auto number = [&] { return static_cast<float>(random.real(-1, 1)); };
  std::array<Mesh, 2> meshes;
  for (std::uint32_t m = 0; m < meshes.size(); ++m) {
    Mesh& mesh = meshes[m];
    mesh.positions.push_back({0, 0, -1});
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (int y = 0; y < kSize; y += cell)
      for (int x = 0; x < kSize; x += cell) {
        if (cell < kSize && static_cast<std::uint32_t>((x + y) / cell % 2) != m) continue;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int corner = 0; corner < 4; ++corner)
          mesh.positions.push_back({static_cast<float>(x + corner % 2 * cell) * 2 / kSize - 1,
                                    1 - static_cast<float>(y + corner / 2 * cell) * 2 / kSize,
                                    0.25F + number() * 0.2F});
        triangles.push_back({first, first + 2, first + 1});
        triangles.push_back({first + 1, first + 2, first + 3});
      }
    for (std::size_t i = triangles.size(); i > 1; --i)
      std::swap(triangles[i - 1], triangles[below(i)]);
    for (const auto& t : triangles) {
      mesh.indices.insert(mesh.indices.end(), t.begin(), t.end());
      mesh.indices.resize(mesh.indices.size() + std::size_t{3} * (apart - 1), 0);
    }
    // Few, so that the last one, which lies at the end of its array, is met often.
    const std::size_t normals = indexed ? 13 : mesh.positions.size();
    for (std::size_t i = 0; i < normals; ++i)
      mesh.normals.values.push_back({number(), number(), number()});
    // Their squares are no float32, or they are no numbers.
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    for (const Vec3 n : {Vec3{0, 1e-20F, 2e-20F}, Vec3{1e30F, -2e30F, 3e30F}, Vec3{0, 0, 0},
                         Vec3{kInfinity, 1, 1}, Vec3{1, kNaN, 1}})
      mesh.normals.values[below(normals - 1)] = n;
    if (indexed)
      for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        mesh.normals.indices.push_back(static_cast<std::uint32_t>(below(normals)));
    if (colored)
      for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.colors.values.push_back({number() + 1, number() + 1, number() + 1, 1});
  }
  return meshes;
}

Image<Vec4> draw(const std::array<Mesh, 2>& meshes, const Mat4d& object_to_world,
                 RenderOptions options) {
  options.width = options.height = kSize;
  options.threads = 1;
  Camera camera;
  camera.matrix = Mat4d::identity();
  const std::array<InstanceView, 2> instances = {
      InstanceView{.geometry = meshes[0].view(), .object_to_world = object_to_world},
      InstanceView{.geometry = meshes[1].view(), .object_to_world = object_to_world}};
  Image<Vec4> color(kSize, kSize);
  Painter(options).render({.instances = instances}, camera, {.color = color});
  return color;
}

TEST(SeenTriangles, HaveTheColoursOfTheScalarForm) {
  std::uint64_t seed = 1;
  for (const int cell : {1, 2, 3, 8, 24})
    for (const std::uint32_t apart : {1U, 128U})
      for (const bool indexed : {false, true})
        for (const bool turned : {false, true}) {
          const std::array<Mesh, 2> meshes = squares(cell, apart, indexed, seed % 3 == 0, seed);
          Mat4d place = Mat4d::identity();
          if (turned) place.m[0][1] = 0.25, place.m[1][0] = -0.5;
          for (const Shader shader : {Shader::phong, Shader::normal})
            for (const float opacity : {1.0F, 0.5F}) {
              RenderOptions options;
              options.shader = shader;
              options.opacity = opacity;
              options.isa = Isa::scalar;
              const Image<Vec4> expected = draw(meshes, place, options);
              EXPECT_GT(expected(3, 4).w, 0);
              for (const Isa isa : available_isas()) {
                options.isa = isa;
                const Image<Vec4> got = draw(meshes, place, options);
                for (int y = 0; y < kSize; ++y)
                  for (int x = 0; x < kSize; ++x)
                    ASSERT_EQ(got(x, y), expected(x, y))
                        << "pixel " << x << ", " << y << ", squares of " << cell << ", ids "
                        << apart << " apart, scene " << seed;
              }
            }
          ++seed;
        }
}

}  // namespace
}  // namespace rastrum::test::seen_triangles_test
