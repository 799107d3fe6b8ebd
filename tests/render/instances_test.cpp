// SPDX-License-Identifier: BSD-3-Clause
// Instances with a look of their own: opacity, colour, material, visibility and winding give the
// same bits as on the mesh or the frame, in every shader, with layers and on the reference. Many
// instances of a small mesh store no vertices.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/array_layouts.hpp"
#include "tests/support/frame.hpp"
#include "tests/support/pixels.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::instances_test {
namespace {

constexpr int kW = 120, kH = 90;

constexpr unsigned kKinds = kColor | kVisible;

/// Two sheets, one in front of the other.
struct TwoSheets {
  Sheet sheet{9};
  std::vector<Material> materials;
  MeshView meshes[2] = {sheet.view(), sheet.view()};
  InstanceView instances[2] = {{meshes[0]}, {meshes[1]}};

  explicit TwoSheets(bool with_materials) {
    if (with_materials) {
      materials.resize(3);
      for (Material& m : materials) m.double_sided = true;
      materials[1].base_color = {0.2F, 0.9F, 0.3F, 0.7F};
      materials[1].alpha_mode = AlphaMode::blend;
      materials[2].base_color = {0.9F, 0.3F, 0.3F, 1};
    }
    for (MeshView& mesh : meshes) {
      mesh.colors = {};
      if (!with_materials) mesh.face_materials = {};
    }
    instances[1].object_to_world.m[0][3] = 0.3;
    instances[1].object_to_world.m[2][3] = 0.5;
  }
  [[nodiscard]] MeshView& mesh(int i) { return meshes[i]; }
  [[nodiscard]] Frame draw(Renderer& renderer, FrameOptions look) const {
    look.width = kW;
    look.height = kH;
    Camera camera{.eye = {0.2, -0.5, 2.6}};
    return test::draw(renderer, {.instances = instances, .materials = materials}, camera, look,
                      kKinds);
  }
};

/// Calls f(renderer, look, with materials) for shaders, layers, samples, threads and the reference.
template <class F>
void for_each_frame(const F& f) {
  for (const RendererOptions& by :
       {RendererOptions{.threads = 2}, RendererOptions{.device = Device::serial}}) {
    Renderer renderer(by);
    for (const FrameOptions& look :
         {FrameOptions{.shader = Shader::phong}, FrameOptions{.shader = Shader::flat},
          FrameOptions{.shader = Shader::wireframe}, FrameOptions{.shader = Shader::material},
          FrameOptions{.shader = Shader::lambert, .opacity = 0.5F},
          FrameOptions{.shader = Shader::normal, .samples = 4}})
      for (const bool materials : {false, true}) {
        SCOPED_TRACE(std::string(name(look.shader)) + (materials ? ", materials" : "") +
                     (by.device == Device::serial ? ", serial" : ""));
        f(renderer, look, materials);
      }
  }
}

/// Two descriptions of one look.
struct SameLook {
  const char* name;
  bool needs_materials;
  std::function<void(TwoSheets&)> by_instance;
  std::function<void(TwoSheets&, FrameOptions&)> otherwise;
};

TEST(Instances, HaveTheLookOfTheirFrameMaterialOrMesh) {
  static const Vec4 color{0.9F, 0.1F, 0.4F, 0.5F};
  static const std::vector<Vec4> all(TwoSheets(false).sheet.positions.size(), color);
  const auto opaque_red = [](TwoSheets& s) {
    s.instances[1].material = 2;
    s.mesh(0).face_materials = {};
  };
  const auto colored = [](TwoSheets& s) { s.instances[1].color = color; };
  const SameLook looks[] = {
      {"the frame's opacity", false,
       [](TwoSheets& s) {
         for (InstanceView& instance : s.instances) instance.opacity = 0.5F;
       },
       [](TwoSheets&, FrameOptions& look) { look.opacity *= 0.5F; }},
      {"a material's opacity", true,
       [&](TwoSheets& s) {
         opaque_red(s);
         s.instances[1].opacity = 0.25F;
       },
       [&](TwoSheets& s, FrameOptions&) {
         opaque_red(s);
         s.materials[2].opacity = 0.25F;
       }},
      {"colours of vertices", false, colored,
       [](TwoSheets& s, FrameOptions&) { s.mesh(1).colors.values = all; }},
      {"a mesh's colour", false, colored,
       [](TwoSheets& s, FrameOptions&) {
         s.mesh(1).colors = {.values = std::span(&color, 1), .per = Per::mesh};
       }},
      {"a mesh's material", true, [](TwoSheets& s) { s.instances[0].material = 1; },
       [](TwoSheets& s, FrameOptions&) {
         s.mesh(0).face_materials = {};
         s.mesh(0).material = 1;
       }},
  };
  for_each_frame([&](Renderer& renderer, const FrameOptions& look, bool materials) {
    for (const SameLook& same : looks) {
      if (same.needs_materials && !materials) continue;
      SCOPED_TRACE(same.name);
      TwoSheets own(materials), other(materials);
      FrameOptions other_look = look;
      same.by_instance(own);
      same.otherwise(other, other_look);
      const Frame got = own.draw(renderer, look);
      EXPECT_TRUE(same_images(got, other.draw(renderer, other_look)));
      if (same.name == std::string("the frame's opacity")) {
        EXPECT_FALSE(same_images(got, TwoSheets(materials).draw(renderer, look)));
      }
    }
  });
}

TEST(Instances, WhatIsNotVisibleKeepsItsNumbers) {
  for_each_frame([](Renderer& renderer, const FrameOptions& look, bool materials) {
    TwoSheets scene(materials), far_away(materials);
    // The other sheet is small enough for direct setup. Draws both, then one.
    for (const int hidden : {0, 1}) {
      scene.instances[hidden].visible = false;
      far_away.instances[hidden].object_to_world.m[2][3] = 50;  // behind the eye
      const Frame a = scene.draw(renderer, look), b = far_away.draw(renderer, look);
      EXPECT_TRUE(same_images(a, b));
      EXPECT_EQ(a.stats.triangles.input, b.stats.triangles.input);
      EXPECT_EQ(a.stats.triangles.culled, b.stats.triangles.culled);
      scene.instances[hidden].visible = true;
      far_away.instances[hidden].object_to_world.m[2][3] = 0.5 * hidden;
    }
  });
}

TEST(Instances, WindingTurnsWhatIsCulled) {
  for_each_frame([](Renderer& renderer, FrameOptions look, bool materials) {
    TwoSheets scene(materials);
    look.cull = Cull::front;
    const Frame front = scene.draw(renderer, look);
    look.cull = Cull::back;
    const Frame back = scene.draw(renderer, look);
    for (InstanceView& i : scene.instances) i.winding = Winding::clockwise;
    EXPECT_TRUE(same_images(front, scene.draw(renderer, look)));
    for (InstanceView& i : scene.instances) i.winding = Winding::either;
    const Frame either = scene.draw(renderer, look);
    EXPECT_TRUE(same_images(either, scene.draw(renderer, {.shader = look.shader,
                                                          .opacity = look.opacity,
                                                          .samples = look.samples})));
    EXPECT_FALSE(same_images(front, back));
  });
}

TEST(Instances, ALookOutOfRangeIsRefused) {
  const auto expect = [](const char* part, const auto& change) {
    TwoSheets scene(true);
    change(scene.instances[1]);
    Renderer renderer({.threads = 1});
    expect_refused(part, [&] { (void)scene.draw(renderer, {}); });
  };
  expect("instance 1: its opacity must lie in [0, 1]", [](InstanceView& i) { i.opacity = 1.5F; });
  expect("instance 1: its opacity", [](InstanceView& i) { i.opacity = 0.0F / 0.0F; });
  expect("instance 1: its colour must be four finite", [](InstanceView& i) {
    i.color = Vec4{0, 1, 1 / 0.0F, 1};
  });
  expect("instance 1: material 3 is out of range, there are 3",
         [](InstanceView& i) { i.material = 3; });
  expect("instance 1: its winding is 9",
         [](InstanceView& i) { i.winding = static_cast<Winding>(9); });
  // A matrix for row vectors would distort the mesh.
  expect("instance 1: the last row of its object_to_world must be 0 0 0 1, not 1 ",
         [](InstanceView& i) { i.object_to_world.m[3][0] = 1; });
}

TEST(Instances, SpheresHaveALookToo) {
  const std::vector<Vec3> centers{{-0.4F, 0, 0}, {0.4F, 0.1F, 0.2F}, {0.1F, -0.3F, 0.5F}};
  std::vector<Material> materials(2);
  materials[1].base_color = {0.9F, 0.4F, 0.3F, 1};
  const Vec4 color{0.3F, 0.8F, 0.4F, 0.5F};
  const std::vector<Vec4> colors(3, color);
  for_each_frame([&](Renderer& renderer, const FrameOptions& look, bool with_materials) {
    const auto draw = [&](const auto& change, FrameOptions by) {
      SpheresView spheres{.centers = centers, .radius = 0.35F};
      InstanceView instances[2];
      change(spheres, instances[0]);
      instances[0].geometry = spheres;
      const Sheet sheet(3);
      const MeshView behind = sheet.view();
      instances[1].geometry = behind;
      instances[1].material = 0;
      instances[1].object_to_world.m[2][3] = -0.6;
      by.width = kW;
      by.height = kH;
      Camera camera{.eye = {0.2, -0.5, 2.6}};
      SceneView scene{.instances = instances};
      if (with_materials) scene.materials = materials;
      return test::draw(renderer, scene, camera, by, kKinds);
    };
    const auto same = [&](const auto& a, const auto& b) {
      EXPECT_TRUE(same_images(draw(a, look), draw(b, look)));
    };
    const auto plain = [](SpheresView&, InstanceView&) {};
    same([&](SpheresView&, InstanceView& i) { i.color = color; },
         [&](SpheresView& s, InstanceView&) { s.colors = colors; });
    if (with_materials)
      same([&](SpheresView&, InstanceView& i) { i.material = 1; },
           [&](SpheresView& s, InstanceView&) { s.material = 1; });
    const Frame hidden = draw([](SpheresView&, InstanceView& i) { i.visible = false; }, look);
    EXPECT_TRUE(std::ranges::none_of(hidden.ids.pixels(),
                                     [](std::int64_t id) { return id >= 0 && id < 3; }));
    EXPECT_TRUE(std::ranges::any_of(hidden.ids.pixels(), [](std::int64_t id) { return id >= 3; }));
    const Frame faint = draw([](SpheresView&, InstanceView& i) { i.opacity = 0.5F; }, look);
    const Frame whole = draw(plain, look);
    EXPECT_TRUE(std::ranges::equal(faint.ids.pixels(), whole.ids.pixels()));
    EXPECT_FALSE(same_images(faint, whole));
  });
}

/// A cube in n³ places.
struct Cubes {
  std::vector<Vec3> corners;
  std::vector<std::uint32_t> indices{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                     2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  MeshView cube;
  std::vector<InstanceView> instances;

  explicit Cubes(int n) {
    for (int c = 0; c < 8; ++c)
      corners.push_back(
          {static_cast<float>(c % 2), static_cast<float>(c / 2 % 2), static_cast<float>(c / 4)});
    cube = {.positions = corners, .indices = indices};
    for (int i = 0; i < n * n * n; ++i) {
      InstanceView& at = instances.emplace_back(InstanceView{.geometry = cube});
      const double scale = 0.5 / n;
      const int place[3] = {i % n, i / n % n, i / n / n};
      for (int k = 0; k < 3; ++k) {
        at.object_to_world.m[k][k] = scale;
        at.object_to_world.m[k][3] = 2.0 * place[k] / n - 1;
      }
    }
  }
};

TEST(Instances, ManyOfASmallMeshKeepNoVertices) {
  const Cubes cubes(32);
  Renderer renderer({.threads = 2}), limited({.memory_limit = 4U << 20, .threads = 2}),
      serial({.device = Device::serial});
  Camera camera{.eye = {1.3, 1.1, 2.2}};
  const auto draw = [&](Renderer& by, std::span<const InstanceView> instances, int samples) {
    return test::draw(by, {.instances = instances}, camera,
                      {.width = kW, .height = kH, .samples = samples}, kKinds);
  };
  // One mesh of the same triangles. All positions are powers of two, so they are exact.
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;
  for (const InstanceView& at : cubes.instances) {
    for (const std::uint32_t i : cubes.indices)
      indices.push_back(static_cast<std::uint32_t>(positions.size()) + i);
    for (const Vec3& c : cubes.corners) {
      const auto& m = at.object_to_world.m;
      positions.push_back(
          Vec3(Vec3d{m[0][0] * c.x + m[0][3], m[1][1] * c.y + m[1][3], m[2][2] * c.z + m[2][3]}));
    }
  }
  MeshView all{.positions = positions, .indices = indices};
  const InstanceView one{all};
  for (const int samples : {1, 4}) {
    const Frame reference = draw(serial, cubes.instances, samples);
    ASSERT_GT(reference.stats.pixels_covered, 2500U);
    EXPECT_TRUE(same_images(reference, draw(renderer, cubes.instances, samples)));
    if (samples == 1) {
      EXPECT_TRUE(same_images(reference, draw(limited, cubes.instances, samples)));
    }
    // Another matrix rounds differently, so a vertex may snap to a neighbouring place.
    const Frame whole = draw(serial, {&one, 1}, samples);
    std::size_t other = 0;
    for (const auto& [x, y] : pixels(kW, kH)) other += reference.ids(x, y) != whole.ids(x, y);
    EXPECT_LT(other, reference.stats.pixels_covered / 50);
  }
  Renderer fresh({.threads = 2}), fresh_too({.threads = 2});
  const std::uint64_t many = draw(fresh, cubes.instances, 1).stats.peak_bytes,
                      whole = draw(fresh_too, {&one, 1}, 1).stats.peak_bytes;
  const std::uint64_t vertices = positions.size() * 16;
  EXPECT_LT(many + vertices / 4, whole);
}

}  // namespace
}  // namespace rastrum::test::instances_test
