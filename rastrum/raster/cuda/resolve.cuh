// SPDX-License-Identifier: BSD-3-Clause
// Keys to images on a device, a thread a pixel: depth, ids, keys, and colours by a shader functor,
// (key, x, y) to a premultiplied Vec4. LitOnDevice has the lit shaders except `wireframe`, in their
// scalar form and so with their bits; materials.cuh has `material`. The rules are the host's
// resolve_block.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <rastrum/image.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/cover.cuh>
#include <rastrum/raster/cuda/geometry.cuh>
#include <rastrum/raster/cuda/upload.cuh>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/shade/lit_scalar.hpp>

namespace rastrum::raster {

/// Images in device memory, like Targets; empty views are not computed. Pixel (0, 0) and size are
/// those of DeviceSurface::view.
struct DeviceTargets {
  ImageView<Rgba8> color8{};
  ImageView<Vec4> color{};
  ImageView<float> depth{};
  ImageView<std::int64_t> ids{};
  ImageView<std::uint64_t> keys{};

  /// Bytes a pixel of the wanted targets of `t`.
  static std::uint64_t bytes_of(const Targets& t) {
    std::uint64_t bytes = 0;
    for_each_target([&](const auto& row) {
      if (row.has_device() && !(t.*row.image).empty()) bytes += sizeof(row.empty);
    });
    return bytes;
  }
};

/// LitTriangle (lit_triangle.hpp) without what only thin and clipped triangles have.
struct alignas(16) LitRecord {
  float x0, y0, p1, q1, p2, q2;
  float inv_w[3];
  Vec3 normal[3], color[3];
  std::uint32_t exact;  ///< thin or clipped: the rest is not set
};
static_assert(sizeof(LitRecord) == 112);

/// The lit shaders with has(), at one opacity as in Shading; at 0 nothing is read. `scene`: spans
/// of the device's.
struct LitOnDevice {
  Shader model = Shader::flat;
  DeviceGeometry geometry;
  LitView scene;
  float opacity = 1;

  static bool has(Shader model) { return model != Shader::wireframe; }
  RASTRUM_HD Vec4 operator()(std::uint64_t key, int x, int y, Vec2 from_centre = {0, 0}) const {
    if (!(opacity > 0)) return {};
    const Vec3 c = color(key, x, y, from_centre);
    if (opacity == 1) return {c.x, c.y, c.z, 1};
    return {c.x * opacity, c.y * opacity, c.z * opacity, opacity};
  }
  /// The same colour, from the triangle's record.
  using Record = LitRecord;
  RASTRUM_HD Vec4 operator()(const LitRecord& record, std::uint64_t key, int x, int y,
                             Vec2 from_centre = {0, 0}) const {
    if (record.exact != 0) return (*this)(key, x, y, from_centre);
    const Vec3 c = color(record, x, y, from_centre);
    if (opacity == 1) return {c.x, c.y, c.z, 1};
    return {c.x * opacity, c.y * opacity, c.z * opacity, opacity};
  }
  /// Whether records save reads.
  [[nodiscard]] bool wants_records() const {
    return opacity > 0 && model != Shader::id && (model != Shader::flat || scene.colored);
  }
  /// The record of the triangle whose keys end in `low`.
  RASTRUM_HD_CALL LitRecord record(std::uint64_t low) const {
    LitTriangle t;
    fetch_triangle(scene, geometry, low, model != Shader::flat, t);
    LitRecord r{};
    r.exact = t.exact ? 1 : 0;
    if (t.exact) return r;
    r.x0 = t.x0;
    r.y0 = t.y0;
    r.p1 = t.p1;
    r.q1 = t.q1;
    r.p2 = t.p2;
    r.q2 = t.q2;
    for (int c = 0; c < 3; ++c) {
      r.inv_w[c] = t.inv_w[c];
      if (model != Shader::flat) r.normal[c] = t.normal[c];
      if (scene.colored) r.color[c] = t.color[c];
    }
    return r;
  }
  RASTRUM_HD_CALL Vec3 color(const LitRecord& r, int x, int y, Vec2 from_centre) const {
    LitTriangle t;
    t.exact = false;
    t.x0 = r.x0;
    t.y0 = r.y0;
    t.p1 = r.p1;
    t.q1 = r.q1;
    t.p2 = r.p2;
    t.q2 = r.q2;
    for (int c = 0; c < 3; ++c) {
      t.inv_w[c] = r.inv_w[c];
      t.normal[c] = r.normal[c];
      t.color[c] = r.color[c];
    }
    return shade_lit(model, scene, t, x, y, from_centre);
  }
  RASTRUM_HD_CALL Vec3 color(std::uint64_t key, int x, int y, Vec2 from_centre) const {
    if (model == Shader::id) return id_color(id_of_key(key));
    LitTriangle t;
    fetch_triangle(scene, geometry, key & kIdMask, model != Shader::flat, t);
    return shade_lit(model, scene, t, x, y, from_centre);
  }
};

struct KeepsFragments {
  RASTRUM_HD bool operator()(std::uint64_t, int, int) const { return true; }
};

/// How colours combine with the targets, as in Pass and FrameRequest.
struct ResolveRules {
  Backdrop backdrop;
  Vec4 background;  ///< where nothing covers a pixel: premultiplied display values
  bool over = false;
  bool load = false;
  std::uint64_t first_id = 0;

  static ResolveRules of(const FrameRequest& request) {
    return {backdrop_of(request.background, request.linear_light),
            premultiplied_from_straight(request.background), request.pass.over, request.pass.load,
            request.pass.first_id};
  }
  /// Whether a key's pixel has a surface of this pass.
  [[nodiscard]] RASTRUM_HD bool covers(std::uint64_t key) const {
    return key != 0 && (!load || id_of_key(key) >= first_id);
  }
  /// Whether pixels without a surface keep their values.
  [[nodiscard]] RASTRUM_HD bool keeps() const { return over || load; }
};

/// Colours in the places of a surface's keys.
struct ColorsOfSurface {
  DeviceSurface surface;
  const Vec4* colors;
  RASTRUM_HD Vec4 operator()(std::uint64_t, int x, int y) const {
    return colors[surface.keys.index(x / kBlockSize, y / kBlockSize) * 64 +
                  static_cast<std::size_t>(y % kBlockSize * kBlockSize + x % kBlockSize)];
  }
};

namespace cuda_detail {

/// The colour of element i of a surface; 0 without a key.
template <class Shade>
struct ColorOfElement {
  SurfaceView keys;
  Shade shade;
  RASTRUM_HD Vec4 operator()(std::size_t i) const {
    const std::uint64_t key = keys.keys[i];
    if (key == 0) return {};
    const auto [x, y] = keys.place_of(i);
    return shade(key, x, y);
  }
};

/// The pixel of element i of the surface. A warp has half a block, so few triangles.
template <class Shade>
struct ResolvePixel {
  DeviceSurface surface;
  DeviceTargets targets;
  Shade shade;
  ResolveRules rules;
  std::uint64_t* covered_sum;
  const std::uint64_t* held;
  /// A thread's number of pixels with a surface.
  struct Local {
    std::uint32_t covered = 0;
  };
  RASTRUM_HD void end(const Local& local) const {
    parallel::add_to_sum(*covered_sum, local.covered);
  }
  RASTRUM_HD void operator()(std::size_t i, Local& local) const {
    if (held != nullptr && *held != 0) return;
    const Rect view = surface.view;
    const PixelPlace place = surface.keys.place_of(i);
    const int x = place.x;
    const int y = place.y;
    if (x >= view.x1 || y >= view.y1) return;
    const std::uint64_t key = surface.keys.keys[i];
    const auto put = [&](const auto& image, const auto& value) {
      if (image.data != nullptr) image.data[(y - view.y0) * image.stride + (x - view.x0)] = value;
    };
    const bool covered = rules.covers(key);
    if (!covered && rules.keeps()) return;
    if (covered && (targets.color8.data != nullptr || targets.color.data != nullptr)) {
      const Vec4 front = shade(key, x, y);
      const auto at = [&](const auto& image) {
        return image.data[(y - view.y0) * image.stride + (x - view.x0)];
      };
      if (targets.color8.data != nullptr)
        put(targets.color8,
            (rules.over ? Backdrop::of(straight_from_rgba8(at(targets.color8))) : rules.backdrop)
                .color8_over(front));
      if (targets.color.data != nullptr)
        put(targets.color,
            (rules.over ? Backdrop::of(straight_from_premultiplied(at(targets.color)))
                        : rules.backdrop)
                .color_over(front));
    } else {
      put(targets.color8, rules.backdrop.empty);
      put(targets.color, rules.background);
    }
    put(targets.depth, std::bit_cast<float>(static_cast<std::uint32_t>(key >> kIdBits)));
    put(targets.ids, key == 0 ? std::int64_t{-1} : static_cast<std::int64_t>(id_of_key(key)));
    put(targets.keys, key);
    local.covered += covered ? 1 : 0;
  }
};

}  // namespace cuda_detail

/// Fills `targets` from the keys of `surface`. Where `rules` keep or blend over something,
/// `targets` must have it. Adds the number of pixels with a surface to *covered. Does nothing if
/// *held is not 0; null: there is none. Both are on the device. Work O(pixels).
template <class Exec, class Shade>
void resolve_surface(Exec& exec, const DeviceSurface& surface, const DeviceTargets& targets,
                     const Shade& shade, const ResolveRules& rules, std::uint64_t* covered,
                     const std::uint64_t* held = nullptr) {
  using Resolve = cuda_detail::ResolvePixel<Shade>;
  parallel::for_each_strided<typename Resolve::Local>(
      exec, block_count(surface.view) * 64, Resolve{surface, targets, shade, rules, covered, held});
}

namespace cuda_detail {

struct IsBeyond {
  std::span<const std::uint32_t> indices;
  std::size_t end;
  RASTRUM_HD std::uint32_t operator()(std::size_t i) const { return indices[i] >= end ? 1 : 0; }
};

}  // namespace cuda_detail

/// Throws Error{invalid_argument} where `attribute`, spans of the device's, has fewer values than
/// `mesh` reads. Waits if it has indices.
template <class Exec, class Attribute>
void check_attribute(Exec& exec, const Attribute& attribute, const MeshView& mesh,
                     const char* what) {
  const auto require = [&](bool ok, const char* problem) {
    if (!ok) throw Error(Errc::invalid_argument, std::string(what).append(problem));
  };
  if (attribute.values.empty()) return;
  if (attribute.indices.empty())
    return require(attribute.values.size() >= mesh.positions.size(), " are fewer than positions");
  require(attribute.indices.size() >= mesh.triangle_count() * 3,
          " have fewer indices than the triangles");
  const auto beyond = parallel::Computed(
      attribute.indices.size(),
      cuda_detail::IsBeyond{attribute.indices.packed(), attribute.values.size()});
  require(parallel::reduce(exec, beyond, std::uint64_t{0}) == 0, " have an index out of range");
}

/// The arrays of the lit shaders on the device. Its spans live as long as `uploads`. Waits.
template <class Exec>
class LitUpload {
 public:
  LitUpload(Exec& exec, Uploads<Exec>& uploads, const LitShading& lit) {
    const bool wants_normals = lit.model != Shader::flat && lit.model != Shader::id;
    std::vector<LitDraw> draws;
    std::vector<MeshView> meshes;
    for (LitDraw draw : lit.scene->draws) {
      MeshView mesh = *draw.mesh;
      const auto move = [&](auto& attribute, bool wanted) {
        if (!wanted) return;
        attribute.values = uploads(attribute.values);
        attribute.indices = uploads(attribute.indices);
      };
      if (wants_normals) mesh.positions = uploads(mesh.positions);
      move(mesh.normals, wants_normals);
      move(draw.colors, lit.scene->colored);
      if (!lit.scene->materials.empty()) draw.face_materials = uploads(draw.face_materials);
      // The façade has checked what it could read.
      if (uploads.in_place()) {
        check_attribute(exec, mesh.normals, mesh, "normals");
        check_attribute(exec, draw.colors, mesh, "colors");
      }
      draws.push_back(draw);
      meshes.push_back(mesh);
    }
    meshes_ = parallel::upload(exec, meshes);
    for (std::size_t i = 0; i < draws.size(); ++i) draws[i].mesh = meshes_.data() + i;
    draws_ = parallel::upload(exec, draws);
    view_ = {{draws_.data(), draws_.size()},
             lit.scene->rays,
             lit.scene->colored,
             uploads(std::span(lit.scene->materials))};
  }
  [[nodiscard]] const LitView& view() const { return view_; }

 private:
  decltype(parallel::make_buffer<MeshView>(std::declval<Exec&>(), 0)) meshes_;
  decltype(parallel::make_buffer<LitDraw>(std::declval<Exec&>(), 0)) draws_;
  LitView view_;
};

}  // namespace rastrum::raster
