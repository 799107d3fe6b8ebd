// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/setup/set_up.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <rastrum/raster/context/added_transparency.hpp>
#include <rastrum/raster/setup/assemble.hpp>
#include <rastrum/scene/mesh_clusters.hpp>

namespace rastrum::raster {
namespace {

/// The corners of a batch, for frames without projected vertices and for meshes whose triangles are
/// no packed list.
struct Corners {
  std::uint32_t indices[kSetupBatch * 3];
  ProjectedVertex vertices[kSetupBatch * 3];

  /// Returns whether all indices are in range.
  bool load(const FrameGeometry& frame, const Draw& draw, std::uint64_t t, std::uint32_t count) {
    if (!load_indices(draw, t, count)) return false;
    project(frame, draw, count * 3);
    return true;
  }
  /// Copies [copy, copy + n) of a draw with is_projected_at_once(); `indices` are into `vertices`.
  bool load_copies(const FrameGeometry& frame, const Draw& draw, std::uint64_t copy,
                   std::uint64_t n) {
    const auto own = static_cast<std::uint32_t>(draw.own_primitives());
    if (!load_indices(draw, copy * own, own)) return false;
    const std::uint32_t first = draw.first_vertex_of(copy);
    for (std::uint32_t i = 0; i < own * 3; ++i) indices[i] -= first;
    for (std::uint32_t i = own * 3; i < own * 3 * n; ++i)
      indices[i] = indices[i - own * 3] + draw.copies.vertices;
    draw.source.project(first, first + draw.copies.vertices * n, frame.viewport, frame.isa,
                        vertices);
    return true;
  }
  /// Vertices of points. Returns whether all indices are in range.
  bool load_points(const FrameGeometry& frame, const Draw& draw, std::uint64_t t,
                   std::uint32_t count) {
    if (draw.points != nullptr && draw.points->indices.empty()) {
      draw.source.project(t, t + count, frame.viewport, frame.isa, vertices);
      return true;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      indices[i] = draw.vertex(t + i, 0);
      if (indices[i] >= draw.vertex_count) return false;
    }
    project(frame, draw, count);
    return true;
  }
  /// All vertices of a draw with is_projected_at_once().
  void load_all(const FrameGeometry& frame, const Draw& draw) {
    draw.source.project(0, draw.vertex_count, frame.viewport, frame.isa, vertices);
  }

 private:
  /// The vertex numbers of triangles [t, t + count), maybe of several copies. False: one is out of
  /// range.
  bool load_indices(const Draw& draw, std::uint64_t t, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count;) {
      const Draw::OfCopy of = draw.of_copy(t + i);
      const auto n = static_cast<std::uint32_t>(
          std::min<std::uint64_t>(count - i, draw.own_primitives() - of.primitive));
      std::uint32_t* const some = indices + std::size_t{i} * 3;
      if (draw.mesh != nullptr)
        draw.mesh->read_triangles(of.primitive, n, some);
      else
        for (std::uint32_t k = 0; k < n; ++k)
          for (int c = 0; c < 3; ++c)
            some[k * 3 + static_cast<std::uint32_t>(c)] = draw.own_vertex(of.primitive + k, c);
      const std::size_t size = draw.own_vertices();
      const std::uint32_t first = draw.first_vertex_of(of.copy);
      for (std::uint32_t k = 0; k < n * 3; ++k) {
        if (some[k] >= size) return false;
        some[k] += first;
      }
      i += n;
    }
    return true;
  }
  /// Fetches or projects the vertices of the first `n` indices.
  void project(const FrameGeometry& frame, const Draw& draw, std::uint32_t n) {
    if (const ProjectedVertex* const projected = frame.projected_of(draw))
      for (std::uint32_t i = 0; i < n; ++i) vertices[i] = projected[indices[i]];
    else
      draw.source.project_indexed({indices, n}, frame.viewport, frame.isa, vertices);
  }
};

/// Whether the fragment kernel may take some of a draw's points.
bool has_small_points(const Draw& draw) {
  return draw.has_points_kernel() && ((draw.points != nullptr && !draw.points->sizes.empty()) ||
                                      point_size_fx8(draw.point_size) <= kMicroPoint);
}

/// Sizes of points for their kernel. A size that is not finite counts as large; the path of large
/// points drops it.
const std::int32_t* sizes_of(const Draw& draw, std::uint64_t first, std::uint32_t count,
                             std::int32_t (&out)[kSetupBatch]) {
  if (draw.points == nullptr || draw.points->sizes.empty()) {
    const std::int32_t size = point_size_fx8(draw.point_size);
    if (size == kSubpixels) return nullptr;
    std::fill_n(out, count, size);
    return out;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const float size = draw.size_of(first + i);
    out[i] = std::isfinite(size) ? point_size_fx8(size) : kMicroPoint + 1;
  }
  return out;
}

struct TriangleSet {
  std::uint64_t bits[kSetupBatch / 64] = {};

  void add(std::uint32_t i) { bits[i / 64] |= std::uint64_t{1} << i % 64; }
  [[nodiscard]] std::uint32_t count() const {
    int n = 0;
    for (const std::uint64_t word : bits) n += std::popcount(word);
    return static_cast<std::uint32_t>(n);
  }
};

/// Leaves primitives [first, first + count) to assemble_primitive, after checking indices.
SetupOutput all_slow(const Draw& draw, std::uint64_t first, std::uint32_t count,
                     std::uint32_t* slow) {
  SetupOutput out;
  const int corners = draw.quadrics != nullptr ? 0 : static_cast<int>(draw.topology);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int corner = 0; corner < corners; ++corner)
      out.index_in_range &= draw.vertex(first + i, corner) < draw.vertex_count;
    slow[out.slow++] = i;
  }
  return out;
}

bool is_deferrable(const QuadricShape& shape) {
  switch (shape.kind) {
    case QuadricKind::sphere:
    case QuadricKind::cone:
      return true;
    case QuadricKind::hull:
      return shape.r0 > 0 && shape.r1 > 0;
    case QuadricKind::open_cone:
    case QuadricKind::disc:
      break;
  }
  return false;
}

/// Whether a draw's flags and faces allow deferral: opaque, seen from outside.
bool may_defer(const Draw& draw, std::uint32_t flags) {
  return draw.quadrics != nullptr && draw.quadrics->clip_to_object() != nullptr &&
         draw.effective_cull() != Cull::front && (flags & (kMayDrop | kTranslucent)) == 0;
}

/// Leaves other quadrics to assemble_primitive.
SetupOutput defer_quadrics(const FrameContext& frame, const Draw& draw, std::uint64_t first,
                           std::uint32_t count, std::uint32_t flags, Piece* out,
                           std::uint32_t* slow) {
  SetupOutput result;
  QuadricShape shapes[kSetupBatch];
  std::uint32_t numbers[kSetupBatch];
  const FrameGeometry& geometry = frame.geometry;
  const QuadricEye eye(*draw.quadrics, geometry.viewport);
  QuadricInput in{&eye,
                  shapes,
                  numbers,
                  0,
                  draw.first_id + first,
                  flags,
                  {0, 0, geometry.width, geometry.height}};
  for (std::uint32_t i = 0; i < count; ++i) {
    numbers[in.count] = i;
    if (draw.quadrics->shape(first + i, shapes[in.count]) == ShapeFate::drawn &&
        is_deferrable(shapes[in.count]))
      ++in.count;
    else
      slow[result.slow++] = i;
  }
  const SetupOutput deferred = frame.kernel.defer(in, out, slow + result.slow);
  result.pieces = deferred.pieces;
  result.slow += deferred.slow;
  return result;
}

/// Room for the most that a kernel writes.
Piece* make_room(Pieces& pieces, MicroSink* micro, BinFragment*& fragments) {
  pieces.data.grow(std::size_t{pieces.count} + kSetupBatch, pieces.count);
  fragments = micro == nullptr ? nullptr : micro->room(kSetupFragments);
  return pieces.data.data() + pieces.count;
}

/// Runs the kernel on as many triangles at a time as there is room for at all samples.
SetupOutput set_up_triangles(const FrameContext& frame, const SetupInput& in, Pieces& pieces,
                             std::uint64_t last_id, MicroSink* micro, std::uint32_t* slow) {
  const auto samples =
      static_cast<std::uint32_t>(in.together ? 1 : std::max<std::size_t>(in.samples.size(), 1));
  // Small triangles have 32-bit ids.
  const bool takes_small = in.samples.empty() && (in.flags & (kMayDrop | kTranslucent)) == 0 &&
                           last_id < std::uint64_t{1} << 32;
  SetupOutput all;
  for (std::uint32_t first = 0; first < in.count; first += kSetupBatch / samples) {
    SetupInput some = in;
    some.first += first;
    some.count = std::min(in.count - first, kSetupBatch / samples);
    some.first_seen = first;
    BinFragment* fragments = nullptr;
    Piece* const room = make_room(pieces, micro, fragments);
    if (micro != nullptr && takes_small) some.small = micro->small_room();
    const SetupOutput out = frame.kernel.setup(some, room, fragments, slow + all.slow);
    all.index_in_range = out.index_in_range;
    if (!out.index_in_range) break;
    pieces.count += out.pieces;
    if (micro != nullptr) micro->written(out.fragments);
    if (some.small != nullptr) micro->small_written(out.small);
    for (std::uint32_t k = 0; k < out.slow; ++k) slow[all.slow + k] += first;
    all.pieces += out.pieces;
    all.micro += out.micro;
    all.small_triangles += out.small_triangles;
    all.slow += out.slow;
  }
  return all;
}

/// How many of the `count` primitives from `first` on have the flags of the first.
std::uint32_t equal_flags(const FrameGeometry& frame, const Draw& draw, std::uint64_t first,
                          std::uint32_t count) {
  if (draw.material_flags.empty() && draw.cut == nullptr) return count;
  // The usual case has its own loop: asking for each triangle's flags took 2 % of a frame.
  if (draw.cut == nullptr && draw.mesh == nullptr && !draw.is_copied() &&
      draw.face_materials.is_packed()) {
    const auto materials =
        draw.face_materials.packed().subspan(static_cast<std::size_t>(first), count);
    const std::uint32_t own = draw.material_flags[materials[0]];
    std::uint32_t n = 1;
    while (n < count && draw.material_flags[materials[n]] == own) ++n;
    return n;
  }
  const std::uint32_t flags = frame.flags_of(draw, first);
  std::uint32_t n = 1;
  while (n < count && frame.flags_of(draw, first + n) == flags) ++n;
  return n;
}

bool has_indices_in_range(const Draw& draw, std::uint64_t first, std::uint32_t count) {
  if (draw.quadrics != nullptr) return true;  // already checked
  for (std::uint64_t p = first; p < first + count; ++p)
    for (int corner = 0; corner < static_cast<int>(draw.topology); ++corner)
      if (draw.vertex(p, corner) >= draw.vertex_count) return false;
  return true;
}

}  // namespace

void Pieces::add(const Piece& piece) {
  data.grow(std::size_t{count} + 1, count);
  Piece& own = data[count++];
  own = piece;
  if (!is_quadric(piece)) return;
  // The two sides of a primitive share a quadric.
  const Piece* const last = count > 1 ? &own - 1 : nullptr;
  const bool is_second = last != nullptr && is_quadric(*last) && last->low == piece.low &&
                         (last->flags ^ piece.flags) == kFacesAway;
  set_quadric(own, is_second ? &quadric_of(*last) : quadrics.add(quadric_of(piece)));
}

std::size_t Pieces::quadric_bytes() const {
  std::size_t bytes = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!is_quadric(data[i])) continue;
    const bool is_second =
        i > 0 && is_quadric(data[i - 1]) && &quadric_of(data[i - 1]) == &quadric_of(data[i]);
    if (!is_second) bytes += quadric_of(data[i]).bytes();
  }
  return bytes;
}

namespace {

class SetUp {
 public:
  SetUp(const FrameContext& frame, Pieces& pieces, const SetUpWay& way)
      : frame_(frame),
        geometry_(frame.geometry),
        pieces_(pieces),
        samples_(sample_offsets(frame.request.samples)),
        // The filter's errors are those for sorted pieces.
        micro_(transparency::filter_of(frame.request.transparency) != 0 ? nullptr : way.micro),
        bins_(way.bins),
        defers_(way.defers),
        together_(way.together) {}

  /// Primitives [first, last), maybe of several draws. Returns whether all indices were in range.
  bool range(std::uint64_t first, std::uint64_t last);
  /// A cluster of a mesh. `next`: what is set up after it, or null.
  void cluster(const SetupRun& run, const SetupRun* next);

 private:
  /// Primitives of one draw with the same flags.
  struct Batch {
    const Draw& draw;
    std::uint64_t first = 0;  ///< in the draw
    /// The number of each primitive, added to `first`; null: in order.
    const std::uint32_t* numbers = nullptr;
    std::uint32_t count = 0;
    std::uint32_t flags = 0;
    bool as_points = false;  ///< by the points kernel, with loaded vertices

    [[nodiscard]] std::uint64_t primitive(std::uint32_t i) const {
      return first + (numbers != nullptr ? numbers[i] : i);
    }
  };
  [[nodiscard]] SetupInput input_of(const Draw& draw) const {
    SetupInput input;
    input.cull = draw.effective_cull();
    input.view = image();
    input.bin_columns = static_cast<std::uint32_t>((geometry_.width + kBinSize - 1) / kBinSize);
    input.micro = micro_ != nullptr && !together_;
    input.bins = bins_;
    return input;
  }
  /// Whether a sample of the picture lies in the box of `piece`, a piece for all samples.
  [[nodiscard]] bool may_be_seen(const Piece& piece) const {
    return std::ranges::any_of(samples_, [&](SampleOffset at) {
      return !piece_bounds(moved(piece, at), image()).empty();
    });
  }
  [[nodiscard]] Rect image() const { return {0, 0, geometry_.width, geometry_.height}; }
  void project(const Draw& draw, std::uint64_t copy, const MeshCluster& cluster,
               ProjectedVertex* all);
  bool batch(const Batch& of, const FrameGeometry& slow_geometry, SetupInput& input);

  const FrameContext& frame_;
  const FrameGeometry& geometry_;
  Pieces& pieces_;
  const std::span<const SampleOffset> samples_;
  MicroSink* const micro_;
  const BinNumbers bins_;
  const bool defers_, together_;
  std::uint32_t slow_[kSetupBatch];
  Corners corners_;
};

bool SetUp::range(std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t id = first; id < last;) {
    const Draw& draw = geometry_.draw_of(id);
    const std::uint64_t t = id - draw.first_id;
    if (!draw.visible) {
      const std::uint64_t hidden = std::min(last - id, draw.primitive_count - t);
      pieces_.triangles.culled += hidden;
      id += hidden;
      continue;
    }
    // A batch takes as many small copies as there is room for, or at most one other.
    const Draw::OfCopy of = draw.of_copy(t);
    const bool at_once = is_projected_at_once(draw);
    const std::uint64_t own = draw.own_primitives();
    const std::uint64_t copies =
        at_once ? std::min(kSetupBatch / own, draw.copies.count - of.copy) : 1;
    const auto most = static_cast<std::uint32_t>(
        std::min({std::uint64_t{kSetupBatch}, last - id, copies * own - of.primitive}));
    // Clip planes read corners before the kernel checks them.
    if (draw.cut != nullptr && !has_indices_in_range(draw, t, most)) return false;
    const std::uint32_t count = equal_flags(geometry_, draw, t, most);
    const std::uint32_t flags = geometry_.flags_of(draw, t);
    if ((flags & kCutAway) != 0) {
      pieces_.triangles.culled += count;
      id += count;
      continue;
    }
    SetupInput input = input_of(draw);
    input.first = t;
    input.count = count;
    input.first_id = draw.first_id;
    const ProjectedVertex* projected = geometry_.projected_of(draw);
    const bool in_place = draw.mesh == nullptr;
    if (in_place && projected == nullptr && at_once && !draw.is_copied()) {
      corners_.load_all(geometry_, draw);
      projected = corners_.vertices;
    }
    if (in_place && projected != nullptr) {
      input.indices = draw.indices.empty() ? nullptr : draw.indices.data();
      input.vertices = projected + draw.first_vertex_of(of.copy);
      input.vertex_count = draw.own_vertices();
      input.first = of.primitive;
      input.first_id = id - of.primitive;
    } else if (at_once && draw.is_copied()) {
      if (!corners_.load_copies(geometry_, draw, of.copy, copies)) return false;
      input.indices = corners_.indices;
      input.vertices = corners_.vertices;
      input.vertex_count = draw.copies.vertices * copies;
      input.first = of.primitive;
      input.first_id = id - of.primitive;
    } else if (draw.has_kernel()) {
      if (!corners_.load(geometry_, draw, t, count)) return false;
      input.vertices = corners_.vertices;
      input.vertex_count = std::size_t{count} * 3;
      input.first = 0;
      input.first_id = id;
    }
    const bool as_points = micro_ != nullptr && (flags & kMayDrop) == 0 && has_small_points(draw);
    if (as_points && !corners_.load_points(geometry_, draw, t, count)) return false;
    if (!batch({draw, t, nullptr, count, flags, as_points}, geometry_, input)) return false;
    id += count;
  }
  return true;
}

void SetUp::cluster(const SetupRun& run, const SetupRun* next) {
  const std::uint64_t first = run.first;
  const Draw& draw = geometry_.draw_of(first);
  const MeshClusters& mesh = *draw.clusters;
  const MeshCluster& cluster = mesh.clusters[run.cluster];
  const std::uint64_t copy = draw.of_copy(first - draw.first_id).copy;
  const std::uint32_t* const name = mesh.vertex.data() + cluster.first_vertex;
  const std::uint8_t* const corner = mesh.corners.data() + cluster.first_triangle * std::size_t{3};
  const std::uint32_t* const numbers = mesh.triangle.data() + cluster.first_triangle;
  SetupInput input = input_of(draw);
  input.indices = corners_.indices;
  input.first = 0;
  input.count = cluster.triangles;
  input.first_id = first;
  input.numbers = numbers;
  FrameGeometry slow_geometry = geometry_;
  // Where shading looks for them.
  ProjectedVertex* const all =
      draw.first_vertex != kNotProjected && frame_.projected != nullptr
          ? frame_.projected + draw.first_vertex + draw.first_vertex_of(copy)
          : nullptr;
  if (draw.is_projected) {
    for (std::uint32_t v = 0; v < cluster.vertices; ++v) corners_.vertices[v] = all[name[v]];
    if (next != nullptr && next->first == first && next->cluster != SetupRun::kPlain) {
      const MeshCluster& other = mesh.clusters[next->cluster];
      for (std::uint32_t v = 0; v < other.vertices; ++v)
        __builtin_prefetch(all + mesh.vertex[other.first_vertex + v]);
    }
  } else {
    project(draw, copy, cluster, all);
    // Other threads may be writing vertices, so the clipper projects its own.
    slow_geometry.projected = nullptr;
  }
  for (std::uint32_t i = 0; i < cluster.triangles * 3U; ++i) corners_.indices[i] = corner[i];
  input.vertices = corners_.vertices;
  input.vertex_count = cluster.vertices;
  // A cluster has one material.
  const std::uint32_t flags = geometry_.flags_of(draw, first - draw.first_id + numbers[0]);
  (void)batch({draw, first - draw.first_id, numbers, cluster.triangles, flags, false},
              slow_geometry, input);
}

/// Projects a cluster's vertices to `corners_` and, if there is a place, to `all`.
void SetUp::project(const Draw& draw, std::uint64_t copy, const MeshCluster& cluster,
                    ProjectedVertex* all) {
  const MeshClusters& mesh = *draw.clusters;
  const MatrixVertices matrix = draw.source.matrix_of(copy);
  ProjectedVertex* const vertices = corners_.vertices;
  const std::uint32_t* const name = mesh.vertex.data() + cluster.first_vertex;
  for (std::uint32_t v = 0; all != nullptr && v < cluster.vertices; ++v)
    __builtin_prefetch(all + name[v], 1);
  if (mesh.wide.empty())
    frame_.kernel.project(mesh.positions.data() + cluster.first_vertex, cluster.vertices,
                          matrix.object_to_clip32, geometry_.viewport, vertices);
  else
    frame_.kernel.project64(mesh.wide.data() + cluster.first_vertex, cluster.vertices,
                            matrix.object_to_clip, geometry_.viewport, vertices);
  // Clusters share vertices, so several threads may write the same bits. Each half must be one
  // write.
  for (std::uint32_t v = 0; all != nullptr && v < cluster.vertices; ++v) {
    const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(vertices[v]);
    auto* const to = reinterpret_cast<std::uint64_t*>(all + name[v]);
    __atomic_store_n(to, halves[0], __ATOMIC_RELAXED);
    __atomic_store_n(to + 1, halves[1], __ATOMIC_RELAXED);
  }
}

/// `input` lacks only the flags and samples.
bool SetUp::batch(const Batch& of, const FrameGeometry& slow_geometry, SetupInput& input) {
  const Draw& draw = of.draw;
  const std::uint32_t count = of.count;
  TriangleSet seen, clipped, dropped;
  std::uint32_t seen_points = 0;
  input.flags = of.flags;
  // Without transparency, translucent surfaces are drawn as opaque.
  if (frame_.request.transparency.method == Transparency::none) input.flags &= ~kTranslucent;
  SetupOutput of_all, of_points;
  const bool by_kernel = !of.as_points && draw.has_kernel();
  if (by_kernel) {
    if (samples_.size() > 1) {
      input.samples = samples_;
      input.together = together_;
      input.seen = seen.bits;
    }
    of_all = set_up_triangles(frame_, input, pieces_, draw.first_id + draw.primitive_count, micro_,
                              slow_);
    if (!of_all.index_in_range) return false;
  }
  // Like the kernel, this path sets some triangles up once for all samples.
  const bool all_samples =
      together_ && draw.quadrics == nullptr && draw.topology == Topology::triangles;
  const int reach = all_samples ? reach_of(samples_) : 0;
  for (std::uint32_t sample = 0; sample < (all_samples ? 1 : samples_.size()); ++sample) {
    const SampleOffset at = all_samples ? SampleOffset{} : samples_[sample];
    SetupOutput out = of_all;
    // A point covers all samples of its pixels, so its fragments are for all.
    if (of.as_points && together_ && sample > 0) {
      out = of_points;
    } else if (!by_kernel) {
      const std::uint32_t own_flags = input.flags | sample << kSampleShift;
      BinFragment* fragments = nullptr;
      Piece* const room = make_room(pieces_, micro_, fragments);
      if (of.as_points) {
        std::int32_t sizes[kSetupBatch];
        out = frame_.kernel.points(
            {corners_.vertices, count, sizes_of(draw, of.first, count, sizes),
             draw.first_id + of.first, own_flags | (draw.is_round() ? kRound : 0), image(),
             input.bin_columns},
            fragments, slow_);
        seen_points = out.micro;
        of_points = out;
      } else if (defers_ && may_defer(draw, own_flags)) {
        out = defer_quadrics(frame_, draw, of.first, count, own_flags, room, slow_);
      } else {
        out = all_slow(draw, of.first, count, slow_);
      }
      if (!out.index_in_range) return false;
      pieces_.count += out.pieces;
      if (micro_ != nullptr) micro_->written(out.fragments);
    }
    std::uint32_t slow_culled = 0;
    for (std::uint32_t k = 0; k < out.slow; ++k) {
      bool is_seen = !all_samples;
      Fate fate = assemble_primitive(
          slow_geometry, draw, of.primitive(slow_[k]),
          [&](const Piece& piece) {
            if (all_samples && !may_be_seen(piece)) return;
            is_seen = true;
            pieces_.add(piece);
            if (all_samples) pieces_.data[pieces_.count - 1].flags |= kAllSamples;
          },
          sample, at, reach);
      if (!is_seen && (fate == Fate::drawn || fate == Fate::clipped)) fate = Fate::culled;
      if (fate == Fate::drawn || fate == Fate::clipped) seen.add(slow_[k]);
      if (fate == Fate::dropped) dropped.add(slow_[k]);
      if (fate == Fate::clipped) clipped.add(slow_[k]);
      slow_culled += fate == Fate::culled;
    }
    if (samples_.size() == 1)
      pieces_.triangles.culled +=
          count - out.pieces - out.micro - out.small_triangles - out.slow + slow_culled;
  }
  if (samples_.size() > 1)
    pieces_.triangles.culled += count - seen.count() - seen_points - dropped.count();
  pieces_.triangles.dropped += dropped.count();
  pieces_.triangles.clipped += clipped.count();
  return true;
}

}  // namespace

bool set_up(const FrameContext& frame, std::uint64_t first, std::uint64_t last, Pieces& pieces,
            const SetUpWay& way) {
  return SetUp(frame, pieces, way).range(first, last);
}

bool set_up(const FrameContext& frame, std::span<const SetupRun> runs, Pieces& pieces,
            const SetUpWay& way) {
  SetUp set_up(frame, pieces, way);
  for (const SetupRun& run : runs) {
    if (run.cluster != SetupRun::kPlain)
      set_up.cluster(run, &run == &runs.back() ? nullptr : &run + 1);
    else if (!set_up.range(run.first, run.first + run.count))
      return false;
  }
  return true;
}

void count_triangles(FrameContext& frame, const FrameStats::Triangles& triangles) {
  if (!frame.first_band) return;
  frame.stats.triangles.dropped += triangles.dropped;
  frame.stats.triangles.culled += triangles.culled;
  frame.stats.triangles.clipped += triangles.clipped;
}

}  // namespace rastrum::raster
