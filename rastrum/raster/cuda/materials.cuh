// SPDX-License-Identifier: BSD-3-Clause
// Materials on a device: their textures, which stay from frame to frame, the arrays that shaders
// read, and functors of material_scalar.hpp, so with the bits of the host's serial picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/geometry.cuh>
#include <rastrum/raster/cuda/resolve.cuh>
#include <rastrum/raster/cuda/upload.cuh>
#include <rastrum/raster/shade/material_scalar.hpp>

namespace rastrum::raster {

/// Colours and alpha with a scene's materials. Colours are theirs or a lit shader's. Alpha is the
/// opacity, times their own where they blend (alpha.hpp).
struct MaterialOnDevice {
  LitOnDevice lit;  ///< its opacity is not used
  MaterialView scene;
  float opacity = 1;
  bool shades = false;  ///< colours are the materials'
  bool blends = false;  ///< alpha is, too
  bool linear = false;  ///< colours are linear light

  RASTRUM_HD Vec4 operator()(std::uint64_t key, int x, int y, Vec2 from_centre = {0, 0}) const {
    const std::uint64_t id = id_of_key(key);
    const float alpha = blends ? alpha_of(id, x, y, from_centre) : opacity;
    if (!(alpha > 0)) return {};
    const Vec3 c = shades ? color(id, x, y, from_centre) : lit.color(key, x, y, from_centre);
    if (alpha == 1) return {c.x, c.y, c.z, 1};
    return {c.x * alpha, c.y * alpha, c.z * alpha, alpha};
  }

 private:
  RASTRUM_HD_CALL float alpha_of(std::uint64_t id, int x, int y, Vec2 from_centre) const {
    return alpha_at(scene, lit.geometry, id, x, y, from_centre, opacity);
  }
  RASTRUM_HD_CALL Vec3 color(std::uint64_t id, int x, int y, Vec2 from_centre) const {
    const MaterialTriangle t(scene, lit.geometry, lit.geometry.draw_of(id), id);
    return shade_material(scene, t, MaterialPoint(t.planes, x, y, from_centre), linear);
  }
};

/// The library's fragment tests: alpha masks, and the depth of a picture that is drawn over.
struct TestOnDevice {
  DeviceGeometry geometry;
  MaterialView masks;
  bool has_masks = false;
  ImageView<const float> behind;  ///< of the band from row `y0` on; null: no picture
  int y0 = 0;

  RASTRUM_HD bool operator()(std::uint64_t key, int x, int y) const {
    if (behind.data != nullptr) {
      const float depth = behind.data[(y - y0) * behind.stride + x];
      // Where nothing is behind (depth 0), even a fragment of depth 0 is drawn.
      if (depth > 0 && !(std::bit_cast<float>(static_cast<std::uint32_t>(key >> kIdBits)) > depth))
        return false;
    }
    return !has_masks || passes_mask_of(id_of_key(key), x, y);
  }

 private:
  RASTRUM_HD_CALL bool passes_mask_of(std::uint64_t id, int x, int y) const {
    const Draw& draw = geometry.draw_of(id);
    return (draw.flags_of(id - draw.first_id) & kTested) == 0 ||
           passes_mask(masks, geometry, id, x, y, {0, 0});
  }
};

/// Texels of a scene's textures on the device, each copied once. A texture that a frame does not
/// read goes with the next frame.
template <class Exec>
class DeviceTextures {
 public:
  explicit DeviceTextures(Exec& exec) : exec_(exec) {}

  /// Keeps chains that are asked for before the next begin().
  void begin() {
    std::erase_if(kept_, [](const auto& kept) { return !kept.second.is_read; });
    for (auto& kept : kept_) kept.second.is_read = false;
  }
  /// `host` with device pointers. Waits if it is new.
  [[nodiscard]] MipChain operator()(const MipChain& host) {
    auto at = kept_.find(host.number);
    if (at == kept_.end()) at = kept_.emplace(host.number, copy_of(host)).first;
    Kept& kept = at->second;
    kept.is_read = true;
    MipChain chain = host;
    chain.decode = kept.decode.data();
    const Rgba8* texels = kept.texels.data();
    for (int l = 0; l < host.levels; ++l) {
      chain.level[l].texels = texels;
      texels += texels_of(host.level[l]);
    }
    return chain;
  }
  [[nodiscard]] std::uint64_t copies() const { return copies_; }

 private:
  template <class T>
  using Array = decltype(parallel::make_buffer<T>(std::declval<Exec&>(), 0));
  struct Kept {
    Array<Rgba8> texels;
    Array<float> decode;
    bool is_read = false;
  };

  [[nodiscard]] static std::size_t texels_of(const MipLevel& level) {
    return static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height);
  }
  [[nodiscard]] Kept copy_of(const MipChain& host) {
    Kept kept;
    std::size_t texels = 0;
    for (int l = 0; l < host.levels; ++l) texels += texels_of(host.level[l]);
    kept.texels = parallel::make_buffer<Rgba8>(exec_, texels);
    kept.decode = parallel::make_buffer<float>(exec_, 256);
    parallel::cuda_system::copy(exec_.stream(), kept.decode.data(), host.decode,
                                256 * sizeof(float));
    Rgba8* to = kept.texels.data();
    for (int l = 0; l < host.levels; to += texels_of(host.level[l]), ++l)
      parallel::cuda_system::copy(exec_.stream(), to, host.level[l].texels,
                                  texels_of(host.level[l]) * sizeof(Rgba8));
    exec_.wait();
    ++copies_;
    return kept;
  }

  Exec& exec_;
  std::map<std::uint64_t, Kept> kept_;
  std::uint64_t copies_ = 0;
};

enum class MaterialUse : std::uint8_t { alpha, all };

/// A scene's materials and its meshes' arrays on the device. Lives as long as `uploads` and the
/// textures' frame. Waits.
template <class Exec>
class MaterialUpload {
  template <class T>
  using Array = decltype(parallel::make_buffer<T>(std::declval<Exec&>(), 0));

 public:
  MaterialUpload(Exec& exec, Uploads<Exec>& uploads, DeviceTextures<Exec>& textures,
                 const MaterialScene& scene, MaterialUse use) {
    std::vector<MipChain> chains;
    std::vector<BoundMaterial> materials = scene.materials;
    const auto each_texture = [&](BoundMaterial& m, auto&& f) {
      if (use == MaterialUse::all)
        for (const MipChain** chain : {&m.metallic_roughness, &m.normal, &m.occlusion, &m.emissive})
          f(*chain);
      for (const MipChain** chain : {&m.base_color, &m.alpha}) f(*chain);
    };
    for (BoundMaterial& m : materials)
      each_texture(m, [&](const MipChain*& chain) {
        if (chain != nullptr) chains.push_back(textures(*chain));
      });
    chains_ = parallel::upload(exec, chains);
    const MipChain* next = chains_.data();
    for (BoundMaterial& m : materials)
      each_texture(m, [&](const MipChain*& chain) {
        if (chain != nullptr) chain = next++;
      });
    materials_ = parallel::upload(exec, materials);

    std::vector<MaterialDraw> draws = scene.draws;
    std::vector<MeshView> meshes;
    for (MaterialDraw& draw : draws) {
      MeshView& mesh = meshes.emplace_back(*draw.mesh);
      const auto move = [&](auto& attribute) {
        attribute.values = uploads(attribute.values);
        attribute.indices = uploads(attribute.indices);
      };
      draw.face_materials = uploads(draw.face_materials);
      move(mesh.texcoords);
      move(draw.colors);
      if (use == MaterialUse::alpha) continue;
      mesh.positions = uploads(mesh.positions);
      move(mesh.normals);
    }
    meshes_ = parallel::upload(exec, meshes);
    for (std::size_t i = 0; i < draws.size(); ++i) draws[i].mesh = meshes_.data() + i;
    draws_ = parallel::upload(exec, draws);
    curve_ = parallel::upload(exec, display_curve());
    view_ = {{materials_.data(), materials_.size()},
             {draws_.data(), draws_.size()},
             scene.rays,
             nullptr,
             curve_.data()};
  }
  [[nodiscard]] const MaterialView& view() const { return view_; }

 private:
  Array<MipChain> chains_;
  Array<BoundMaterial> materials_;
  Array<MeshView> meshes_;
  Array<MaterialDraw> draws_;
  Array<double> curve_;
  MaterialView view_;
};

}  // namespace rastrum::raster
