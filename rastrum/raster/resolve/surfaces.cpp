#include <rastrum/raster/resolve/surfaces.hpp>

#include <bit>
#include <cmath>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/draws/vertices_of.hpp>
#include <rastrum/raster/resolve/distances.hpp>
#include <rastrum/raster/resolve/surface_lanes.hpp>
#include <rastrum/raster/resolve/surface_point.hpp>

namespace rastrum::raster {
namespace {

/// What a key alone tells: which primitive of which draw.
void store_numbers(const FrameRequest& request, const FrameGeometry& frame,
                   const VisibleBlock& block, std::uint64_t touched) {
  const Targets& t = request.targets;
  const SurfaceScene* const scene = request.surface;
  std::int64_t instances[64], primitives[64];
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
  if (!t.instances.empty()) store_block(t.instances, instances, touched, block.x0, block.y0);
  if (!t.primitives.empty()) store_block(t.primitives, primitives, touched, block.x0, block.y0);
}

void store_distances(const FrameRequest& request, const VisibleBlock& block,
                     std::uint64_t touched) {
  const Targets& t = request.targets;
  alignas(64) float view_depth[64], distance[64];
  if (block.covered == 0) {
    std::fill_n(view_depth, 64, kNoDistance);
    std::fill_n(distance, 64, kNoDistance);
  } else {
    distance_kernel(request.isa)(*request.surface, block.keys, block.x0, block.y0, view_depth,
                                 t.distance.empty() ? nullptr : distance);
  }
  if (!t.view_depth.empty()) store_block(t.view_depth, view_depth, touched, block.x0, block.y0);
  if (!t.distance.empty()) store_block(t.distance, distance, touched, block.x0, block.y0);
}

/// `f`: null where nothing is.
void store_point(const FrameRequest& request, const FrameGeometry& frame, const SeenFragment* f,
                 int x, int y, CornerNormals& corners) {
  const Targets& t = request.targets;
  const SurfaceScene* const scene = request.surface;
  const auto store = [&](const auto& target, auto nothing, const auto& value) {
    if (!target.empty()) target(x, y) = f == nullptr ? nothing : value();
  };
  store(t.barycentrics, Vec2{}, [&] {
    return Vec2{static_cast<float>(f->weights.b[1]), static_cast<float>(f->weights.b[2])};
  });
  store(t.positions, Vec3{}, [&] { return Vec3(scene->position(*f)); });
  if (!t.normals.empty() || !t.camera_normals.empty()) {
    const Vec3d normal = f == nullptr ? Vec3d{} : scene->normal(*f, corners);
    store(t.normals, Vec3{}, [&] { return Vec3(normal); });
    store(t.camera_normals, Vec3{}, [&] { return Vec3(scene->in_camera(normal)); });
  }
  store(t.albedo, Vec4{}, [&] { return scene->albedo(frame, *f); });
  store(t.scalars, kNoNumber, [&] {
    const double value = scene->scalar(frame, *f);
    return std::isnan(value) ? kNoNumber : static_cast<float>(value);
  });
}

/// What store_point stores, of many pixels of triangles at once.
class RunStorer {
 public:
  RunStorer(const FrameRequest& request, const FrameGeometry& frame, const VisibleBlock& block,
            SurfaceLanes lanes)
      : request_(request),
        block_(block),
        lanes_(lanes),
        locator_(frame, request.samples, false),
        frame_(frame) {
    std::fill_n(triangle_of_, 64, -1);
    run_.scene = request.surface;
    run_.in_camera = !request.targets.camera_normals.empty();
  }

  /// What lies at pixel i of the block.
  void add(int i) {
    const std::uint64_t id = id_of_key(block_.keys[i]);
    int t = run_.triangle_count - 1;
    if (t < 0 || id != ids_[t]) t = i < kBlockSize ? -1 : triangle_of_[i - kBlockSize];
    if (t < 0 || id != ids_[t]) {
      const SeenFragment& f = locator_.locate(block_.keys[i], block_.x0, block_.y0, i);
      if (frame_.draws[f.draw].topology != Topology::triangles || f.quadric != nullptr) {
        store_point(request_, frame_, &f, block_.x0 + i % kBlockSize, block_.y0 + i / kBlockSize,
                    corners_);
        return;
      }
      t = add_triangle(f);
    }
    triangle_of_[i] = t;
    pixels_[run_.n] = i;
    run_.add(block_.x0 + i % kBlockSize, block_.y0 + i / kBlockSize, t);
  }

  void finish() {
    if (run_.n == 0) return;
    lanes_(run_);
    const Targets& t = request_.targets;
    for (int k = 0; k < run_.n; ++k) {
      const int x = block_.x0 + pixels_[k] % kBlockSize, y = block_.y0 + pixels_[k] / kBlockSize;
      const auto vector = [&](const float(&v)[3][64]) { return Vec3{v[0][k], v[1][k], v[2][k]}; };
      if (!t.barycentrics.empty()) t.barycentrics(x, y) = {run_.b1[k], run_.b2[k]};
      if (!t.positions.empty()) t.positions(x, y) = vector(run_.position);
      if (!t.normals.empty()) t.normals(x, y) = vector(run_.normal);
      if (!t.camera_normals.empty()) t.camera_normals(x, y) = vector(run_.camera_normal);
    }
  }

 private:
  /// Its number. What is of another instance begins a run of its own.
  int add_triangle(const SeenFragment& f) {
    if (run_.n > 0 && (f.draw != draw_ || f.copy != copy_)) {
      finish();
      run_.clear();
      std::fill_n(triangle_of_, 64, -1);
    }
    if (run_.n == 0) begin(f);
    ids_[run_.triangle_count] = f.id;
    SurfaceRun::Triangle& t = run_.add_triangle(*f.planes);
    if (run_.normal_matrix != nullptr) {
      Vec3d normals[3];
      request_.surface->normals_at_corners(f, normals);
      for (int c = 0; c < 3; ++c) set(t.normal[c], normals[c]);
    }
    if (run_.object_to_world != nullptr)
      for (int c = 0; c < 3; ++c) set(t.position[c], positions_->wide(f.vertex[c]));
    return run_.triangle_count - 1;
  }

  void begin(const SeenFragment& f) {
    const Targets& t = request_.targets;
    draw_ = f.draw;
    copy_ = f.copy;
    if (!t.positions.empty()) {
      const InstanceView& instance = request_.surface->instance(f.draw, f.copy);
      run_.object_to_world = &instance.object_to_world;
      positions_ = vertices_of(instance.geometry).positions;
    }
    if (t.normals.empty() && t.camera_normals.empty()) return;
    const LitDraw& lit = request_.surface->lit.draws[f.draw];
    run_.normal_matrix = lit.normal_matrix;
    if (f.copy == 0) return;
    of_copy_ = lit.of(request_.surface->instance(f.draw, f.copy));
    run_.normal_matrix = of_copy_.normal_matrix;
  }

  static void set(double (&to)[3], Vec3d v) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
  }

  const FrameRequest& request_;
  const VisibleBlock& block_;
  SurfaceLanes lanes_;
  SurfaceLocator locator_;
  const FrameGeometry& frame_;
  CornerNormals corners_;   ///< of what is stored one by one
  std::size_t draw_ = 0;    ///< of the run
  std::uint64_t copy_ = 0;  ///< the same
  LitDraw of_copy_;         ///< the same, if it is not its draw's first
  const ArrayView<Vec3>* positions_ = nullptr;
  std::uint64_t ids_[64];  ///< of the run's triangles
  int triangle_of_[64];    ///< of each pixel of the block; -1: none of this run
  int pixels_[64];         ///< of the block, of each of the run
  SurfaceRun run_;
};

}  // namespace

void store_surfaces(const FrameRequest& request, const FrameGeometry& frame,
                    const VisibleBlock& block, std::uint64_t touched) noexcept {
  const Targets& t = request.targets;
  if (!t.instances.empty() || !t.primitives.empty()) store_numbers(request, frame, block, touched);
  if (!t.view_depth.empty() || !t.distance.empty()) store_distances(request, block, touched);
  if (t.barycentrics.empty() && t.positions.empty() && t.normals.empty() &&
      t.camera_normals.empty() && t.albedo.empty() && t.scalars.empty())
    return;
  CornerNormals corners;
  const auto store = [&](const SeenFragment* f, int i) {
    store_point(request, frame, f, block.x0 + i % kBlockSize, block.y0 + i / kBlockSize, corners);
  };
  for (std::uint64_t m = touched & ~block.covered; m != 0; m &= m - 1)
    store(nullptr, std::countr_zero(m));
  const std::uint64_t seen = touched & block.covered;
  if (seen == 0) return;
  const SurfaceLanes lanes = surface_lanes(request.isa);
  if (lanes != nullptr && t.albedo.empty() && t.scalars.empty()) {
    RunStorer run(request, frame, block, lanes);
    for (std::uint64_t m = seen; m != 0; m &= m - 1) run.add(std::countr_zero(m));
    run.finish();
    return;
  }
  SurfaceLocator locator(frame, request.samples, !t.albedo.empty());
  for (std::uint64_t m = seen; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    store(&locator.locate(block.keys[i], block.x0, block.y0, i), i);
  }
}

}  // namespace rastrum::raster
