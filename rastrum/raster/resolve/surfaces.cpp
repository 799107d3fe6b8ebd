// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/resolve/surfaces.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include <rastrum/raster/draws/vertices_of.hpp>
#include <rastrum/raster/resolve/distances.hpp>
#include <rastrum/raster/resolve/surface_point.hpp>
#include <rastrum/raster/shade/lit_kernels.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>
#include <rastrum/raster/surface/seen_planes.hpp>

namespace rastrum::raster {
namespace {

/// Stores the numbers that a key alone has: its instance and primitive.
void store_numbers(const FrameRequest& request, const FrameGeometry& frame,
                   const VisibleBlock& block, std::uint64_t touched) {
  const Targets& t = request.targets;
  const SurfaceScene* const scene = request.surface;
  std::int64_t instances[64]{}, primitives[64]{};
  const Draw* draw = nullptr;
  std::uint64_t copy = 0;
  std::int64_t instance = -1;
  for (std::uint64_t m = touched; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    instances[i] = primitives[i] = -1;
    if ((block.covered >> i & 1) == 0) continue;
    const std::uint64_t id = id_of_key(block.keys[i]);
    const bool is_other = draw == nullptr || id - draw->first_id >= draw->primitive_count;
    if (is_other) draw = &frame.draw_of(id);
    const Draw::OfCopy of = draw->of_copy(id - draw->first_id);
    if (is_other || of.copy != copy) {
      const auto place = static_cast<std::size_t>(draw - frame.draws.data());
      copy = of.copy;
      instance =
          scene == nullptr ? static_cast<std::int64_t>(place) : scene->instance_id(place, copy);
    }
    instances[i] = instance;
    primitives[i] = static_cast<std::int64_t>(of.primitive);
  }
  const auto store = [&](const auto& target, const std::int64_t(&numbers)[64]) {
    if (target.empty()) return;
    using Number = std::remove_pointer_t<decltype(target.data)>;
    Number own[64];
    for (int i = 0; i < 64; ++i) own[i] = static_cast<Number>(numbers[i]);
    store_block(target, own, touched, block.x0, block.y0);
  };
  store(t.instances, instances);
  store(t.instances32, instances);
  store(t.primitives, primitives);
  store(t.primitives32, primitives);
}

void store_distances(const FrameRequest& request, const VisibleBlock& block,
                     std::uint64_t touched) {
  const Targets& t = request.targets;
  alignas(64) float view_depth[64], distance[64];
  if (block.covered == 0) {
    std::fill_n(view_depth, 64, request.no_distance);
    std::fill_n(distance, 64, request.no_distance);
  } else {
    distance_kernel(request.isa)(*request.surface, block.keys, block.x0, block.y0,
                                 request.no_distance, view_depth,
                                 t.distance.empty() ? nullptr : distance);
  }
  if (!t.view_depth.empty()) store_block(t.view_depth, view_depth, touched, block.x0, block.y0);
  if (!t.distance.empty()) store_block(t.distance, distance, touched, block.x0, block.y0);
}

float number_of(double value) {
  return std::isnan(value) ? kNoNumber : static_cast<float>(value);
}

void store_point(const FrameRequest& request, const FrameGeometry& frame, const SeenFragment& f,
                 int x, int y) {
  const Targets& t = request.targets;
  const auto store = [&](const auto& target, const auto& value) {
    if (!target.empty()) target(x, y) = value();
  };
  store(t.barycentrics, [&] {
    return Vec2{static_cast<float>(f.weights.b[1]), static_cast<float>(f.weights.b[2])};
  });
  store(t.positions, [&] { return Vec3(request.surface->position(f)); });
  store(t.scalars, [&] { return number_of(request.surface->scalar(frame, f)); });
}

void store_nothing(const FrameRequest& request, std::uint64_t where, int x0, int y0) {
  for_each_target([&](const auto& row) {
    const auto& target = request.targets.*row.image;
    if (target.empty() || !row.is_of_surface()) return;
    const auto nothing = empty_pixel(row, request.no_distance);
    for (std::uint64_t rows = where, y = 0; rows != 0; rows >>= kBlockSize, ++y) {
      auto* const pixels = target.row(y0 + static_cast<int>(y)) + x0;
      if (rows % 256 == 255) {
        std::fill_n(pixels, kBlockSize, nothing);
        continue;
      }
      for (std::uint64_t m = rows % 256; m != 0; m &= m - 1) pixels[std::countr_zero(m)] = nothing;
    }
  });
}

std::uint64_t of_triangles(const FrameRequest& request, const FrameGeometry& frame,
                           const VisibleBlock& block, std::uint64_t seen) {
  if (request.surface != nullptr && request.surface->only_meshes) return seen;
  std::uint64_t triangles = 0;
  const Draw* draw = nullptr;
  for (std::uint64_t m = seen; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t id = id_of_key(block.keys[i]);
    if (draw == nullptr || id - draw->first_id >= draw->primitive_count) draw = &frame.draw_of(id);
    const bool is_one = draw->topology == Topology::triangles && draw->quadrics == nullptr;
    triangles |= std::uint64_t{is_one} << i;
  }
  return triangles;
}

SeenPlanes& kept_planes() {
  static thread_local SeenPlanes planes;
  return planes;
}

/// Weights, positions and numbers at the covered pixels of a block, all of triangles, with
/// store_point's results.
class TriangleStorer {
 public:
  TriangleStorer(const FrameRequest& request, const FrameGeometry& frame, const VisibleBlock& block,
                 const SeenKernels& kernels)
      : request_(request), frame_(frame), block_(block), kernels_(kernels), seen_(kept_planes()) {
    kernels.see(frame, block, seen_);
    kernels.shares(seen_, block, shares_);
  }

  void store() {
    const Targets& t = request_.targets;
    if (!t.barycentrics.empty()) {
      Vec2 values[64];
      kernels_.barycentrics(shares_, values);
      store_values(t.barycentrics, values);
    }
    if (!t.positions.empty()) store_positions();
    if (!t.scalars.empty()) store_scalars();
  }

 private:
  template <class T>
  void store_values(const ImageView<T>& target, const T (&values)[64]) const {
    store_block(target, values, block_.covered, block_.x0, block_.y0);
  }
  [[nodiscard]] std::size_t draw_of(std::size_t k) const {
    return static_cast<std::size_t>(seen_.draw[k] - frame_.draws.data());
  }
  [[nodiscard]] bool are_together(std::size_t a, std::size_t b) const {
    return seen_.draw[a] == seen_.draw[b] && seen_.part[a].copy == seen_.part[b].copy;
  }
  [[nodiscard]] const InstanceView& instance(std::size_t k) const {
    return request_.surface->instance(draw_of(k), seen_.part[k].copy);
  }

  void store_positions() const {
    ByCorner corner[3];
    const ArrayView<Vec3>* positions = nullptr;
    bool is_one = true;
    for (std::size_t k = 0; k < seen_.count; ++k) {
      if (k == 0 || !are_together(k - 1, k)) {
        positions = vertices_of(instance(k).geometry).positions;
        is_one = k == 0;
      }
      const Fragment f = seen_.fragment(k);
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3d p = positions->wide(f.vertex[c]);
        corner[0][c][k] = p.x;
        corner[1][c][k] = p.y;
        corner[2][c][k] = p.z;
      }
    }
    Vec3 places[64];
    for (std::uint64_t rest = block_.covered; rest != 0;) {  // instance by instance
      const std::size_t first = seen_.place[std::countr_zero(rest)];
      const std::uint64_t mine =
          is_one ? rest
                 : seen_.pixels_where(rest, [&](std::size_t k) { return are_together(first, k); });
      kernels_.positions(seen_, shares_, mine, corner, instance(first).object_to_world, places);
      rest &= ~mine;
    }
    store_values(request_.targets.positions, places);
  }

  void store_scalars() const {
    ByCorner corner;
    Numbers64 value{};
    const std::span<const SurfaceScalars> scalars = request_.surface->scalars;
    for (std::size_t k = 0; k < seen_.count; ++k) {
      double at[3];
      std::fill_n(at, 3, std::numeric_limits<double>::quiet_NaN());
      if (!scalars.empty() && !scalars[draw_of(k)].empty())
        scalars[draw_of(k)].at_corners(seen_.fragment(k), Topology::triangles, at);
      for (std::size_t c = 0; c < 3; ++c) corner[c][k] = at[c];
    }
    kernels_.numbers(seen_, shares_, block_.covered, corner, value);
    float values[64];
    for (std::size_t i = 0; i < 64; ++i) values[i] = number_of(value[i]);
    store_values(request_.targets.scalars, values);
  }

  const FrameRequest& request_;
  const FrameGeometry& frame_;
  const VisibleBlock& block_;
  const SeenKernels& kernels_;
  SeenPlanes& seen_;
  ByCorner shares_;
};

/// A thread's triangles for normals that no shader has left. They are many, but made once a frame;
/// frame numbers tell when to forget them.
KeptTriangles& kept_triangles(const FrameGeometry& frame) {
  static thread_local struct {
    std::uint64_t frame = 0;
    KeptTriangles triangles;
  } kept;
  if (frame.number != kept.frame || frame.number == 0) kept.triangles.clear();
  kept.frame = frame.number;
  return kept.triangles;
}

void store_normals(const FrameRequest& request, const FrameGeometry& frame,
                   const VisibleBlock& block, std::uint64_t seen) {
  const Targets& t = request.targets;
  const SurfaceScene& scene = *request.surface;
  const bool in_camera = !t.camera_normals.empty();
  SeenNormals out;
  std::uint64_t rest = seen;
  const LitKernels* const lanes = lit_kernels(request.isa);
  const std::uint64_t meshes = lanes == nullptr ? 0 : of_triangles(request, frame, block, seen);
  if (meshes != 0) {
    VisibleBlock of_meshes = block;
    of_meshes.covered = meshes;
    of_meshes.scratch = &kept_triangles(frame);
    lanes->seen_normals(scene.lit, frame, of_meshes, *block.lit, request.samples > 1,
                        in_camera ? scene.camera_rows : nullptr, out);
    rest &= ~meshes;
  }
  if (rest != 0) {
    SurfaceLocator locator(frame, request.samples, false);
    LitTriangle kept{};
    for (std::uint64_t m = rest; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      out.world[i] =
          scene.normal(frame, locator.locate(block.keys[i], block.x0, block.y0, i), kept);
      if (in_camera) out.camera[i] = scene.in_camera(out.world[i]);
    }
  }
  if (!t.normals.empty()) store_block(t.normals, out.world, seen, block.x0, block.y0);
  if (in_camera) store_block(t.camera_normals, out.camera, seen, block.x0, block.y0);
}

}  // namespace

void store_surfaces(const FrameRequest& request, const FrameGeometry& frame,
                    const VisibleBlock& block, std::uint64_t touched) noexcept {
  const Targets& t = request.targets;
  if (!t.instances.empty() || !t.primitives.empty() || !t.instances32.empty() ||
      !t.primitives32.empty())
    store_numbers(request, frame, block, touched);
  if (!t.view_depth.empty() || !t.distance.empty()) store_distances(request, block, touched);
  const bool wants_normals = block.lit != nullptr;
  const bool wants_places = !t.barycentrics.empty() || !t.positions.empty() || !t.scalars.empty();
  if (!wants_normals && !wants_places && t.albedo.empty()) return;
  if (const std::uint64_t empty = touched & ~block.covered; empty != 0)
    store_nothing(request, empty, block.x0, block.y0);
  const std::uint64_t seen = touched & block.covered;
  if (seen == 0) return;
  if (wants_normals) store_normals(request, frame, block, seen);
  std::uint64_t places = wants_places ? seen : 0;
  if (const SeenKernels* const kernels = seen_kernels(request.isa); wants_places && kernels) {
    VisibleBlock triangles = block;
    triangles.covered = of_triangles(request, frame, block, seen);
    if (triangles.covered != 0) TriangleStorer(request, frame, triangles, *kernels).store();
    places &= ~triangles.covered;
  }
  // The rest, and all base colours, one by one.
  SurfaceLocator locator(frame, request.samples, !t.albedo.empty());
  for (std::uint64_t m = t.albedo.empty() ? places : seen; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = block.x0 + i % kBlockSize, y = block.y0 + i / kBlockSize;
    const SeenFragment& f = locator.locate(block.keys[i], block.x0, block.y0, i);
    if ((places >> i & 1) != 0) store_point(request, frame, f, x, y);
    if (!t.albedo.empty()) t.albedo(x, y) = request.surface->albedo(frame, f);
  }
}

}  // namespace rastrum::raster
