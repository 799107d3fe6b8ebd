// SPDX-License-Identifier: BSD-3-Clause
// Translucent scenes through the façade: generated ones with alphas from materials, vertex colours
// and opacity, and real files with their materials. The oracle takes colours from the shaders,
// called for single fragments on the scalar path (alpha_test and material_test test those). It
// finds and blends the fragments itself.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/io.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/interpolate.hpp>
#include <rastrum/raster/draws/numbering.hpp>
#include <rastrum/raster/shade/lit.hpp>
#include <rastrum/raster/shade/material.hpp>
#include <rastrum/raster/shade/shader.hpp>
#include <rastrum/raster/shade/texture.hpp>
#include <rastrum/render.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/draws_of.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/real_meshes.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/test_share.hpp"
#include "tests/transparency/exactness.hpp"

namespace rastrum::test::facade_test {
namespace {

/// Shades one fragment at a time, like the façade's shader for these options.
class Fragments {
 public:
  Fragments(const SceneView& scene, const Camera& camera, const RenderOptions& o)
      : lit_scene_(scene, camera, o.width, o.height) {
    bool blends = false, masks = false;
    for (const Material& m : scene.materials) {
      blends |= m.alpha_mode == AlphaMode::blend;
      masks |= m.alpha_mode == AlphaMode::mask;
    }
    draws_ = draws_of(scene, world_to_clip(camera, o.width, o.height));
    (void)raster::number_draws(draws_, 0);
    frame_ = {o.width, o.height, raster::Viewport::of(o.width, o.height),
              draws_,  nullptr,  Isa::scalar};
    const bool materials = o.shader == Shader::material;
    textures_.update(scene.textures, raster::texture_uses(scene, materials, blends), nullptr);
    material_scene_ =
        std::make_unique<raster::MaterialScene>(scene, camera, o.width, o.height, textures_);
    shading_ = raster::LitShading{Shader::phong, &lit_scene_};
    if (materials) shading_ = raster::MaterialShading{material_scene_.get(), true};
    shading_ = shading_.with_alpha(blends ? material_scene_.get() : nullptr, o.opacity);
    scratch_.begin(scratch_bytes(shading_));
    if (masks) test_ = raster::MaskTest{material_scene_.get()};
    for (const InstanceView& instance : scene.instances) {
      const MeshView& mesh = *instance.mesh();
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
        modes_.push_back(scene.materials.empty()
                             ? AlphaMode::opaque
                             : scene
                                   .materials[mesh.face_materials.empty() ? mesh.material
                                                                          : mesh.face_materials[t]]
                                   .alpha_mode);
    }
    all_translucent_ = o.opacity < 1;
  }

  [[nodiscard]] bool is_opaque(std::int64_t id) const {
    return !all_translucent_ && modes_[static_cast<std::size_t>(id)] != AlphaMode::blend;
  }
  [[nodiscard]] Rgba64 color(std::int64_t id, const ShadePoint& p) {
    const At at(p);
    alignas(64) std::uint64_t keys[64] = {};
    keys[at.bit] = visibility_key(0.5F, id);
    raster::VisibleBlock block{keys, at.mask, at.x0, at.y0, scratch_.data()};
    block.points = &at.points;
    raster::BlockColors colors;
    if (shade_block(shading_, frame_, block, Isa::scalar, colors)) colors.a[at.bit] = 1;
    return {colors.r[at.bit], colors.g[at.bit], colors.b[at.bit], colors.a[at.bit]};
  }
  [[nodiscard]] bool is_hole(std::int64_t id, const ShadePoint& p) const {
    if (modes_[static_cast<std::size_t>(id)] != AlphaMode::mask) return false;
    const At at(p);
    raster::Piece piece{};
    piece.low = raster::kIdMask - static_cast<std::uint64_t>(id);
    return test_block(test_, frame_, piece,
                      {0, static_cast<std::uint16_t>(at.x0 / 8),
                       static_cast<std::uint16_t>(at.y0 / 8), at.mask},
                      &at.points) == 0;
  }

 private:
  /// A place in a block.
  struct At {
    explicit At(const ShadePoint& p)
        : x0(p.px / 8 * 8), y0(p.py / 8 * 8), bit((p.py - y0) * 8 + p.px - x0) {
      mask = std::uint64_t{1} << bit;
      points.dx[bit] = static_cast<float>(p.x_fx8 - (p.px * 256 + 128)) / 256;
      points.dy[bit] = static_cast<float>(p.y_fx8 - (p.py * 256 + 128)) / 256;
    }
    int x0, y0, bit;
    std::uint64_t mask = 0;
    raster::ShadingPoints points{};
  };

  MemoryAccount memory_;
  std::vector<raster::Draw> draws_;
  raster::FrameGeometry frame_;
  raster::TextureSet textures_{memory_};
  raster::LitScene lit_scene_;
  std::unique_ptr<raster::MaterialScene> material_scene_;
  raster::Shading shading_;
  raster::Testing test_;
  std::vector<AlphaMode> modes_;
  bool all_translucent_ = false;
  raster::ShaderScratch scratch_;
};

/// The faces that `material` leaves out: backs of single-sided materials.
Cull cull_of(const InstanceView& instance, const SceneView& scene, Shader shader) {
  if (shader != Shader::material || scene.materials.empty() ||
      !instance.mesh()->face_materials.empty() ||
      scene.materials[instance.mesh()->material].double_sided)
    return Cull::none;
  const auto& m = instance.object_to_world.m;
  double determinant = 0;
  for (int i = 0; i < 3; ++i)
    determinant +=
        m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
  return determinant < 0 ? Cull::front : Cull::back;
}

LayerImage shaded_oracle(const SceneView& scene, const Camera& camera, const RenderOptions& o) {
  std::vector<SnappedTriangle> triangles;
  std::int64_t first = 0;
  for (const InstanceView& instance : scene.instances) {
    const SceneView alone{{&instance, 1}, scene.materials, scene.textures};
    const PieceList pieces =
        pieces_of(alone, camera, o.width, o.height, cull_of(instance, scene, o.shader));
    for (SnappedTriangle t : pieces.triangles) {
      t.id += first;
      triangles.push_back(t);
    }
    first += static_cast<std::int64_t>(instance.mesh()->triangle_count());
  }
  const auto fragments = std::make_unique<Fragments>(scene, camera, o);
  const bool linear = o.shader == Shader::material;
  LayerInput in;
  in.width = o.width;
  in.height = o.height;
  in.samples = o.samples;
  in.triangles = triangles;
  in.is_opaque = [&](std::int64_t id) { return fragments->is_opaque(id); };
  in.is_hole = [&](const SnappedTriangle& t, const ShadePoint& p) {
    return fragments->is_hole(t.id, p);
  };
  in.color = [&](const SnappedTriangle& t, const ShadePoint& p) {
    return fragments->color(t.id, p);
  };
  const Vec4 b = o.background;
  const auto back = [&](float c) { return b.w * (linear ? light_of(c) : double{c}); };
  in.background = {back(b.x), back(b.y), back(b.z), b.w};
  LayerImage image = blend_layers(in, LayerOrder::depth);
  if (linear)
    for (Rgba64& c : image.color)
      for (double* const channel : {&c.r, &c.g, &c.b})
        *channel = c.a > 0 ? display(*channel / c.a) * c.a : 0;
  return image;
}

/// `layers` as a façade scene: straight vertex colours, and a material for opaque faces.
Scene facade_scene(const LayerScene& layers) {
  Scene scene = single(layers.mesh);
  Mesh& mesh = scene.meshes[0];
  scene.materials.resize(2);
  scene.materials[1].alpha_mode = AlphaMode::blend;
  for (std::uint32_t t = 0; t < layers.size(); ++t) {
    const Vec4 c = layers.colors[t];
    const float scale = c.w > 0 ? 1 / c.w : 1;
    mesh.colors.values.push_back({c.x * scale, c.y * scale, c.z * scale, c.w});
    mesh.colors.indices.insert(mesh.colors.indices.end(), {t, t, t});
    mesh.face_materials.push_back(layers.opaque[t] != 0 ? 0 : 1);
  }
  return scene;
}

// Alpha = opacity, times vertex alpha for blended materials. Colours are the shader's, times alpha.
TEST(Facade, GeneratedScenesEqualTheOracle) {
  constexpr int kWidth = 61, kHeight = 47;
  const int scenes = share_of(100, 2 * kLayerKinds);
  int failures = 0;
  for (int i = 0; i < scenes; ++i) {
    LayerScene layers = generate_layers(static_cast<std::uint64_t>(i) + 31000, kWidth, kHeight);
    SCOPED_TRACE("scene " + std::to_string(i) + " (" + layers.kind + ")");
    layers.holes = false;
    layers.paint = Paint::triangle;
    const Scene scene = facade_scene(layers);
    const SceneBinding binding(scene);
    RenderOptions o({.width = kWidth,
                     .height = kHeight,
                     .shader = Shader::flat,
                     .background = {0.9F, 0.5F, 0.2F, i % 2 == 0 ? 1.0F : 0.3F},
                     .opacity = i % 3 == 0 ? 1 : 0.6F});
    const LayerQuestion question(layers, kWidth, kHeight, 1, o.background);
    LayerInput in = question.input();
    if (o.opacity < 1) in.is_opaque = [](std::int64_t) { return false; };
    const std::vector<Vec4> straight = scene.meshes[0].colors.values;
    in.color = [&](const SnappedTriangle& t, const ShadePoint&) {
      const auto id = static_cast<std::size_t>(t.id);
      const Vec4 c = straight[id];
      const double a = double{o.opacity} * (layers.opaque[id] != 0 ? 1.0 : double{c.w});
      return Rgba64{c.x * a, c.y * a, c.z * a, a};
    };
    const LayerImage oracle = blend_layers(in, LayerOrder::depth);
    for (const Isa isa : available_isas()) {
      o.isa = isa;
      o.threads = i % 2 == 0 ? 2 : 8;
      Painter renderer(o);
      const auto r = equals_oracle(take(renderer, binding.view(), layers.camera), oracle);
      EXPECT_TRUE(r) << name(isa);
      if (!r && ++failures == 3) FAIL() << "three frames failed; the rest was not drawn";
    }
  }
}

struct File {
  const char* path;
  Shader shader;
  float opacity;
  int samples = 1;
};

void PrintTo(const File& file, std::ostream* out) {
  *out << file.path;
}

class FacadeFiles : public testing::TestWithParam<File> {};

TEST_P(FacadeFiles, EqualTheOracle) {
  if (test_share() < 100) GTEST_SKIP() << kOnlyWhole;
  const File file = GetParam();
  const std::filesystem::path path = shared_data(file.path);
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Scene scene = io::read_scene(path);
  const SceneBinding binding(scene);
  RenderOptions o({.width = 203,
                   .height = 149,
                   .shader = file.shader,
                   .background = {0.3F, 0.6F, 0.9F, 0.5F},
                   .opacity = file.opacity,
                   .samples = file.samples});
  // The oracle has no float32 target in linear light.
  const Check check = file.shader != Shader::material ? Check::all : Check::bits8;
  for (const Camera& camera :
       {fit_camera(binding.view(), 1.0472F, false), close_camera(binding.view())}) {
    const LayerImage oracle = shaded_oracle(binding.view(), camera, o);
    EXPECT_GE(oracle.most_layers(), 1U);
    expect_exact(o, oracle, check,
                 [&](Painter& painter) { return take(painter, binding.view(), camera); });
    if (file.samples > 1) break;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shared, FacadeFiles,
    testing::Values(File{"alpha/smallpine/scene.gltf", Shader::material, 1},
                    File{"alpha/smallpine/scene.gltf", Shader::material, 0.5F},
                    File{"alpha/smallpine/scene.gltf", Shader::phong, 0.7F, 4},
                    File{"alpha/AlphaBlendModeTest.glb", Shader::material, 1},
                    File{"depth/2CylinderEngine.glb", Shader::material, 0.5F},
                    File{"depth/2CylinderEngine.glb", Shader::phong, 0.5F},
                    File{"depth/2CylinderEngine.glb", Shader::material, 0.5F, 4},
                    File{"depth/ratboy_mohawk_ribbons_138k.ply", Shader::phong, 0.3F},
                    File{"depth/ratboy_mohawk_ribbons_138k.ply", Shader::phong, 0.3F, 16},
                    File{"sponza/sponza.obj", Shader::phong, 0.5F},
                    File{"sponza/sponza.obj", Shader::material, 0.5F},
                    File{"big/brain_iso126_1033k.ply", Shader::phong, 0.3F}),
    [](const testing::TestParamInfo<File>& p) {
      std::string title = std::filesystem::path(p.param.path).parent_path().filename().string();
      title.append("_").append(name(p.param.shader)).append("_");
      title.append(std::to_string(static_cast<int>(p.param.opacity * 100))).append("_");
      title.append(std::to_string(p.param.samples)).append("_").append(std::to_string(p.index));
      return title;
    });

}  // namespace
}  // namespace rastrum::test::facade_test
