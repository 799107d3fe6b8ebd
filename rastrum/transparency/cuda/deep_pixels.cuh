// SPDX-License-Identifier: BSD-3-Clause
// Blocks with more records than shared memory holds. Their fragments are written to device memory,
// sorted by (pixel, key) and blended, a thread per pixel. This tier has no limit; paper 4 lacks it
// (its high rasterizer paints such bins red).
//
// The sort is two stable ones (sort_by_key), because a key has no bits left for a pixel. Pixels go
// in turns within a budget, at least one at a time, which takes 24 bytes per layer, less than the
// pieces.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <rastrum/parallel/cuda/reduce.cuh>
#include <rastrum/parallel/cuda/sort_by_key.cuh>
#include <rastrum/transparency/cuda/block_teams.cuh>
#include <rastrum/transparency/cuda/turns.cuh>

namespace rastrum::transparency::cuda {

/// Pixel q is pixel q % 64 of block blocks[q / 64].
template <class Frame>
struct DeepPixels {
  Frame frame;
  RecordView records;
  std::span<const std::size_t> blocks;
  int sample;  ///< of those that the frame has at once

  RASTRUM_HD std::size_t place(std::size_t q) const { return blocks[q / 64] * 64 + q % 64; }
  template <class F>
  RASTRUM_HD void each_key(std::size_t q, const F& f) const {
    const std::size_t b = blocks[q / 64], p = q % 64;
    const std::uint64_t opaque = frame.key_of(sample, place(q));
    const int x = frame.x_of(b, p), y = frame.y_of(b, p);
    for (const raster::Block& record : records.of(b)) {
      if ((record.mask >> p & 1) == 0) continue;
      const std::uint64_t key = frame.key(record, x, y, sample);
      if (key > opaque) f(key);
    }
  }
};

template <class Frame>
struct CountDeep {
  DeepPixels<Frame> pixels;
  std::size_t count;
  /// 0 behind the last pixel, where the scan puts the sum.
  RASTRUM_HD std::uint64_t operator()(std::size_t q) const {
    std::uint64_t n = 0;
    if (q < count) pixels.each_key(q, [&](std::uint64_t) { ++n; });
    return n;
  }
};

template <class Pixel, class Frame>
struct WriteDeep {
  DeepPixels<Frame> pixels;
  std::span<const std::uint64_t> first;
  std::size_t begin;  ///< the first pixel
  std::uint64_t* sort_keys;
  std::uint32_t* owners;
  RASTRUM_HD void operator()(std::size_t i) const {
    std::uint64_t at = first[begin + i] - first[begin];
    pixels.each_key(begin + i, [&](std::uint64_t key) {
      sort_keys[at] = Pixel::fragment_sort_key(key);
      owners[at++] = static_cast<std::uint32_t>(i);
    });
  }
};

/// Blends a pixel's sorted fragments. They come in order, so nothing is held back.
template <class Pixel, class Frame>
struct BlendDeep {
  DeepPixels<Frame> pixels;
  std::span<const std::uint64_t> first;
  std::size_t begin;
  const std::uint64_t* sort_keys;
  std::uint64_t* counters;
  RASTRUM_HD void operator()(std::size_t i) const {
    const std::size_t q = begin + i;
    const std::uint64_t n = first[q + 1] - first[q];
    if (n == 0) return;
    const Frame& frame = pixels.frame;
    const std::size_t at = pixels.place(q), b = pixels.blocks[q / 64];
    const int x = frame.x_of(b, q % 64), y = frame.y_of(b, q % 64);
    const std::uint64_t* const mine = sort_keys + (first[q] - first[begin]);
    Pixel pixel;
    Vec4& color = frame.color_of(pixels.sample, at);
    pixel.begin(color);
    for (std::uint64_t k = 0; k < n; ++k) {
      const std::uint64_t key = Pixel::key_of_sort_key(mine[k]);
      if (key <= pixel.limit(0)) break;
      pixel.take({key, frame.shade(key, x, y)}, frame.opaque_at);
    }
    pixel.end(frame.opaque_at);
    color = pixel.color(color);
    frame.key_of(pixels.sample, at) = pixel.nearest();
    count_layers(counters, n, static_cast<std::uint32_t>(n), 0);
  }
};

/// Sorts at most `most` fragments at a time (but a whole pixel's). Waits for the number of
/// fragments, and for the ends of several turns.
template <class Pixel, class Frame>
void blend_deep(parallel::Cuda& exec, const Frame& frame, const RecordView& records,
                std::span<const std::size_t> blocks, int sample, std::uint64_t most,
                std::uint64_t* counters) {
  if (blocks.empty()) return;
  const DeepPixels<Frame> pixels{frame, records, blocks, sample};
  const std::size_t count = blocks.size() * 64;
  auto first = parallel::make_buffer<std::uint64_t>(exec, count + 1);
  parallel::tabulate(exec, first, CountDeep<Frame>{pixels, count});
  const std::uint64_t all = parallel::exclusive_scan(exec, first, first, std::uint64_t{0});
  const auto places = parallel::view_of(std::as_const(first));
  for (Turn turn; next_turn(exec, places, all, most, turn);) {
    auto sort_keys = parallel::make_buffer<std::uint64_t>(exec, turn.items);
    auto owners = parallel::make_buffer<std::uint32_t>(exec, turn.items);
    const std::size_t n = turn.end - turn.begin;
    parallel::for_each_index(
        exec, n,
        WriteDeep<Pixel, Frame>{pixels, places, turn.begin, sort_keys.data(), owners.data()});
    parallel::sort_by_key(exec, sort_keys, owners);
    parallel::sort_by_key(exec, owners, sort_keys, static_cast<int>(std::bit_width(n - 1)));
    parallel::for_each_index(
        exec, n, BlendDeep<Pixel, Frame>{pixels, places, turn.begin, sort_keys.data(), counters});
  }
}

}  // namespace rastrum::transparency::cuda
