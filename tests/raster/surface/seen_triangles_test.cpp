// SPDX-License-Identifier: BSD-3-Clause
// Blocks of pixels and their visible triangles (surface/, shade/lit_seen-inl.hpp and
// material_seen-inl.hpp): SIMD lanes give the colours of the scalar form, for any ids, numbers of
// triangles and materials in a block, normals and textures.
#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test::seen_triangles_test {
namespace {

constexpr int kSize = 24;

/// Squares of `cell` px over the whole picture, two triangles each, with ids that differ by
/// `apart`; the triangles between are out of sight. Every other square is in the second mesh.
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
    // So few that the last one, at the end of its array, is used often.
    const std::size_t normals = indexed ? 13 : mesh.positions.size();
    for (std::size_t i = 0; i < normals; ++i)
      mesh.normals.values.push_back({number(), number(), number()});
    // Their squares overflow float32, or they are NaN.
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

/// Float and 8-bit colours, drawn separately, because opaque lit colours become 8 bits at once. All
/// ways to draw must agree.
Frame colors_by_all(const RenderOptions& options, const SceneView& scene, const Camera& camera,
                    std::initializer_list<RendererOptions> hows = {{.threads = 1}}) {
  return EveryWay(options, hows).same([&](const RenderOptions& o) {
    Frame by(o.width, o.height, kColor | kColor8);
    Painter painter(o);
    painter.render(scene, camera, {.color = by.color});
    painter.render(scene, camera, {.color8 = by.color8});
    return by;
  });
}
void expect_drawn(const Frame& f) {
  EXPECT_GT(f.color(3, 4).w, 0);
  EXPECT_GT(f.color8(3, 4).a, 0);
}

/// The number of neighbours in a row with different colours.
int differing(const Frame& f) {
  int n = 0;
  for (int i = 1; i < f.color.width(); ++i) n += f.color(i, 9) != f.color(i - 1, 9) ? 1 : 0;
  return n;
}

RenderOptions options(Shader shader, float opacity = 1) {
  return RenderOptions({.width = kSize, .height = kSize, .shader = shader, .opacity = opacity});
}

Mat4d turned() {
  Mat4d place = Mat4d::identity();
  place.m[0][1] = 0.25, place.m[1][0] = -0.5;
  return place;
}

KeptInstances placed(const std::array<Mesh, 2>& meshes, const Mat4d& place) {
  KeptInstances instances{meshes[0].view(), meshes[1].view()};
  for (InstanceView& i : instances) i.object_to_world = place;
  return instances;
}

const Camera kFlat{.matrix = Mat4d::identity()};
/// A camera for which weights are perspective.
Camera deep() {
  Camera camera = kFlat;
  camera.matrix->m[3][2] = 0.5;
  return camera;
}

TEST(SeenTriangles, HaveTheColoursOfTheScalarForm) {
  std::uint64_t seed = 1;
  for (const int cell : {1, 2, 3, 6, 8, 12, 24})
    for (const std::uint32_t apart : {1U, 128U})
      for (const bool indexed : {false, true})
        for (const Mat4d& place : {Mat4d::identity(), turned()}) {
          const std::array<Mesh, 2> meshes = squares(cell, apart, indexed, seed % 3 == 0, seed);
          const auto instances = placed(meshes, place);
          SCOPED_TRACE(testing::Message()
                       << "squares of " << cell << ", ids " << apart << " apart, scene " << seed);
          for (const Shader shader : {Shader::phong, Shader::normal})
            for (const float opacity : {1.0F, 0.5F})
              expect_drawn(
                  colors_by_all(options(shader, opacity), {.instances = instances}, kFlat));
          if (HasFailure()) return;
          ++seed;
        }
}

// Without normals they have their planes' normals, from positions and indices of any type, also if
// one block sees all types.
TEST(SeenTriangles, HaveTheNormalsOfTheirPlanes) {
  for (const int cell : {1, 2, 3, 8}) {
    std::array<Mesh, 2> meshes = squares(cell, 1, false, false, 40 + static_cast<unsigned>(cell));
    for (Mesh& mesh : meshes) mesh.normals = {};
    // A third of the second mesh's triangles have float64 and int64 arrays, a third no indices, a
    // third int16 indices.
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
    std::array<InstanceView, 4> instances = {
        InstanceView{.geometry = narrow}, InstanceView{.geometry = of_doubles},
        InstanceView{.geometry = without_indices}, InstanceView{.geometry = of_shorts}};
    SCOPED_TRACE(cell);
    for (const Mat4d& place : {Mat4d::identity(), turned()})
      for (const float opacity : {1.0F, 0.5F}) {
        for (InstanceView& i : instances) i.object_to_world = place;
        expect_drawn(
            colors_by_all(options(Shader::phong, opacity), {.instances = instances}, kFlat));
      }
  }
}

/// Triangles of few pixels, `apart` px from each other, over most of a picture. In front are long
/// ones, too thin for float32 weights.
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
  constexpr int kWidth = 150, kHeight = 90;  // the picture cuts bins
  std::uint64_t seed = 1;
  int different = 0;
  for (const bool colored : {false, true})
    for (const Shader shader : {Shader::flat, Shader::normal, Shader::lambert, Shader::phong})
      for (const bool lit : {false, true}) {
        // At 1 px apart, a bin sees more triangles than are set up at once.
        const Mesh mesh = crumbs(kWidth, kHeight, lit ? 1 : 2, colored, ++seed);
        const OneInstance instance(mesh.view());
        RenderOptions o({.width = kWidth,
                         .height = kHeight,
                         .shader = shader,
                         .background = {0.25F, 0.5F, 0.75F, 1}});
        if (lit)
          o.lights = {{PointLight{{0.5, 0.25, 2}}, {1, 0.5F, 0.25F}, 3},
                      {DirectionalLight{{0, -1, -1}}}};
        SCOPED_TRACE(testing::Message() << "scene " << seed);
        different +=
            differing(colors_by_all(o, instance.view(), deep(), {{.threads = 1}, {.threads = 3}}));
        if (HasFailure()) return;
      }
  EXPECT_GT(different, 500);
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
  int different = 0;
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
            // In every other scene the second mesh has none.
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
          const auto instances = placed(meshes, seed % 4 == 1 ? turned() : Mat4d::identity());
          SCOPED_TRACE(testing::Message()
                       << "squares of " << cell << ", ids " << apart << " apart, scene " << seed);
          different += differing(colors_by_all(
              options(Shader::material),
              {.instances = instances, .materials = materials, .textures = textures}, deep()));
          if (HasFailure()) return;
          ++seed;
        }
  EXPECT_GT(different, 200);
}

}  // namespace
}  // namespace rastrum::test::seen_triangles_test
