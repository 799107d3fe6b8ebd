// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/kernels/kernels.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include <rastrum/raster/kernels/depth_bounds.hpp>
#include <rastrum/raster/kernels/kernels_simd.hpp>
#include <rastrum/raster/rules/clip.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/rules/make_piece.hpp>
#include <rastrum/raster/rules/points_and_lines.hpp>

namespace rastrum::raster {
namespace {

void project_scalar(const Vec3* positions, std::size_t n, const Mat4& m, Viewport viewport,
                    ProjectedVertex* out) noexcept {
  for (std::size_t i = 0; i < n; ++i) out[i] = project(transform_point(m, positions[i]), viewport);
}

void project64_scalar(const Vec3d* positions, std::size_t n, const Mat4d& m, Viewport viewport,
                      ProjectedVertex* out) noexcept {
  for (std::size_t i = 0; i < n; ++i)
    out[i] = project(rounded(transform_point(m, positions[i])), viewport);
}

SetupOutput setup_scalar(const SetupInput& in, Piece* pieces, BinFragment*,
                         std::uint32_t* slow) noexcept {
  SetupOutput out;
  for (std::uint32_t i = 0; i < in.count; ++i) {
    const std::uint64_t t = in.first + i;
    ProjectedVertex v[3];
    bool needs_clip = false;
    for (std::uint64_t c = 0; c < 3; ++c) {
      const std::uint64_t index = in.indices != nullptr ? in.indices[t * 3 + c] : t * 3 + c;
      if (index >= in.vertex_count) {
        out.index_in_range = false;
        return out;
      }
      v[c] = in.vertices[index];
      needs_clip |= v[c].x_fx8 == kNeedsClip;
    }
    if (needs_clip) {
      slow[out.slow++] = i;
      continue;
    }
    const auto draw = [&](SampleOffset at, std::uint32_t flags) {
      const bool drawn =
          make_piece(moved(v[0], at), moved(v[1], at), moved(v[2], at), id_of(in, t), flags,
                     in.cull, in.view, pieces[out.pieces]) == SetupResult::drawn;
      out.pieces += drawn;
      return drawn;
    };
    if (in.samples.empty()) (void)draw({}, in.flags);
    for (std::uint32_t s = 0; s < in.samples.size(); ++s) {
      const std::uint32_t flags = in.together ? kAllSamples : s << kSampleShift;
      if (!draw(in.samples[s], in.flags | flags)) continue;
      const std::uint32_t bit = in.first_seen + i;
      in.seen[bit / 64] |= std::uint64_t{1} << bit % 64;
      if (!in.together) continue;
      Piece& piece = pieces[out.pieces - 1];
      piece = moved(piece, {-in.samples[s].x, -in.samples[s].y});
      break;
    }
  }
  return out;
}

SetupOutput points_scalar(const PointsInput& in, BinFragment* fragments,
                          std::uint32_t* slow) noexcept {
  SetupOutput out;
  for (std::uint32_t i = 0; i < in.count; ++i) {
    const ProjectedVertex& v = in.vertices[i];
    const std::int32_t size = in.sizes != nullptr ? in.sizes[i] : kSubpixels;
    Piece piece;
    if (v.x_fx8 == kNeedsClip || size > kMicroPoint) {
      slow[out.slow++] = i;
    } else if (make_point(v, in.first_id + i, in.flags, size, in.view, piece) ==
               SetupResult::drawn) {
      const std::uint64_t key = make_key(plane_depth_at(piece, 0, 0), piece.low);
      ++out.micro;
      for_each_covered(piece, in.view, [&](int x, int y) {
        fragments[out.fragments++] = fragment_at(x, y, key, in.flags, in.bin_columns);
      });
    }
  }
  return out;
}

void stream_scalar(const Rgba8* from, int columns, int rows, Rgba8* to,
                   std::ptrdiff_t stride) noexcept {
  for (int row = 0; row < rows; ++row)
    std::copy_n(from + row * columns, columns, to + row * stride);
}
void fill_scalar(Rgba8 with, int columns, int rows, Rgba8* to, std::ptrdiff_t stride) noexcept {
  for (int row = 0; row < rows; ++row) std::fill_n(to + row * stride, columns, with);
}
void end_stream_scalar() noexcept {}

void bins_scalar(const Piece*, std::size_t n, const BinNumbers&, std::uint32_t* bins) noexcept {
  std::fill_n(bins, n, kManyBins);
}

std::size_t cover_scalar(const PieceList& in, std::size_t& cursor, Rect bin, Block* out,
                         std::size_t capacity, DepthBounds* bounds, RowKeys*) noexcept {
  HiddenTest hidden(bounds, bin);
  std::size_t n = 0;
  for (; cursor < in.count && n + kBlocksPerBin <= capacity; ++cursor) {
    const std::uint32_t index = in.list[cursor].piece;
    const Piece& piece = in.pieces[index];
    const Rect box = piece_bounds(piece, bin);
    if (box.empty() || hidden.hides_piece(piece, box)) continue;
    cover_blocks(
        piece, box, bin, [&](int bx, int by) { return hidden.hides_block(piece, bx, by); },
        [&](int bx, int by, std::uint64_t mask) {
          out[n++] = {index, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), mask};
        });
  }
  return n;
}

void masks_scalar(const Piece* pieces, Block* blocks, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i)
    if (blocks[i].mask == 0)
      blocks[i].mask = cover_8x8(pieces[blocks[i].piece], blocks[i].bx, blocks[i].by);
}

void keys_scalar(const Piece& piece, const Block& block, std::uint64_t* keys) noexcept {
  for (int i = 0; i < 64; ++i)
    keys[i] = make_key(depth_at(piece, block.bx * kBlockSize + i % kBlockSize,
                                block.by * kBlockSize + i / kBlockSize),
                       piece.low);
}

void maximum_scalar(const Piece* pieces, const Block* blocks, std::size_t n,
                    const SurfaceView& surface) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const Block& b = blocks[i];
    const Piece& piece = pieces[b.piece];
    std::uint64_t* block = surface.block(b.bx, b.by);
    for (std::uint64_t m = b.mask; m != 0; m &= m - 1) {
      const int bit = std::countr_zero(m);
      const int x = b.bx * kBlockSize + bit % kBlockSize;
      const int y = b.by * kBlockSize + bit / kBlockSize;
      const std::uint64_t key = make_key(depth_at(piece, x, y), piece.low);
      block[bit] = key > block[bit] ? key : block[bit];
    }
  }
}

std::uint64_t lowest_scalar(const std::uint64_t* keys) noexcept {
  return *std::min_element(keys, keys + 64);
}

std::uint64_t take_rows_scalar(std::uint64_t* rows, std::uint64_t* block) noexcept {
  for (std::size_t i = 0; i < 64; ++i) {
    std::uint64_t& key = rows[i / kBlockSize * RowKeys::kRow + i % kBlockSize];
    block[i] = std::max(block[i], std::exchange(key, 0));
  }
  return lowest_scalar(block);
}

std::uint64_t covered_scalar(const std::uint64_t* keys) noexcept {
  std::uint64_t mask = 0;
  for (int i = 0; i < 64; ++i) mask |= std::uint64_t{keys[i] != 0} << i;
  return mask;
}

std::uint64_t raise_samples_scalar(const PieceList& in, std::size_t begin, std::size_t end,
                                   Rect bin, const SampledKeys& keys, DepthBounds*) noexcept {
  std::uint64_t covered = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const Piece& piece = in.pieces[in.list[i].piece];
    if (!is_raised_at_once(piece)) continue;
    for (std::size_t s = 0; s < keys.samples.size(); ++s) {
      const Piece own = moved(piece, keys.samples[s]);
      for_each_covered(own, bin, [&](int x, int y) {
        std::uint64_t& key = keys.at(x, y, s);
        key = std::max(key, make_key(plane_depth_at(own, x, y),
                                     keys.low(own.low, SampledKeys::kUnknownPlace)));
        ++covered;
      });
    }
  }
  return covered;
}

void find_sampled_bounds_scalar(const SampledKeys& keys, Rect bin, DepthBounds& bounds) noexcept {
  for (int i = 0; i < kBlocksPerBin; ++i) {
    const int x0 = bin.x0 + i % kBlocksPerBinRow * kBlockSize;
    const int y0 = bin.y0 + i / kBlocksPerBinRow * kBlockSize;
    if (x0 >= bin.x1 || y0 >= bin.y1) continue;
    std::uint64_t least = ~std::uint64_t{0};
    for (int y = y0; y < y0 + kBlockSize; ++y)
      for (int x = x0; x < x0 + kBlockSize; ++x)
        for (std::size_t s = 0; s < keys.samples.size(); ++s)
          least = std::min(least, keys.at(x, y, s));
    bounds.block[i] = std::max(bounds.block[i], depth_of_key(least));
  }
}

void merge_scalar(const SampledKeys& keys, int x, int y, std::uint64_t* largest,
                  std::uint64_t* first, SeenBySamples& seen) noexcept {
  seen.covered = seen.mixed = 0;
  const std::size_t samples = keys.samples.size();
  for (int i = 0; i < 64; ++i) {
    std::uint64_t key[kMaxSamples] = {}, most = 0, firsts = 0, centred = 0;
    bool differs = false;
    for (std::size_t s = 0; s < samples; ++s) {
      key[s] = keys.at(x + i % kBlockSize, y + i / kBlockSize, s);
      most = std::max(most, key[s]);
      const auto same = [&](std::size_t t) { return ((key[s] ^ key[t]) & kIdMask) == 0; };
      differs = differs || !same(0);
      std::size_t t = 0;
      while (!same(t)) ++t;
      firsts |= std::uint64_t{t} << (4 * s);
      for (std::size_t u = t; u < s; ++u)
        if (!keys.has_places && same(u) && are_opposite(keys.samples[u], keys.samples[s]))
          centred |= std::uint64_t{1} << t;
    }
    largest[i] = most == 0 ? 0 : keys.plain(most);
    first[i] = key[0] == 0 ? 0 : keys.plain(key[0]);
    seen.places[i] = 0;
    for (std::size_t s = 0; s < samples && keys.has_places; ++s)
      seen.places[i] |= (key[s] & SampledKeys::kUnknownPlace) << (4 * s);
    seen.covered |= std::uint64_t{most != 0} << i;
    seen.mixed |= std::uint64_t{differs} << i;
    seen.first[i] = firsts;
    seen.centred[i] = centred;
  }
}

void store_opaque_scalar(const BlockColors& colors, std::uint64_t covered, Rgba8 background,
                         Rgba8* out, std::ptrdiff_t stride) noexcept {
  for (int i = 0; i < 64; ++i)
    out[i / kBlockSize * stride + i % kBlockSize] =
        (covered >> i & 1) == 0
            ? background
            : Rgba8{quantize(colors.r[i]), quantize(colors.g[i]), quantize(colors.b[i]), 255};
}

void store_blended_scalar(const BlockColors& colors, std::uint64_t covered,
                          const Backdrop& backdrop, Rgba8* out, std::ptrdiff_t stride) noexcept {
  for (int i = 0; i < 64; ++i) {
    Rgba8& pixel = out[i / kBlockSize * stride + i % kBlockSize];
    const Vec4 c = backdrop.over({colors.r[i], colors.g[i], colors.b[i], colors.a[i]});
    if ((covered >> i & 1) == 0)
      pixel = backdrop.empty;
    else
      pixel = backdrop.linear ? linear_to_straight_rgba8(c) : to_straight_rgba8(c);
  }
}

/// Has no deferred pieces.
SetupOutput defer_scalar(const QuadricInput& in, Piece*, std::uint32_t* slow) noexcept {
  SetupOutput out;
  out.slow = in.count;
  std::copy_n(in.numbers, in.count, slow);
  return out;
}
RaisedKeys raise_scalar(const QuadricBatch&, Rect, const DepthBounds*,
                        const SurfaceView&) noexcept {
  return {};
}

constexpr std::size_t kIsaCount = static_cast<std::size_t>(Isa::wasm) + 1;

constexpr Kernels kScalar{
    project_scalar,   project64_scalar,    setup_scalar,         points_scalar,
    cover_scalar,
    nullptr,  // no small triangles
    masks_scalar,     keys_scalar,         maximum_scalar,       lowest_scalar,
    take_rows_scalar, covered_scalar,      raise_samples_scalar, find_sampled_bounds_scalar,
    merge_scalar,     store_opaque_scalar, store_blended_scalar, fill_scalar,
    stream_scalar,    fill_scalar,         end_stream_scalar,    bins_scalar,
    defer_scalar,     raise_scalar};

}  // namespace

const Kernels& kernels(Isa isa) {
  static const std::array<Kernels, kIsaCount> tables = [] {
    std::array<Kernels, kIsaCount> all;
    all.fill(kScalar);
    // This machine's only, since the code that fills a table is compiled for its instruction set,
    // too.
    for (const Isa available : available_isas()) {
      Kernels& table = all[static_cast<std::size_t>(available)];
      for (const FillKernels fill : {fill_setup_kernels(available), fill_cover_kernels(available),
                                     fill_block_kernels(available), fill_quadric_kernels(available),
                                     fill_sampled_kernels(available)})
        if (fill != nullptr) fill(table);
    }
    return all;
  }();
  return tables[static_cast<std::size_t>(isa)];
}

}  // namespace rastrum::raster
