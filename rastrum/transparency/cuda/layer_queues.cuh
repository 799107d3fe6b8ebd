// SPDX-License-Identifier: BSD-3-Clause
// Exact transparency on a device without its host: queues and counters on the device replace the
// waits of device_layers.cuh. Pieces come from the queue of the rasterizer
// (raster/cuda/left_pieces.cuh), so a triangle is assembled once.
//
//   begin      a thread per block: the farthest key of its surface; no records yet
//   stage      the blocks of the pieces' boxes (visit_blocks): each record goes into one queue,
//              with its number among those of its block. Coverage is found once
//   shade      a thread per piece: what the shader reads of its triangle, once for all fragments
//   place      teams take places for the records of their blocks, in any order, and queue the
//              blocks by density
//   scatter    a thread per record
//   blend      block_teams.cuh, a team per block of low and of high density
//
// Blocks with more records than a team takes are left to the host (deep_pixels.cuh). If a queue was
// too small, everything is left to it, and nothing was blended. In both cases *held is raised, so
// kernels that make images of the band do nothing.
//
// The results are the listing's, bit for bit: the same records in the order of the same sort.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include <rastrum/parallel/cuda/team.cuh>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/left_pieces.cuh>
#include <rastrum/transparency/cuda/block_boxes.cuh>
#include <rastrum/transparency/cuda/block_teams.cuh>
#include <rastrum/transparency/cuda/deep_pixels.cuh>
#include <rastrum/transparency/cuda/device_layers.hpp>

namespace rastrum::transparency::cuda {

/// In the order in which they are found. If a record finds no room, none is placed.
struct StagedRecords {
  std::span<raster::Block> records;
  std::span<std::uint32_t> ranks;  ///< among those of the same block
};

struct LayerQueueView {
  raster::LeftPieces left;
  StagedRecords staged;
  std::span<std::uint32_t> counts;  ///< records of each block
  std::span<std::uint64_t> first;   ///< place of the first of them
  std::uint64_t* counters;
  std::uint64_t* held;

  RASTRUM_HD bool fits() const {
    return !left.is_full() && counters[kStaged] <= staged.records.size();
  }
};

struct BeginBlock {
  FarthestOfBlock find;
  std::span<std::uint64_t> farthest;
  std::span<std::uint32_t> counts;
  RASTRUM_HD void operator()(std::size_t b) const {
    farthest[b] = find(b);
    counts[b] = 0;
  }
};

struct StageRecords {
  BlocksOfPiece boxes;
  LayerQueueView queues;

  struct Local {};
  RASTRUM_HD std::uint64_t blocks(std::uint32_t piece) const { return boxes(piece); }
  RASTRUM_HD void operator()(std::uint32_t piece, std::size_t j, Local&) const {
    const raster::Block record = boxes.block(piece, j);
    if (record.mask == 0) return;
    const auto at = static_cast<std::size_t>(parallel::take_place(queues.counters[kStaged]));
    if (at >= queues.staged.records.size()) return;
    queues.staged.records[at] = record;
    queues.staged.ranks[at] = parallel::atomic_add(queues.counts[boxes.number(record)], 1U);
  }
  RASTRUM_HD void end(const Local&) const {}
};

template <class Shade>
struct StoreShading {
  struct Local {};
  raster::LeftPieces left;
  Shade shade;
  RecordOf<Shade>* records;
  RASTRUM_HD void operator()(std::size_t i, Local&) const {
    const raster::Piece& piece = left.pieces[i];
    if ((piece.flags & kTranslucent) != 0) records[i] = shade.record(piece.low);
  }
  RASTRUM_HD void end(const Local&) const {}
};

struct PlaceBlocks {
  static constexpr std::size_t kBlocks = 512;
  struct Scratch {
    std::uint32_t first[kBlocks + 1];
    std::uint64_t base;
  };
  LayerQueueView queues;
  std::size_t low_records, high_records;
  std::span<std::size_t> low, high, deep;

  template <class Team>
  RASTRUM_HD void operator()(std::size_t i, Scratch& s, const Team& team) const {
    // The counters are final, so all members see the same.
    if (!queues.fits()) {
      if (i == 0 && team.rank() == 0) parallel::atomic_add(*queues.held, std::uint64_t{1});
      return;
    }
    const std::size_t begin = i * kBlocks, left = queues.counts.size() - begin;
    const std::size_t n = left < kBlocks ? left : kBlocks;
    for (std::size_t k = team.rank(); k < n; k += team.size())
      s.first[k] = queues.counts[begin + k];
    parallel::team_prefix_sums(s.first, n, team);
    if (team.rank() == 0)
      s.base = parallel::atomic_add(queues.counters[kPlaced], std::uint64_t{s.first[n]});
    team.sync();
    for (std::size_t k = team.rank(); k < n; k += team.size()) {
      queues.first[begin + k] = s.base + s.first[k];
      queue(begin + k, queues.counts[begin + k]);
    }
  }

 private:
  RASTRUM_HD void queue(std::size_t block, std::uint32_t records) const {
    if (records == 0) return;
    if (records > high_records) {
      deep[take(kDeepBlocks)] = block;
      parallel::atomic_add(*queues.held, std::uint64_t{1});
    } else if (records > low_records) {
      high[take(kHighBlocks)] = block;
    } else {
      low[take(kLowBlocks)] = block;
    }
  }
  RASTRUM_HD std::size_t take(Counter which) const {
    return static_cast<std::size_t>(parallel::take_place(queues.counters[which]));
  }
};

struct ScatterRecord {
  struct Local {};
  LayerQueueView queues;
  BlocksOfPiece boxes;
  raster::Block* records;
  RASTRUM_HD void operator()(std::size_t i, Local&) const {
    const raster::Block& record = queues.staged.records[i];
    records[queues.first[boxes.number(record)] + queues.staged.ranks[i]] = record;
  }
  RASTRUM_HD void end(const Local&) const {}
};

template <class Pixel, class Frame, class Shade>
class LayerQueues {
 public:
  /// `frame` has the pieces of `left`; planes of keys and colours are `plane` elements apart. Room
  /// for `room` records. The kQueueCounters counters and *held are 0, on the device.
  LayerQueues(parallel::Cuda& exec, const Frame& frame, const raster::SamplePattern& samples,
              std::size_t plane, const raster::LeftPieces& left, std::size_t room,
              bool stores_shading, const DeviceLayerTuning& tuning, std::uint64_t* counters,
              std::uint64_t* held)
      : exec_(exec),
        frame_(frame),
        samples_(samples),
        plane_(plane),
        tuning_(tuning.within_teams(LowDensity::kRecords, HighDensity::kRecords)),
        blocks_(frame.columns() * frame.rows()),
        counts_(parallel::make_buffer<std::uint32_t>(exec, blocks_)),
        first_(parallel::make_buffer<std::uint64_t>(exec, blocks_)),
        low_(parallel::make_buffer<std::size_t>(exec, blocks_)),
        high_(parallel::make_buffer<std::size_t>(exec, blocks_)),
        deep_(parallel::make_buffer<std::size_t>(exec, blocks_)),
        records_(parallel::make_buffer<raster::Block>(exec, room)),
        shaded_(parallel::make_buffer<RecordOf<Shade>>(
            exec, kHasRecords<Shade> && stores_shading ? left.pieces.size() : 0)),
        left_(left),
        counters_(counters),
        held_(held) {
    if (shaded_.size() > 0) frame_.shaded = shaded_.data();
  }

  /// Enqueues all of it.
  void operator()() {
    using parallel::view_of;
    auto farthest = parallel::make_buffer<std::uint64_t>(exec_, blocks_);
    auto staged = parallel::make_buffer<raster::Block>(exec_, records_.size());
    auto ranks = parallel::make_buffer<std::uint32_t>(exec_, records_.size());
    const LayerQueueView queues{
        left_, {view_of(staged), view_of(ranks)}, view_of(counts_), view_of(first_), counters_,
        held_};
    parallel::for_each_index(
        exec_, blocks_,
        BeginBlock{{frame_.view, frame_.columns(), frame_.keys, plane_, samples_.count},
                   view_of(farthest),
                   view_of(counts_)});
    const BlocksOfPiece boxes{frame_.pieces,
                              view_of(std::as_const(farthest)),
                              frame_.columns(),
                              frame_.view.x0 / raster::kBlockSize,
                              frame_.view.y0 / raster::kBlockSize,
                              frame_.view,
                              samples_};
    raster::visit_blocks(exec_, left_, StageRecords{boxes, queues}, counters_ + kBoxRuns, held_);
    if constexpr (kHasRecords<Shade>)
      if (shaded_.size() > 0)
        parallel::for_each_strided<typename StoreShading<Shade>::Local>(
            exec_, left_.loop(), StoreShading<Shade>{left_, frame_.shade, shaded_.data()});
    parallel::for_each_team<PlaceBlocks::Scratch, 128>(
        exec_, (blocks_ + PlaceBlocks::kBlocks - 1) / PlaceBlocks::kBlocks,
        PlaceBlocks{queues, tuning_.low_records, tuning_.high_records, view_of(low_),
                    view_of(high_), view_of(deep_)});
    parallel::for_each_strided<ScatterRecord::Local>(exec_, {records_.size(), counters_ + kPlaced},
                                                     ScatterRecord{queues, boxes, records_.data()});
    each_group([&](const Frame& frame) {
      blend_teams<LowDensity>(frame, view_of(low_), kLowBlocks);
      blend_teams<HighDensity>(frame, view_of(high_), kHighBlocks);
    });
  }

  /// After the host has read their number. Waits.
  void blend_deep_blocks(std::uint64_t blocks) {
    const std::uint64_t most = tuning_.most_fragments();
    const auto deep =
        parallel::view_of(std::as_const(deep_)).first(static_cast<std::size_t>(blocks));
    each_group([&](const Frame& frame) {
      for (int s = 0; s < Frame::kSamples; ++s)
        blend_deep<Pixel>(exec_, frame, view(), deep, s, most, counters_);
    });
  }

 private:
  [[nodiscard]] RecordView view() const {
    return {records_.data(), parallel::view_of(first_), 0, parallel::view_of(counts_)};
  }
  template <class F>
  void each_group(F&& f) const {
    for (int first = 0; first < samples_.count; first += Frame::kSamples)
      f(frame_.from_sample(samples_, first, plane_));
  }
  template <class Density>
  void blend_teams(const Frame& frame, std::span<const std::size_t> blocks, Counter count) {
    using Blend = BlendBlock<Density, Pixel, Frame>;
    parallel::for_each_team<typename Blend::Scratch, Blend::kThreads, Blend::kResident>(
        exec_, {blocks.size(), counters_ + count}, Blend{frame, view(), blocks, counters_});
  }

  parallel::Cuda& exec_;
  Frame frame_;
  const raster::SamplePattern samples_;
  const std::size_t plane_;
  const DeviceLayerTuning tuning_;
  const std::size_t blocks_;
  parallel::DeviceBuffer<std::uint32_t> counts_;
  parallel::DeviceBuffer<std::uint64_t> first_;
  parallel::DeviceBuffer<std::size_t> low_, high_, deep_;
  parallel::DeviceBuffer<raster::Block> records_;
  parallel::DeviceBuffer<RecordOf<Shade>> shaded_;
  raster::LeftPieces left_;
  std::uint64_t* counters_;
  std::uint64_t* held_;
};

}  // namespace rastrum::transparency::cuda
