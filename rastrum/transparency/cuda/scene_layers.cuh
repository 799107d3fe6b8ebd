// SPDX-License-Identifier: BSD-3-Clause
// The layers of a scene on a device: translucent pieces of a band of rows, left by the rasterizer
// or set up here, over its opaque surface (device_layers.cuh). A band whose pieces take too much
// memory is cut in two, down to a row of blocks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <rastrum/raster/cuda/pieces.cuh>
#include <rastrum/raster/cuda/samples.cuh>
#include <rastrum/stop.hpp>
#include <rastrum/transparency/cuda/device_layers.cuh>

namespace rastrum::transparency {
namespace cuda {

struct IsLayerIn {
  raster::Rect view;
  raster::SamplePattern samples;
  RASTRUM_HD bool operator()(const raster::Piece& piece) const {
    return (piece.flags & kTranslucent) != 0 &&
           !raster::sampled_bounds(piece, view, samples).empty();
  }
};

}  // namespace cuda

/// For render/cuda/frame.cuh.
class SceneLayers {
 public:
  [[nodiscard]] static std::string_view why_not(const raster::FrameRequest& request) {
    return why_not_on_a_device(request.transparency);
  }

  /// Blends the translucent pieces of `scene` over `colors`, laid out as the keys of `surface` with
  /// all planes, and raises those keys. `shade` and `test` as for blend_layers; `shade` is a
  /// raster::ShadedOnce if there are several samples. `batch`: primitives that are set up at once;
  /// `bytes`: limit of pieces, and again of records; 0: none. Waits.
  template <class Exec, class Shade, class Test>
  void blend(Exec& exec, const raster::DeviceScene<Exec>& scene,
             const raster::DeviceSurface& surface, std::span<Vec4> colors,
             const TransparencyOptions& options, const Shade& shade, const Test& test,
             std::uint64_t batch, std::uint64_t bytes);
  /// blend() for pieces that the rasterizer has left in a queue; waits only in `finish`
  /// (blend_left_layers). Returns false if nothing was blended; then blend() has to.
  template <class Shade, class Test>
  [[nodiscard]] bool blend_left(parallel::Cuda& exec, const LeftLayers& left,
                                const raster::DeviceSurface& surface, std::span<Vec4> colors,
                                const TransparencyOptions& options, const Shade& shade,
                                const Test& test, std::uint64_t bytes, const FinishBand& finish);
  [[nodiscard]] std::uint64_t most_records() const { return most_records_; }
  void count(FrameStats& stats) const {
    stats.visibility = "layers";
    stats.fragments += counts_.fragments;
    const std::pair<const char*, std::uint64_t> all[] = {
        {"translucent fragments", counts_.fragments}, {"layer blocks", counts_.records},
        {"low blocks", counts_.low_blocks},           {"high blocks", counts_.high_blocks},
        {"deep blocks", counts_.deep_blocks},         {"turns", counts_.turns},
        {"repaired pixels", counts_.repaired},        {"deepest", counts_.deepest}};
    for (const auto& [name, value] : all) stats.counters.emplace_back(name, value);
  }

 private:
  template <class Exec, class Shade, class Test>
  struct Band {
    Exec& exec;
    const raster::DeviceScene<Exec>& scene;
    const raster::DeviceSurface& surface;
    std::span<Vec4> colors;
    const TransparencyOptions& options;
    const Shade& shade;
    const Test& test;
    std::uint64_t batch, bytes;

    template <class F>
    void each_batch(const raster::Rect& view, F&& f) const {
      const std::uint64_t end = scene.first_id() + scene.primitives();
      for (std::uint64_t first = scene.first_id(); first < end; first += batch) {
        throw_if_stopped();
        const raster::Assembly assembly{scene.geometry(), first, surface.samples};
        auto outcomes = parallel::make_buffer<raster::Outcome>(
            exec, static_cast<std::size_t>(std::min(batch, end - first)));
        parallel::tabulate(
            exec, outcomes,
            raster::cuda_detail::CountPieces<cuda::IsLayerIn>{assembly, {view, surface.samples}});
        f(assembly, outcomes);
      }
    }
  };

  template <class Exec, class Shade, class Test>
  void blend_rows(const Band<Exec, Shade, Test>& band, const raster::Rect& view) {
    using parallel::view_of;
    Exec& exec = band.exec;
    std::uint64_t count = 0;
    band.each_batch(view, [&](const raster::Assembly&, const auto& outcomes) {
      count += parallel::reduce(exec, outcomes, raster::Outcomes{}, raster::AddOutcomes{}).pieces;
    });
    if (count == 0) return;
    const int rows = raster::block_rows(view);
    if (band.bytes != 0 && count > band.bytes / sizeof(raster::Piece) && rows > 1) {
      const int middle = view.y0 + rows / 2 * raster::kBlockSize;
      blend_rows(band, {view.x0, view.y0, view.x1, middle});
      return blend_rows(band, {view.x0, middle, view.x1, view.y1});
    }
    auto pieces = parallel::make_buffer<raster::Piece>(exec, static_cast<std::size_t>(count));
    std::size_t at = 0;
    band.each_batch(view, [&](const raster::Assembly& assembly, const auto& outcomes) {
      const auto places =
          parallel::make_expansion(exec, view_of(outcomes), raster::cuda_detail::PiecesOf{});
      const auto which = parallel::counting(outcomes.size());
      parallel::for_each_index(
          exec, outcomes.size(),
          raster::cuda_detail::WritePieces<std::remove_cvref_t<decltype(which)>, cuda::IsLayerIn,
                                           decltype(places.view())>{
              assembly, which, {view, band.surface.samples}, places.view(), pieces.data() + at});
      at += places.size();
    });
    const std::size_t first =
        band.surface.keys.index(view.x0 / raster::kBlockSize, view.y0 / raster::kBlockSize) * 64;
    const auto before = static_cast<std::size_t>(band.surface.samples.count - 1);
    const std::size_t size = before * band.surface.plane + raster::block_count(view) * 64;
    DeviceLayerTuning tuning;
    tuning.bytes = band.bytes;
    const DeviceLayers layers{view,
                              view_of(std::as_const(pieces)),
                              {band.surface.keys.keys + first, size},
                              band.colors.subspan(first, size)};
    DeviceLayerCounts c;
    if constexpr (raster::kIsShadedOnce<Shade>)
      c = blend_sampled_layers(exec, {layers, band.surface.samples, band.surface.plane},
                               band.options, band.shade, band.test, tuning);
    else
      c = blend_layers(exec, layers, band.options, band.shade, band.test, tuning);
    counts_.add(c);
  }

  DeviceLayerCounts counts_;
  std::uint64_t most_records_ = 0;
};

// Not inline, so that one source can instantiate it for others.
template <class Exec, class Shade, class Test>
void SceneLayers::blend(Exec& exec, const raster::DeviceScene<Exec>& scene,
                        const raster::DeviceSurface& surface, std::span<Vec4> colors,
                        const TransparencyOptions& options, const Shade& shade, const Test& test,
                        std::uint64_t batch, std::uint64_t bytes) {
  const std::uint64_t before = counts_.records;
  blend_rows(
      Band<Exec, Shade, Test>{exec, scene, surface, colors, options, shade, test, batch, bytes},
      surface.view);
  most_records_ = std::max(most_records_, counts_.records - before);
}

template <class Shade, class Test>
bool SceneLayers::blend_left(parallel::Cuda& exec, const LeftLayers& left,
                             const raster::DeviceSurface& surface, std::span<Vec4> colors,
                             const TransparencyOptions& options, const Shade& shade,
                             const Test& test, std::uint64_t bytes, const FinishBand& finish) {
  const DeviceLayers layers{
      surface.view,
      left.pieces.pieces,
      {surface.keys.keys, static_cast<std::size_t>(surface.samples.count) * surface.plane},
      colors};
  DeviceLayerTuning tuning;
  tuning.bytes = bytes;
  LayerQueueCounts last;
  const FinishBand keep = [&](const std::uint64_t* held) { return last = finish(held); };
  bool done = false;
  if constexpr (raster::kIsShadedOnce<Shade>)
    done = blend_left_sampled_layers(exec, {layers, surface.samples, surface.plane}, left, options,
                                     shade, test, tuning, keep);
  else
    done = blend_left_layers(exec, layers, left, options, shade, test, tuning, keep);
  if (!done) return false;
  const DeviceLayerCounts counts = last.layers();
  counts_.add(counts);
  most_records_ = std::max(most_records_, counts.records);
  return true;
}

}  // namespace rastrum::transparency
