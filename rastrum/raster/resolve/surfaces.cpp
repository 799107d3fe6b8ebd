#include <rastrum/raster/resolve/surfaces.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/draws/vertices_of.hpp>
#include <rastrum/raster/resolve/distances.hpp>
#include <rastrum/raster/resolve/surface_lanes.hpp>
#include <rastrum/raster/resolve/surface_point.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/lit_triangle.hpp>

namespace rastrum::raster {
namespace {

/// Stores the numbers that a key alone tells: which primitive of which draw.
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
    std::fill_n(view_depth, 64, t.no_distance);
    std::fill_n(distance, 64, t.no_distance);
  } else {
    distance_kernel(request.isa)(*request.surface, block.keys, block.x0, block.y0, t.no_distance,
                                 view_depth, t.distance.empty() ? nullptr : distance);
  }
  if (!t.view_depth.empty()) store_block(t.view_depth, view_depth, touched, block.x0, block.y0);
  if (!t.distance.empty()) store_block(t.distance, distance, touched, block.x0, block.y0);
}

void store_point(const FrameRequest& request, const FrameGeometry& frame, const SeenFragment& f,
                 int x, int y) {
  const Targets& t = request.targets;
  const SurfaceScene* const scene = request.surface;
  const auto store = [&](const auto& target, const auto& value) {
    if (!target.empty()) target(x, y) = value();
  };
  store(t.barycentrics, [&] {
    return Vec2{static_cast<float>(f.weights.b[1]), static_cast<float>(f.weights.b[2])};
  });
  store(t.positions, [&] { return Vec3(scene->position(f)); });
  store(t.albedo, [&] { return scene->albedo(frame, f); });
  store(t.scalars, [&] {
    const double value = scene->scalar(frame, f);
    return std::isnan(value) ? kNoNumber : static_cast<float>(value);
  });
}

/// Stores the values that targets of surfaces have where nothing is.
void store_nothing(const Targets& t, std::uint64_t where, int x0, int y0) {
  for_each_target([&](const auto& row) {
    const auto& target = t.*row.image;
    if (target.empty() || !row.is_of_surface()) return;
    const auto nothing = empty_pixel(row, t);
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

/// Triangles of a frame that a thread has found, as lanes read them: blocks side by side see the
/// same ones. There is a place for each id modulo kPlaces.
struct TriangleCache {
  static constexpr std::size_t kPlaces = 256;  // 60 KiB; a bin of 64² px sees about as many at once

  struct Owner {
    std::size_t draw = 0;
    std::uint64_t copy = 0;
    std::uint64_t run = 0;  ///< the last that used it
  };
  std::uint64_t frame = 0;  ///< FrameGeometry::number of what is here
  std::uint64_t runs = 0;   ///< so far
  std::uint64_t ids[kPlaces];
  Owner owners[kPlaces];
  SurfaceRun::Triangle triangles[kPlaces];
  SurfaceRun run;      ///< here, so that its arrays are not made anew for each block
  KeptTriangles kept;  ///< for normals that no shader has left

  void begin(std::uint64_t number) {
    if (number == frame && number != 0) return;
    frame = number;
    std::fill_n(ids, kPlaces, kMaxId + 1);
    kept.clear();
  }
};

/// Stores weights and positions for many pixels of triangles at once, as store_point does for one.
class RunStorer {
 public:
  RunStorer(const FrameRequest& request, const FrameGeometry& frame, const VisibleBlock& block,
            SurfaceLanes lanes, TriangleCache& cache)
      : request_(request),
        block_(block),
        lanes_(lanes),
        frame_(frame),
        cache_(cache),
        run_(cache.run) {
    cache.begin(frame.number);
    ++cache.runs;
    run_.triangles = cache.triangles;
    run_.object_to_world = nullptr;
  }

  /// Adds the pixels of one primitive, the first of them i.
  void add(int i, std::uint64_t pixels) {
    const std::uint64_t id = id_of_key(block_.keys[i]);
    const std::size_t place = id % TriangleCache::kPlaces;
    if (cache_.ids[place] != id && !fetch(id, place)) {
      if (!locator_) locator_.emplace(frame_, request_.samples, false);
      for (; pixels != 0; pixels &= pixels - 1) {
        const int at = std::countr_zero(pixels);
        const SeenFragment& f = locator_->locate(block_.keys[at], block_.x0, block_.y0, at);
        store_point(request_, frame_, f, block_.x0 + at % kBlockSize, block_.y0 + at / kBlockSize);
      }
      return;
    }
    join(place);
    const std::int64_t first = static_cast<std::int64_t>(place) * SurfaceRun::kStride;
    for (; pixels != 0; pixels &= pixels - 1, ++n_) {
      const int at = std::countr_zero(pixels);
      order_[n_] = static_cast<std::uint8_t>(at);
      run_.x[n_] = block_.x0 + at % kBlockSize + 0.5;
      run_.y[n_] = block_.y0 + at / kBlockSize + 0.5;
      run_.place[n_] = first;
    }
  }

  void finish() {
    if (n_ == 0) return;
    run_.n = n_;
    lanes_(run_);
    const Targets& t = request_.targets;
    store(t.barycentrics, [&](int k) { return Vec2{run_.b1[k], run_.b2[k]}; });
    store(t.positions, [&](int k) { return run_.position[k]; });
    n_ = triangles_ = 0;
    ++cache_.runs;
  }

 private:
  template <class T, class Value>
  void store(const ImageView<T>& target, const Value& value) const {
    if (target.empty()) return;
    T* const first = target.row(block_.y0) + block_.x0;
    if (n_ == 64 && triangles_ == 1) {
      for (int y = 0; y < kBlockSize; ++y)
        for (int x = 0; x < kBlockSize; ++x)
          first[target.stride * y + x] = value(y * kBlockSize + x);
      return;
    }
    for (int k = 0; k < n_; ++k) first[target.stride * (order_[k] / 8) + order_[k] % 8] = value(k);
  }

  /// Finds a triangle anew and keeps it. Returns whether the primitive is one.
  bool fetch(std::uint64_t id, std::size_t place) {
    if (draw_ == nullptr || id - draw_->first_id >= draw_->primitive_count)
      draw_ = &frame_.draw_of(id);
    if (draw_->topology != Topology::triangles || draw_->quadrics != nullptr) return false;
    TriangleCache::Owner& owner = cache_.owners[place];
    if (owner.run == cache_.runs) finish();  // lanes still need the old one
    const Draw::OfCopy of = draw_->of_copy(id - draw_->first_id);
    cache_.ids[place] = id;
    owner = {static_cast<std::size_t>(draw_ - frame_.draws.data()), of.copy, 0};
    found_.draw = owner.draw;
    found_.triangle = of.primitive;
    draw_->vertices(id - draw_->first_id, found_.vertex);
    const WeightPlanes w = weight_planes(frame_, *draw_, found_.vertex);
    if (draw_->is_copied())
      for (std::uint32_t& v : found_.vertex) v %= draw_->copies.vertices;
    SurfaceRun::Triangle& t = cache_.triangles[place];
    t.x0 = w.x0;
    t.y0 = w.y0;
    for (int c = 0; c < 3; ++c) {
      t.r[c] = w.r[c];
      t.p[c] = w.p[c];
      t.q[c] = w.q[c];
    }
    if (request_.targets.positions.empty()) return true;
    const InstanceView& instance = request_.surface->instance(owner.draw, of.copy);
    const ArrayView<Vec3>& positions = *vertices_of(instance.geometry).positions;
    for (int c = 0; c < 3; ++c) set(t.position[c], positions.wide(found_.vertex[c]));
    return true;
  }

  /// Adds a triangle to this run. A triangle of another instance begins a run of its own.
  void join(std::size_t place) {
    TriangleCache::Owner& owner = cache_.owners[place];
    if (n_ > 0 && (owner.draw != run_draw_ || owner.copy != run_copy_)) finish();
    if (n_ == 0) begin(owner.draw, owner.copy);
    owner.run = cache_.runs;
    ++triangles_;
  }

  void begin(std::size_t draw, std::uint64_t copy) {
    run_draw_ = draw;
    run_copy_ = copy;
    if (!request_.targets.positions.empty())
      run_.object_to_world = &request_.surface->instance(draw, copy).object_to_world;
  }

  static void set(double (&to)[3], Vec3d v) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
  }

  const FrameRequest& request_;
  const VisibleBlock& block_;
  SurfaceLanes lanes_;
  std::optional<SurfaceLocator> locator_;  ///< of what is stored one by one
  const FrameGeometry& frame_;
  TriangleCache& cache_;
  const Draw* draw_ = nullptr;  ///< of what was fetched last
  SeenFragment found_;          ///< the same: its triangle and vertices
  std::size_t run_draw_ = 0;    ///< whose pixels the run has
  std::uint64_t run_copy_ = 0;
  int n_ = 0;  ///< pixels of the run
  int triangles_ = 0;
  std::uint8_t order_[64];  ///< pixels of the block, as lanes have them
  SurfaceRun& run_;
};

/// The cache of the calling thread. It is large, but made once: frames tell themselves apart by
/// their numbers.
TriangleCache& triangle_cache() {
  static thread_local TriangleCache cache;
  return cache;
}

/// The pixels of `seen` that see meshes.
std::uint64_t of_meshes(const FrameRequest& request, const FrameGeometry& frame,
                        const VisibleBlock& block, std::uint64_t seen) {
  const SurfaceScene& scene = *request.surface;
  if (scene.only_meshes) return seen;
  std::uint64_t meshes = 0;
  const Draw* draw = nullptr;
  bool is_mesh = false;
  for (std::uint64_t m = seen; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const std::uint64_t id = id_of_key(block.keys[i]);
    if (draw == nullptr || id - draw->first_id >= draw->primitive_count) {
      draw = &frame.draw_of(id);
      const auto place = static_cast<std::size_t>(draw - frame.draws.data());
      is_mesh = scene.lit.draws[place].mesh != nullptr;
    }
    meshes |= std::uint64_t{is_mesh} << i;
  }
  return meshes;
}

void store_normals(const FrameRequest& request, const FrameGeometry& frame,
                   const VisibleBlock& block, std::uint64_t seen) {
  const Targets& t = request.targets;
  const SurfaceScene& scene = *request.surface;
  const bool in_camera = !t.camera_normals.empty();
  SeenNormals out;
  std::uint64_t rest = seen;
  if (const std::uint64_t meshes = of_meshes(request, frame, block, seen); meshes != 0) {
    VisibleBlock own = block;
    own.covered = meshes;
    TriangleCache& cache = triangle_cache();
    cache.begin(frame.number);
    own.scratch = &cache.kept;
    if (seen_normals_simd(request.isa, scene.lit, frame, own, *block.lit, request.samples > 1,
                          in_camera ? scene.camera_rows : nullptr, out))
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
  const bool wants_places = !t.barycentrics.empty() || !t.positions.empty();
  const bool wants_values = !t.albedo.empty() || !t.scalars.empty();
  if (!wants_normals && !wants_places && !wants_values) return;
  if (const std::uint64_t empty = touched & ~block.covered; empty != 0)
    store_nothing(t, empty, block.x0, block.y0);
  const std::uint64_t seen = touched & block.covered;
  if (seen == 0) return;
  if (wants_normals) store_normals(request, frame, block, seen);
  if (!wants_places && !wants_values) return;
  const SurfaceLanes lanes = surface_lanes(request.isa);
  if (lanes != nullptr && !wants_values) {
    RunStorer run(request, frame, block, lanes, triangle_cache());
    const SameId same = same_id(request.isa);
    for (std::uint64_t rest = seen; rest != 0;) {
      const int first = std::countr_zero(rest);
      const std::uint64_t pixels = rest & same(block.keys, id_of_key(block.keys[first]));
      run.add(first, pixels);
      rest &= ~pixels;
    }
    run.finish();
    return;
  }
  SurfaceLocator locator(frame, request.samples, !t.albedo.empty());
  for (std::uint64_t m = seen; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    store_point(request, frame, locator.locate(block.keys[i], block.x0, block.y0, i),
                block.x0 + i % kBlockSize, block.y0 + i / kBlockSize);
  }
}

}  // namespace rastrum::raster
