#include <rastrum/raster/set_up.hpp>

#include <algorithm>

#include <rastrum/raster/assemble.hpp>
#include <rastrum/raster/resolve.hpp>

namespace rastrum::raster {
namespace {

/// Triangles of a task: what it makes stays in a core's L2 cache.
constexpr std::uint64_t kGroup = 4096;

/// The corners of a batch, for frames that keep no projected vertices.
struct Corners {
  std::uint32_t indices[kSetupBatch * 3];
  ProjectedVertex vertices[kSetupBatch * 3];

  /// Returns whether all indices are in range.
  bool project(const FrameGeometry& frame, const Draw& draw, std::uint64_t t, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i)
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t index = draw.vertex(t + i, c);
        if (index >= draw.vertex_count) return false;
        indices[i * 3 + static_cast<std::uint32_t>(c)] = index;
      }
    draw.source->project_indexed({indices, count * 3}, frame.viewport, frame.isa, vertices);
    return true;
  }
};

/// Leaves primitives [first, first + count) to assemble_primitive, which wants indices in range.
SetupOutput all_slow(const Draw& draw, std::uint64_t first, std::uint32_t count,
                     std::uint32_t* slow) {
  SetupOutput out;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int corner = 0; corner < static_cast<int>(draw.topology); ++corner)
      out.index_in_range &= draw.vertex(first + i, corner) < draw.vertex_count;
    slow[out.slow++] = i;
  }
  return out;
}

/// How many of the `count` primitives from `first` on have the flags of the first.
std::uint32_t equal_flags(const Draw& draw, std::uint64_t first, std::uint32_t count) {
  if (draw.material_flags.empty()) return count;
  std::uint32_t n = 1;
  while (n < count && draw.flags_of(first + n) == draw.flags_of(first)) ++n;
  return n;
}

}  // namespace

bool set_up(const Frame& frame, std::uint64_t first, std::uint64_t last, Pieces& pieces,
            MicroSink* micro) {
  const FrameGeometry& geometry = frame.geometry;
  const Rect image{0, 0, geometry.width, geometry.height};
  std::uint32_t slow[kSetupBatch];
  Corners corners;

  for (std::uint64_t id = first; id < last;) {
    const Draw& draw = geometry.draw_of(id);
    const std::uint64_t t = id - draw.first_id;
    const std::uint32_t count = equal_flags(
        draw, t,
        static_cast<std::uint32_t>(
            std::min({std::uint64_t{kSetupBatch}, last - id, draw.primitive_count - t})));
    SetupInput input;
    input.first = t;
    input.count = count;
    input.first_id = draw.first_id;
    if (geometry.projected != nullptr) {
      input.indices = draw.indices.empty() ? nullptr : draw.indices.data();
      input.vertices = geometry.projected + draw.first_vertex;
      input.vertex_count = draw.vertex_count;
    } else if (draw.has_kernel()) {
      if (!corners.project(geometry, draw, t, count)) return false;
      input.vertices = corners.vertices;
      input.vertex_count = std::size_t{count} * 3;
      input.first = 0;
      input.first_id = id;
    }
    input.flags = draw.flags_of(t);
    // Who draws translucent surfaces opaque knows no such fragments.
    if (frame.request.transparency.method == Transparency::none) input.flags &= ~kTranslucent;
    input.cull = draw.effective_cull();
    input.view = image;
    input.bin_columns = static_cast<std::uint32_t>((geometry.width + kBinSize - 1) / kBinSize);
    input.micro = micro != nullptr;

    pieces.data.grow(std::size_t{pieces.count} + kSetupBatch, pieces.count);
    BinFragment* const fragments =
        micro == nullptr ? nullptr : micro->room(kSetupBatch * kMicroSize * kMicroSize);
    const SetupOutput out =
        draw.has_kernel()
            ? frame.kernel.setup(input, pieces.data.data() + pieces.count, fragments, slow)
            : all_slow(draw, t, count, slow);
    if (!out.index_in_range) return false;
    pieces.count += out.pieces;
    if (micro != nullptr) micro->written(out.fragments);
    pieces.triangles.culled += count - out.pieces - out.micro - out.slow;
    for (std::uint32_t s = 0; s < out.slow; ++s) {
      const Fate fate = assemble_primitive(geometry, draw, t + slow[s], [&](const Piece& piece) {
        pieces.data.grow(std::size_t{pieces.count} + 1, pieces.count);
        pieces.data[pieces.count++] = piece;
      });
      pieces.triangles.dropped += fate == Fate::dropped;
      pieces.triangles.culled += fate == Fate::culled;
      pieces.triangles.clipped += fate == Fate::clipped;
    }
    id += count;
  }
  return true;
}

std::span<const Piece> PieceArray::fill(Frame& frame, std::uint64_t first, std::uint64_t last) {
  const auto group_count = static_cast<std::size_t>((last - first + kGroup - 1) / kGroup);
  while (groups_.size() < group_count) groups_.emplace_back(memory_);
  std::atomic<bool> in_range = true;
  parallel::for_each_index(frame.exec, group_count, [&](std::size_t g) {
    const std::uint64_t begin = first + g * kGroup;
    groups_[g].count = 0;
    groups_[g].triangles = {};
    if (!set_up(frame, begin, std::min(begin + kGroup, last), groups_[g])) in_range = false;
  });
  if (!in_range) check_indices(frame.request.draws);

  std::vector<std::size_t> place(group_count);
  std::size_t total = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    place[g] = total;
    total += groups_[g].count;
    count_triangles(frame, groups_[g].triangles);
  }
  pieces_.reserve(total);
  parallel::for_each_index(frame.exec, group_count, [&](std::size_t g) {
    std::copy_n(groups_[g].data.data(), groups_[g].count, pieces_.data() + place[g]);
  });
  return {pieces_.data(), total};
}

void count_triangles(Frame& frame, const FrameStats::Triangles& triangles) {
  if (!frame.first_band) return;
  frame.stats.triangles.dropped += triangles.dropped;
  frame.stats.triangles.culled += triangles.culled;
  frame.stats.triangles.clipped += triangles.clipped;
}

}  // namespace rastrum::raster
