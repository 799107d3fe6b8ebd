// Blocks of pixels and the triangles that they see (shade/lit_seen-inl.hpp and
// material_seen-inl.hpp): lanes give the colours of the scalar form, whatever the ids, however many
// triangles and materials a block sees, and whatever their normals and textures are.
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
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

template <class Color = Vec4>
Image<Color> draw(const std::array<Mesh, 2>& meshes, const Mat4d& object_to_world,
                  RenderOptions options, std::span<const Material> materials = {},
                  std::span<const Texture> textures = {}) {
  options.width = options.height = kSize;
  options.threads = 1;
  Camera camera{.matrix = Mat4d::identity()};
  if (!materials.empty()) camera.matrix->m[3][2] = 0.5;  // so that weights are perspective
  const std::array<InstanceView, 2> instances = {
      InstanceView{.geometry = meshes[0].view(), .object_to_world = object_to_world},
      InstanceView{.geometry = meshes[1].view(), .object_to_world = object_to_world}};
  Image<Color> color(kSize, kSize);
  Targets targets;
  if constexpr (std::is_same_v<Color, Vec4>)
    targets.color = color;
  else
    targets.color8 = color;
  Painter(options).render({.instances = instances, .materials = materials, .textures = textures},
                          camera, targets);
  return color;
}

template <class Color>
void expect_equal(const Image<Color>& got, const Image<Color>& expected, const std::string& of) {
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      ASSERT_TRUE(got(x, y) == expected(x, y)) << "pixel " << x << ", " << y << " of " << of;
}

TEST(SeenTriangles, HaveTheColoursOfTheScalarForm) {
  std::uint64_t seed = 1;
  for (const int cell : {1, 2, 3, 6, 8, 12, 24})
    for (const std::uint32_t apart : {1U, 128U})
      for (const bool indexed : {false, true})
        for (const bool turned : {false, true}) {
          const std::array<Mesh, 2> meshes = squares(cell, apart, indexed, seed % 3 == 0, seed);
          Mat4d place = Mat4d::identity();
          if (turned) place.m[0][1] = 0.25, place.m[1][0] = -0.5;
          for (const Shader shader : {Shader::phong, Shader::normal})
            for (const float opacity : {1.0F, 0.5F}) {
              RenderOptions options({.shader = shader, .opacity = opacity}, {.isa = Isa::scalar});
              const Image<Vec4> expected = draw(meshes, place, options);
              const auto expected8 = draw<Rgba8>(meshes, place, options);
              EXPECT_GT(expected(3, 4).w, 0);
              EXPECT_GT(expected8(3, 4).a, 0);
              for (const Isa isa : available_isas()) {
                options.isa = isa;
                const std::string of = "squares of " + std::to_string(cell) + ", ids " +
                                       std::to_string(apart) + " apart, scene " +
                                       std::to_string(seed);
                expect_equal(draw(meshes, place, options), expected, of);
                // Opaque colours become 8 bits where they are lit.
                expect_equal(draw<Rgba8>(meshes, place, options), expected8, of + ", 8 bits");
              }
            }
          ++seed;
        }
}

// Without normals they have those of their planes, from positions and indices of whatever type,
// also where one block sees all of these.
TEST(SeenTriangles, HaveTheNormalsOfTheirPlanes) {
  for (const int cell : {1, 2, 3, 8}) {
    std::array<Mesh, 2> meshes = squares(cell, 1, false, false, 40 + static_cast<unsigned>(cell));
    for (Mesh& mesh : meshes) mesh.normals = {};
    // One third of the second mesh's triangles have float64 and int64 arrays, one third have no
    // indices, one third have int16 indices.
    MeshView narrow = meshes[0].view();
    std::vector<double> wide;
    for (const Vec3 p : meshes[1].positions) wide.insert(wide.end(), {p.x, p.y, p.z, -9});
    std::vector<std::int64_t> wide_indices;
    std::vector<std::int16_t> short_indices;
    std::vector<Vec3> in_order;
    for (std::size_t i = 0; i < meshes[1].indices.size(); ++i) {
      const std::uint32_t index = meshes[1].indices[i];
      if (i / 3 % 3 == 0)
        wide_indices.push_back(index);
      else if (i / 3 % 3 == 1)
        in_order.push_back(meshes[1].positions[index]);
      else
        short_indices.push_back(static_cast<std::int16_t>(index));
    }
    MeshView of_doubles, without_indices, of_shorts;
    of_doubles.positions = ArrayView<Vec3>::of(wide.data(), wide.size() / 4, 4 * sizeof(double));
    of_doubles.indices = wide_indices;
    without_indices.positions = in_order;
    of_shorts.positions = meshes[1].positions;
    of_shorts.indices = short_indices;
    Mat4d turned = Mat4d::identity();
    turned.m[0][1] = 0.25, turned.m[1][0] = -0.5;
    const std::array<InstanceView, 4> instances = {
        InstanceView{.geometry = narrow}, InstanceView{.geometry = of_doubles},
        InstanceView{.geometry = without_indices}, InstanceView{.geometry = of_shorts}};
    for (const Mat4d& place : {Mat4d::identity(), turned})
      for (const float opacity : {1.0F, 0.5F}) {
        RenderOptions options(
            {.width = kSize, .height = kSize, .shader = Shader::phong, .opacity = opacity},
            {.threads = 1});
        auto placed = instances;
        for (InstanceView& i : placed) i.object_to_world = place;
        Camera camera{.matrix = Mat4d::identity()};
        const auto draw_by = [&](Isa isa) {
          options.isa = isa;
          Image<Vec4> color(kSize, kSize);
          Painter(options).render({.instances = placed}, camera, {.color = color});
          return color;
        };
        const Image<Vec4> expected = draw_by(Isa::scalar);
        EXPECT_GT(expected(3, 4).w, 0);
        for (const Isa isa : available_isas())
          expect_equal(draw_by(isa), expected, "planes of squares of " + std::to_string(cell));
      }
  }
}

/// Triangles of few pixels over most of a picture, `apart` px from one another, and long ones
/// before them, so thin that float32 is too little for their weights.
Mesh crumbs(int width, int height, int apart, bool colored, std::uint64_t seed) {
  Random random(seed);
  const auto number = [&](double a, double b) { return static_cast<float>(random.real(a, b)); };
  Mesh mesh;
  const auto corner = [&](float x, float y, float z) {
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(
        {x * 2 / static_cast<float>(width) - 1, 1 - y * 2 / static_cast<float>(height), z});
    mesh.normals.values.push_back({number(-1, 1), number(-1, 1), number(0.1, 1)});
    if (colored) mesh.colors.values.push_back({number(0, 1), number(0, 1), number(0, 1), 1});
  };
  for (int y = 0; y < height; y += apart)
    for (int x = 0; x < width - 20; x += apart) {
      const auto left = static_cast<float>(x), top = static_cast<float>(y);
      for (int c = 0; c < 3; ++c)
        corner(left + number(-2, 4), top + number(-2, 4), number(0.1, 0.4));
    }
  for (int i = 0; i < 40; ++i) {
    const float y = number(0, height - 5);
    corner(0, y, 0.5F);
    corner(static_cast<float>(width), y + 4, 0.5F);
    corner(static_cast<float>(width), y + 4.5F, 0.45F);
  }
  return mesh;
}

TEST(SeenTriangles, OfABinHaveTheColoursOfTheScalarForm) {
  constexpr int kWidth = 150, kHeight = 90;  // bins that the picture cuts
  Camera camera{.matrix = Mat4d::identity()};
  camera.matrix->m[3][2] = 0.5;
  struct Picture {
    Image<Vec4> color{kWidth, kHeight};
    Image<Rgba8> color8{kWidth, kHeight};
  };
  std::uint64_t seed = 1;
  int differing = 0;
  for (const bool colored : {false, true})
    for (const Shader shader : {Shader::flat, Shader::normal, Shader::lambert, Shader::phong})
      for (const bool lit : {false, true}) {
        // 1 px apart a bin sees more triangles than are set up at once.
        const Mesh mesh = crumbs(kWidth, kHeight, lit ? 1 : 2, colored, ++seed);
        const InstanceView instance{.geometry = mesh.view()};
        RenderOptions options({.width = kWidth,
                               .height = kHeight,
                               .shader = shader,
                               .background = {0.25F, 0.5F, 0.75F, 1}});
        if (lit)
          options.lights = {{PointLight{{0.5, 0.25, 2}}, {1, 0.5F, 0.25F}, 3},
                            {DirectionalLight{{0, -1, -1}}}};
        const auto draw_by = [&](Isa isa, int threads) {
          options.isa = isa;
          options.threads = threads;
          Picture p;
          Painter painter(options);
          painter.render({.instances = {&instance, 1}}, camera, {.color = p.color});
          painter.render({.instances = {&instance, 1}}, camera, {.color8 = p.color8});
          return p;
        };
        const Picture expected = draw_by(Isa::scalar, 1);
        for (int i = 1; i < kWidth; ++i)
          differing += expected.color(i, 9) != expected.color(i - 1, 9) ? 1 : 0;
        for (const Isa isa : available_isas())
          for (const int threads : {1, 3}) {
            const Picture got = draw_by(isa, threads);
            for (int y = 0; y < kHeight; ++y)
              for (int x = 0; x < kWidth; ++x) {
                ASSERT_EQ(got.color(x, y), expected.color(x, y))
                    << x << ", " << y << " of scene " << seed << ", " << name(isa);
                ASSERT_EQ(got.color8(x, y), expected.color8(x, y))
                    << x << ", " << y << " of scene " << seed << ", " << name(isa);
              }
          }
      }
  EXPECT_GT(differing, 500);
}

/// Textures with all wrappings and filters, and sides of 1 to 40 texels.
std::vector<Texture> some_textures(Random& random) {
  std::vector<Texture> textures(9);
  for (std::size_t i = 0; i < textures.size(); ++i) {
    Texture& t = textures[i];
    t.image = Image<Rgba8>(i == 0 ? 1 : random.integer(2, 40), random.integer(1, 40));
    for (int y = 0; y < t.image.height(); ++y)
      for (int x = 0; x < t.image.width(); ++x) {
        const auto code = [&] { return static_cast<std::uint8_t>(random.integer(0, 255)); };
        t.image(x, y) = {code(), code(), code(), code()};
      }
    t.wrap_u = static_cast<Wrap>(i % 3);
    t.wrap_v = static_cast<Wrap>(i / 3);
    t.mipmaps = i != 4;
    if (i == 5) t.mag = TextureFilter::nearest;
    if (i == 7) t.min = TextureFilter::nearest;
  }
  return textures;
}

std::vector<Material> some_materials(Random& random, int textures) {
  std::vector<Material> materials(7);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    Material& m = materials[i];
    const auto number = [&] { return static_cast<float>(random.real(0, 1)); };
    const auto texture = [&](double chance) {
      return random.chance(chance) ? random.integer(0, textures - 1) : kNoTexture;
    };
    m.base_color = {number(), number(), number(), 1};
    m.metallic = number();
    m.roughness = number();
    m.emissive = {number(), 0, number()};
    m.double_sided = true;
    m.unlit = i == 3;
    if (i == 0) continue;  // without any
    m.base_color_texture = texture(0.8);
    m.metallic_roughness_texture = texture(0.5);
    m.normal_texture = texture(0.5);
    m.normal_scale = number() * 2;
    m.occlusion_texture = texture(0.5);
    m.occlusion_strength = number();
    m.emissive_texture = texture(0.5);
  }
  return materials;
}

TEST(SeenTriangles, HaveTheMaterialsOfTheScalarForm) {
  std::uint64_t seed = 100;
  int differing = 0;
  for (const int cell : {1, 3, 8, 24})
    for (const std::uint32_t apart : {1U, 128U})
      for (const bool indexed : {false, true})
        for (const bool smooth : {false, true}) {
          std::array<Mesh, 2> meshes = squares(cell, apart, indexed, seed % 3 == 0, seed);
          Random random(seed);
          const std::vector<Texture> textures = some_textures(random);
          const std::vector<Material> materials =
              some_materials(random, static_cast<int>(textures.size()));
          for (Mesh& mesh : meshes) {
            const auto coordinate = [&] { return static_cast<float>(random.real(-2, 3)); };
            const std::size_t count = indexed ? 29 : mesh.positions.size();
            // The second mesh has none in every other scene.
            if (&mesh == &meshes[0] || seed % 2 == 0)
              for (std::size_t i = 0; i < count; ++i)
                mesh.texcoords.values.push_back({coordinate(), coordinate()});
            if (indexed && !mesh.texcoords.values.empty())
              for (std::size_t i = 0; i < mesh.indices.size(); ++i)
                mesh.texcoords.indices.push_back(
                    static_cast<std::uint32_t>(random.integer(0, static_cast<int>(count) - 1)));
            if (!smooth) mesh.normals = {};
            for (std::size_t i = 0; i < mesh.indices.size() / 3; ++i)
              mesh.face_materials.push_back(static_cast<std::uint32_t>(
                  random.integer(0, static_cast<int>(materials.size()) - 1)));
          }
          Mat4d place = Mat4d::identity();
          if (seed % 4 == 1) place.m[0][1] = 0.25, place.m[1][0] = -0.5;
          RenderOptions options({.shader = Shader::material}, {.isa = Isa::scalar});
          const Image<Vec4> expected = draw(meshes, place, options, materials, textures);
          for (int i = 1; i < kSize; ++i) differing += expected(i, 9) != expected(i - 1, 9) ? 1 : 0;
          for (const Isa isa : available_isas()) {
            options.isa = isa;
            ASSERT_NO_FATAL_FAILURE(
                expect_equal(draw(meshes, place, options, materials, textures), expected,
                             "squares of " + std::to_string(cell) + ", ids " +
                                 std::to_string(apart) + " apart, scene " + std::to_string(seed)));
          }
          ++seed;
        }
  EXPECT_GT(differing, 200);
}

}  // namespace
}  // namespace rastrum::test::seen_triangles_test
