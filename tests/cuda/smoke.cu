// The pipeline once through, on the device: project, set up, count blocks, scan, cover, maximum.
// Written with the words and with the functions that the host uses, so that they stay device code.
// Compiling is the test (tests/cuda/CMakeLists.txt); triangles that need the clipper are left out.
#include <cstdint>
#include <span>

#include <rastrum/core/mat.hpp>
#include <rastrum/core/vec.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/coverage.hpp>
#include <rastrum/raster/piece.hpp>
#include <rastrum/raster/projection.hpp>
#include <rastrum/raster/setup.hpp>

namespace rastrum::raster {

struct ProjectVertex {
  Mat4 object_to_clip;
  Viewport viewport;
  RASTRUM_HD ProjectedVertex operator()(Vec3 p) const {
    return project(transform_point(object_to_clip, p), viewport);
  }
};

/// A piece with an empty box for a triangle that draws nothing.
struct SetUp {
  std::span<const ProjectedVertex> vertices;
  std::span<const std::uint32_t> indices;
  Rect view;
  RASTRUM_HD Piece operator()(std::size_t t) const {
    const ProjectedVertex &a = vertices[indices[3 * t]], &b = vertices[indices[3 * t + 1]],
                          &c = vertices[indices[3 * t + 2]];
    Piece piece{};
    const bool complete = a.x_fx8 != kNeedsClip && b.x_fx8 != kNeedsClip && c.x_fx8 != kNeedsClip;
    if (!complete || make_piece(a, b, c, t, 0, Cull::none, view, piece) == SetupResult::culled)
      return Piece{};
    return piece;
  }
};

RASTRUM_HD inline Rect blocks_of(const Piece& piece, Rect view) {
  const Rect px = sample_bounds(piece.x, piece.y, view);
  if (px.empty()) return {};
  return {px.x0 / kBlockSize, px.y0 / kBlockSize, (px.x1 - 1) / kBlockSize + 1,
          (px.y1 - 1) / kBlockSize + 1};
}

struct CountBlocks {
  Rect view;
  RASTRUM_HD std::uint64_t operator()(const Piece& piece) const {
    const Rect b = blocks_of(piece, view);
    return static_cast<std::uint64_t>(b.x1 - b.x0) * static_cast<std::uint64_t>(b.y1 - b.y0);
  }
};

/// The i-th (piece, block) pair; block k of piece p has the number first[p] + k.
struct CoverBlock {
  std::span<const Piece> pieces;
  std::span<const std::uint64_t> first;
  Rect view;
  std::span<std::uint64_t> words;  ///< W × H, zero

  RASTRUM_HD void operator()(std::size_t i) const {
    const std::size_t p = parallel::expand_detail::last_at_most(first, i);
    const Rect blocks = blocks_of(pieces[p], view);
    const int k = static_cast<int>(i - first[p]);
    const int bx = blocks.x0 + k % (blocks.x1 - blocks.x0);
    const int by = blocks.y0 + k / (blocks.x1 - blocks.x0);
    const std::uint64_t mask = cover_8x8(pieces[p], bx, by);
    for (int row = 0; row < kBlockSize; ++row) {
      const int y = by * kBlockSize + row;
      if (y >= view.y1) break;
      const Span covered = row_span(pieces[p], y, bx * kBlockSize, (bx + 1) * kBlockSize);
      for (int x = covered.begin; x < covered.end && x < view.x1; ++x) {
        if ((mask >> (row * kBlockSize + x % kBlockSize) & 1) == 0) continue;
        const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(view.x1) +
                        static_cast<std::size_t>(x);
        parallel::atomic_maximum(words[at], make_word(depth_at(pieces[p], x, y), pieces[p].low));
      }
    }
  }
};

/// Spans of device memory: one element a vertex, a triangle or a pixel.
struct DeviceFrame {
  std::span<const Vec3> positions;
  std::span<const std::uint32_t> indices;
  std::span<ProjectedVertex> projected;
  std::span<Piece> pieces;
  std::span<std::uint64_t> block_counts, first_block;
  std::span<std::uint64_t> words;
};

void draw(parallel::Cuda& exec, const DeviceFrame& f, const Mat4& object_to_clip, int width,
          int height) {
  const Rect view{0, 0, width, height};
  parallel::transform(exec, f.positions, f.projected,
                      ProjectVertex{object_to_clip, Viewport::of(width, height)});
  parallel::tabulate(exec, f.pieces, SetUp{f.projected, f.indices, view});
  parallel::transform(exec, f.pieces, f.block_counts, CountBlocks{view});
  const std::uint64_t blocks =
      parallel::exclusive_scan(exec, f.block_counts, f.first_block, std::uint64_t{0});
  parallel::for_each_index(exec, blocks, CoverBlock{f.pieces, f.first_block, view, f.words});
}

}  // namespace rastrum::raster
