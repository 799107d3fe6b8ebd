// SPDX-License-Identifier: BSD-3-Clause
// Exact transparency on a device: LucidRaster's pipeline (paper 4, "Pipeline description", stages 2
// and 3) over pieces that are set up. Either the host waits for sizes, in the memory it is given,
// or it runs without the host (layer_queues.cuh).
//
//   pieces ──count──▶ records a block ──scan──▶ places ──write──▶ records: (piece, block, mask)
//          ──by density──▶ low, high: a team a block, in shared memory     block_teams.cuh
//                          deep: fragments sorted in the device's memory   deep_pixels.cuh
//
// Where it deviates from the paper: bins are blocks of 8 × 8 pixels, whose records have exact
// masks; threads share blocks of boxes, whatever their triangle (expand_each), not rows within a
// subgroup; no density has a limit; and pixels that the filter cannot order are repaired. Layers
// and colours are those of the host's scalar path, bit for bit, because only counts depend on the
// order in which records are written. Unsorted blending differs only in its sort_key: without a
// rasterizer's order in hardware a device must sort for it, too.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>

#include <rastrum/parallel/cuda/expand.cuh>
#include <rastrum/parallel/cuda/select.cuh>
#include <rastrum/raster/cuda/sample_pattern.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/transparency/cuda/block_boxes.cuh>
#include <rastrum/transparency/cuda/block_teams.cuh>
#include <rastrum/transparency/cuda/deep_pixels.cuh>
#include <rastrum/transparency/cuda/device_layers.hpp>
#include <rastrum/transparency/cuda/layer_queues.cuh>
#include <rastrum/transparency/cuda/turns.cuh>

namespace rastrum::transparency {

/// A frame, or a band of its rows, with one sample per pixel, whose opaque surface is drawn. Device
/// memory: the 8 × 8 blocks of `view`, row by row, of 64 pixels each, element 8 · row + column.
/// Elements outside of `view` must be set, too, and do not change.
struct DeviceLayers {
  raster::Rect view;                      ///< px; begins with a block's first pixel
  std::span<const raster::Piece> pieces;  ///< a clipped triangle's lie side by side; only those
                                          ///< with kTranslucent are blended
  std::span<std::uint64_t> keys;          ///< of the opaque surface; raised to the nearest layer's
  std::span<Vec4> colors;  ///< premultiplied: the opaque surface or 0; then the picture
};

/// With several samples: keys and colours are planes, `plane` elements apart, and pieces are at the
/// pixels' centres (raster/cuda/pieces.cuh).
struct DeviceSampledLayers : DeviceLayers {
  raster::SamplePattern samples;
  std::size_t plane = 0;
};

/// Queues of a band that is blended without the host.
struct LeftLayers {
  raster::LeftPieces pieces;
  std::size_t records = 0;            ///< room
  bool stores_shading = false;        ///< a Shade::Record for each piece, if the shader has them
  std::uint64_t* counters = nullptr;  ///< on the device: cuda::kQueueCounters, 0
  std::uint64_t* held = nullptr;      ///< on the device, 0; raised if the host has to go on
};

struct LayerQueueCounts {
  std::array<std::uint64_t, cuda::kQueueCounters> of{};
  std::uint64_t pieces = 0;  ///< places of the queue of pieces

  /// Whether all was blended but deep blocks.
  [[nodiscard]] bool fit(const LeftLayers& left) const {
    return pieces <= left.pieces.pieces.size() && of[cuda::kStaged] <= left.records;
  }
  [[nodiscard]] DeviceLayerCounts layers() const {
    return {of[cuda::kFragments],  of[cuda::kDeepest],   of[cuda::kRepaired],
            of[cuda::kStaged],     of[cuda::kLowBlocks], of[cuda::kHighBlocks],
            of[cuda::kDeepBlocks], of[cuda::kStaged] > 0};
  }
};

/// Enqueues what follows the layers, which does nothing if *held (on the device; may be null) is
/// not 0. Waits, and returns the counts.
using FinishBand = std::function<LayerQueueCounts(const std::uint64_t* held)>;

namespace cuda {

struct CountRecord {
  BlocksOfPiece blocks;
  std::span<std::uint32_t> counts;
  RASTRUM_HD void operator()(std::size_t, std::uint32_t piece, std::size_t j) const {
    const raster::Block b = blocks.block(piece, j);
    if (b.mask != 0) parallel::atomic_add(counts[blocks.number(b)], 1U);
  }
};

/// Writes the records of a turn and counts down each block's rest.
struct WriteRecord {
  BlocksOfPiece blocks;
  Turn turn;
  std::span<const std::uint64_t> first;
  std::span<std::uint32_t> counts;
  std::span<raster::Block> records;
  RASTRUM_HD void operator()(std::size_t, std::uint32_t piece, std::size_t j) const {
    const raster::Block record = blocks.block(piece, j);
    if (record.mask == 0) return;
    const std::size_t b = blocks.number(record);
    if (b < turn.begin || b >= turn.end) return;
    const std::uint32_t left = parallel::atomic_add(counts[b], ~std::uint32_t{0});
    records[first[b] - turn.first + left - 1] = record;
  }
};

struct BlockOfTurn {
  std::size_t begin;
  RASTRUM_HD std::size_t operator()(std::size_t i) const { return begin + i; }
};
struct HasRecords {
  std::span<const std::uint64_t> first;
  std::uint64_t above, most;
  RASTRUM_HD bool operator()(std::size_t b) const {
    const std::uint64_t n = first[b + 1] - first[b];
    return n > above && n <= most;
  }
};

template <class Pixel, class Frame>
class LayerListing {
 public:
  LayerListing(parallel::Cuda& exec, const Frame& frame, const raster::SamplePattern& samples,
               std::size_t plane, const DeviceLayerTuning& tuning)
      : exec_(exec),
        frame_(frame),
        samples_(samples),
        plane_(plane),
        tuning_(tuning.within_teams(LowDensity::kRecords, HighDensity::kRecords)),
        blocks_(frame.columns() * frame.rows()) {
    static_assert(sizeof(raster::Block) == 16);  // most_records()
  }

  [[nodiscard]] DeviceLayerCounts operator()() {
    // The scan puts the sum into the last one.
    auto counts = parallel::make_buffer<std::uint32_t>(exec_, blocks_ + 1);
    parallel::clear(exec_, counts);
    auto counters = parallel::make_buffer<std::uint64_t>(exec_, kCounters);
    parallel::clear(exec_, counters);
    auto farthest = parallel::make_buffer<std::uint64_t>(exec_, blocks_);
    parallel::tabulate(
        exec_, farthest,
        FarthestOfBlock{frame_.view, frame_.columns(), frame_.keys, plane_, samples_.count});

    const auto pieces = parallel::counting<std::uint32_t>(frame_.pieces.size());
    BlocksOfPiece boxes{frame_.pieces,
                        parallel::view_of(farthest),
                        frame_.columns(),
                        frame_.view.x0 / raster::kBlockSize,
                        frame_.view.y0 / raster::kBlockSize,
                        frame_.view,
                        samples_};
    auto plan = parallel::make_expansion(exec_, pieces, boxes);
    parallel::expand_each(exec_, plan, pieces, CountRecord{boxes, parallel::view_of(counts)});
    auto first = parallel::make_buffer<std::uint64_t>(exec_, blocks_ + 1);
    out_.records = parallel::exclusive_scan(exec_, counts, first, std::uint64_t{0});
    const auto places = parallel::view_of(std::as_const(first));
    for (Turn turn; next_turn(exec_, places, out_.records, tuning_.most_records(), turn);) {
      ++out_.turns;
      if (turn.items != out_.records) {
        boxes.view = rows(turn.begin, turn.end);
        plan = parallel::make_expansion(exec_, pieces, boxes);
      }
      auto records = parallel::make_buffer<raster::Block>(exec_, turn.items);
      parallel::expand_each(
          exec_, plan, pieces,
          WriteRecord{boxes, turn, places, parallel::view_of(counts), parallel::view_of(records)});
      blend(turn, {records.data(), places, turn.first}, counters.data());
    }
    const auto totals = parallel::to_host(exec_, counters);
    out_.fragments = totals[kFragments];
    out_.deepest = totals[kDeepest];
    out_.repaired = totals[kRepaired];
    return out_;
  }

 private:
  [[nodiscard]] raster::Rect rows(std::size_t begin, std::size_t end) const {
    const std::size_t columns = frame_.columns();
    const raster::Rect& v = frame_.view;
    const int y0 = v.y0 + static_cast<int>(begin / columns) * raster::kBlockSize;
    const int y1 = v.y0 + static_cast<int>((end + columns - 1) / columns) * raster::kBlockSize;
    return {v.x0, y0, v.x1, std::min(y1, v.y1)};
  }

  void blend(const Turn& turn, const RecordView& records, std::uint64_t* counters) {
    const std::uint64_t low = tuning_.low_records, high = tuning_.high_records;
    const auto low_blocks = blocks_with(turn, records.first, 0, low);
    const auto high_blocks = blocks_with(turn, records.first, low, high);
    const auto deep_blocks =
        blocks_with(turn, records.first, high, std::numeric_limits<std::uint64_t>::max());
    for (int first = 0; first < samples_.count; first += Frame::kSamples) {
      const Frame frame = frame_.from_sample(samples_, first, plane_);
      blend_teams<LowDensity>(frame, records, parallel::view_of(low_blocks), counters);
      blend_teams<HighDensity>(frame, records, parallel::view_of(high_blocks), counters);
      for (int s = 0; s < Frame::kSamples; ++s)
        blend_deep<Pixel>(exec_, frame, records, parallel::view_of(deep_blocks), s,
                          tuning_.most_fragments(), counters);
    }
    out_.low_blocks += low_blocks.size();
    out_.high_blocks += high_blocks.size();
    out_.deep_blocks += deep_blocks.size();
  }
  template <class Density>
  void blend_teams(const Frame& frame, const RecordView& records,
                   std::span<const std::size_t> blocks, std::uint64_t* counters) {
    using Blend = BlendBlock<Density, Pixel, Frame>;
    parallel::for_each_team<typename Blend::Scratch, Blend::kThreads, Blend::kResident>(
        exec_, blocks.size(), Blend{frame, records, blocks, counters});
  }
  [[nodiscard]] auto blocks_with(const Turn& turn, std::span<const std::uint64_t> first,
                                 std::uint64_t above, std::uint64_t most) {
    return parallel::filter(exec_,
                            parallel::Computed(turn.end - turn.begin, BlockOfTurn{turn.begin}),
                            HasRecords{first, above, most});
  }

  parallel::Cuda& exec_;
  const Frame frame_;
  const raster::SamplePattern samples_;
  const std::size_t plane_;
  const DeviceLayerTuning tuning_;
  const std::size_t blocks_;
  DeviceLayerCounts out_;
};

inline void require_method(Transparency method) {
  if (method != Transparency::exact && method != Transparency::unsorted)
    throw Error(Errc::invalid_argument, "transparency on a device is exact or unsorted");
}

template <class Frame>
DeviceLayerCounts blend(parallel::Cuda& exec, const DeviceLayers& layers, const Frame& frame,
                        const raster::SamplePattern& samples, std::size_t plane,
                        Transparency method, const DeviceLayerTuning& tuning) {
  require_method(method);
  if (layers.pieces.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(Errc::invalid_argument,
                "a device blends at most 2^32 - 1 pieces at a time; draw the picture in bands");
  assert(layers.keys.size() >= frame.columns() * frame.rows() * 64 &&
         layers.colors.size() == layers.keys.size());
  if (method == Transparency::unsorted)
    return LayerListing<AsSubmittedPixel, Frame>(exec, frame, samples, plane, tuning)();
  return LayerListing<FrontToBackPixel, Frame>(exec, frame, samples, plane, tuning)();
}

/// The same by queues.
template <class Pixel, class Shade, class Frame>
bool run_queues(parallel::Cuda& exec, const Frame& frame, const raster::SamplePattern& samples,
                std::size_t plane, const LeftLayers& left, const DeviceLayerTuning& tuning,
                const FinishBand& finish) {
  LayerQueues<Pixel, Frame, Shade> queues(exec, frame, samples, plane, left.pieces, left.records,
                                          left.stores_shading, tuning, left.counters, left.held);
  queues();
  const LayerQueueCounts c = finish(left.held);
  if (!c.fit(left)) return false;
  if (c.of[kDeepBlocks] > 0) {
    queues.blend_deep_blocks(c.of[kDeepBlocks]);
    finish(nullptr);
  }
  return true;
}
template <class Shade, class Frame>
bool blend_left(parallel::Cuda& exec, const Frame& frame, const raster::SamplePattern& samples,
                std::size_t plane, const LeftLayers& left, Transparency method,
                const DeviceLayerTuning& tuning, const FinishBand& finish) {
  require_method(method);
  if (method == Transparency::unsorted)
    return run_queues<AsSubmittedPixel, Shade>(exec, frame, samples, plane, left, tuning, finish);
  return run_queues<FrontToBackPixel, Shade>(exec, frame, samples, plane, left, tuning, finish);
}

template <class Shade, class Test>
[[nodiscard]] FrameView<Shade, Test> frame_view(const DeviceLayers& layers,
                                                const TransparencyOptions& options,
                                                const Shade& shade, const Test& test) {
  return {layers.view,
          layers.pieces,
          layers.keys.data(),
          layers.colors.data(),
          1 - options.alpha_threshold,
          shade,
          test};
}

}  // namespace cuda

/// Blends the translucent pieces of `layers` over its opaque surface.
/// `options`: exact or unsorted (why_not_on_a_device), and the alpha threshold.
/// `shade`: (key, x, y) → premultiplied Vec4, a fragment's colour at a pixel's centre; the key has
/// its depth and id (piece.hpp). `test`: (key, x, y) → bool, for pieces with kMayDrop. Both are
/// copied into kernels, called any number of times, and must be pure.
/// Waits for sizes and, at the end, for its counts. Memory: 8 bytes per piece, 20 per block, and
/// `tuning.bytes`. Work O(blocks of boxes + fragments · log of a block's records) if the filter
/// orders nearly all.
/// Throws Error{invalid_argument} for other methods or more than 2³² pieces, Error{out_of_memory}.
template <class Shade, class Test = cuda::KeepAll>
DeviceLayerCounts blend_layers(parallel::Cuda& exec, const DeviceLayers& layers,
                               const TransparencyOptions& options, const Shade& shade,
                               const Test& test = {}, const DeviceLayerTuning& tuning = {}) {
  return cuda::blend(exec, layers, cuda::frame_view(layers, options, shade, test), {}, 0,
                     options.method, tuning);
}

/// The same at several samples, with planes of keys and colours. `shade` (a raster::ShadedOnce, or
/// alike) and `test` give a primitive's one colour and answer in a pixel, by the key of any sample,
/// so they may read its id alone. Records are found once for all samples, ordered and shaded once
/// for four. Work: that of one, times the samples.
template <class Shade, class Test = cuda::KeepAll>
DeviceLayerCounts blend_sampled_layers(parallel::Cuda& exec, const DeviceSampledLayers& layers,
                                       const TransparencyOptions& options, const Shade& shade,
                                       const Test& test = {},
                                       const DeviceLayerTuning& tuning = {}) {
  const cuda::SampledView<Shade, Test> frame{cuda::frame_view(layers, options, shade, test), {}, 0};
  return cuda::blend(exec, layers, frame, layers.samples, layers.plane, options.method, tuning);
}

/// blend_layers without the host; the room of the queue of pieces is layers.pieces. It calls
/// finish(left.held); work enqueued there does nothing if *held is not 0. After work that needs the
/// host (deep blocks) it calls finish(nullptr). Returns false if a queue was too small; then
/// nothing was blended.
template <class Shade, class Test = cuda::KeepAll>
[[nodiscard]] bool blend_left_layers(parallel::Cuda& exec, const DeviceLayers& layers,
                                     const LeftLayers& left, const TransparencyOptions& options,
                                     const Shade& shade, const Test& test,
                                     const DeviceLayerTuning& tuning, const FinishBand& finish) {
  return cuda::blend_left<Shade>(exec, cuda::frame_view(layers, options, shade, test), {}, 0, left,
                                 options.method, tuning, finish);
}
/// blend_sampled_layers without the host.
template <class Shade, class Test = cuda::KeepAll>
[[nodiscard]] bool blend_left_sampled_layers(parallel::Cuda& exec,
                                             const DeviceSampledLayers& layers,
                                             const LeftLayers& left,
                                             const TransparencyOptions& options, const Shade& shade,
                                             const Test& test, const DeviceLayerTuning& tuning,
                                             const FinishBand& finish) {
  const cuda::SampledView<Shade, Test> frame{cuda::frame_view(layers, options, shade, test), {}, 0};
  return cuda::blend_left<Shade>(exec, frame, layers.samples, layers.plane, left, options.method,
                                 tuning, finish);
}

}  // namespace rastrum::transparency
