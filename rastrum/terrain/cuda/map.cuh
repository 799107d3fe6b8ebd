// SPDX-License-Identifier: BSD-3-Clause
// A height map in device memory: the caller's cells, read in place, the pyramid of MapFilter::mip,
// and the maxima that show what stays hidden. The CPU's functions (map_view.hpp, ceiling.hpp) make
// both on the device.
//
// Work O(cells), span O(log size) beside 256 reads of a thread. Takes a third of the map's bytes
// for the pyramid and a 256th for the maxima. Waits for the highest height.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <rastrum/parallel/cuda/elementwise.cuh>
#include <rastrum/terrain/ceiling.hpp>
#include <rastrum/terrain/map_view.hpp>
#include <rastrum/terrain/setup.hpp>

namespace rastrum::terrain {
namespace cuda_detail {

template <class F>
struct CellOfIndex {
  F f;
  int width;
  RASTRUM_HD auto operator()(std::size_t i) const {
    const auto columns = static_cast<std::size_t>(width);
    return f(static_cast<int>(i % columns), static_cast<int>(i / columns));
  }
};

}  // namespace cuda_detail

/// Images on the device, each made from the one before.
template <class T>
class DeviceLevels {
 public:
  explicit DeviceLevels(ImageView<const T> finest) { views_.push_back(finest); }

  /// Appends an image of f(x, y), `edge` times smaller than the last, rounded up.
  template <class F>
  void append(parallel::Cuda& exec, int edge, const F& f) {
    const int width = (views_.back().width + edge - 1) / edge;
    const int height = (views_.back().height + edge - 1) / edge;
    auto cells = parallel::make_buffer<T>(
        exec, static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    parallel::tabulate(exec, cells, cuda_detail::CellOfIndex<F>{f, width});
    views_.push_back({cells.data(), width, height, width});
    images_.push_back(std::move(cells));
  }
  [[nodiscard]] const ImageView<const T>& last() const { return views_.back(); }
  [[nodiscard]] bool is_one_cell() const { return last().width == 1 && last().height == 1; }

  /// Copies the list to the device. Does not wait: the levels must outlive the next wait.
  void finish(parallel::Cuda& exec) { list_ = parallel::upload(exec, views_); }
  [[nodiscard]] std::span<const ImageView<const T>> list(std::size_t first = 0) const {
    return std::span<const ImageView<const T>>(list_.data(), list_.size()).subspan(first);
  }

 private:
  std::vector<ImageView<const T>> views_;
  std::vector<parallel::DeviceBuffer<T>> images_;
  parallel::DeviceBuffer<ImageView<const T>> list_;
};

/// Device memory without gaps between rows. It must outlive what is made of it.
struct DeviceCells {
  ImageView<const float> heights;
  ImageView<const Rgba8> colors;  ///< of any size, stretched over the map
};

class DeviceMap {
 public:
  /// `whole`: with the pyramid of MapFilter::mip. Throws Error{invalid_argument} for a map without
  /// cells or with gaps between rows, Error{out_of_memory}.
  DeviceMap(parallel::Cuda& exec, const DeviceCells& cells, bool whole)
      : heights_(checked(cells.heights)), colors_(checked(cells.colors)), maxima_(cells.heights) {
    while (whole && !heights_.is_one_cell())
      heights_.append(exec, 2, HalvedCell<float>{heights_.last()});
    while (whole && !colors_.is_one_cell())
      colors_.append(exec, 2, HalvedCell<Rgba8>{colors_.last()});
    int edge = 1 << CeilingView::kFirstLevel;
    do {
      maxima_.append(exec, edge, HighestCell{maxima_.last(), edge});
      edge = 2;
    } while (!maxima_.is_one_cell());
    heights_.finish(exec);
    colors_.finish(exec);
    maxima_.finish(exec);
    highest_ = parallel::to_host(exec, std::span(maxima_.last().data, 1))[0];
    levels_ = {heights_.list(),      colors_.list(),     cells.heights.width,
               cells.heights.height, cells.colors.width, cells.colors.height};
  }
  [[nodiscard]] const MapLevels& levels() const { return levels_; }
  [[nodiscard]] CeilingView ceiling() const {
    return {maxima_.list(1), levels_.width, levels_.height};
  }
  [[nodiscard]] Extent extent() const { return {levels_.width, levels_.height, highest_}; }

 private:
  template <class T>
  [[nodiscard]] static ImageView<const T> checked(ImageView<const T> cells) {
    if (cells.empty() || cells.width < 1 || cells.height < 1 || cells.stride != cells.width)
      throw Error(Errc::invalid_argument,
                  "terrain: a map on the device must have cells, heights and colours, row by row "
                  "without gaps");
    return cells;
  }

  DeviceLevels<float> heights_;
  DeviceLevels<Rgba8> colors_;
  DeviceLevels<float> maxima_;  ///< the ceiling's levels, from level 1 on
  MapLevels levels_;
  float highest_ = 0;
};

class DeviceSetup {
 public:
  /// Does not wait: `setup` must stay until the next wait on `exec`.
  DeviceSetup(parallel::Cuda& exec, const Setup& setup)
      : shared_(setup),
        ux_(parallel::upload(exec, setup.ux)),
        uy_(parallel::upload(exec, setup.uy)),
        slices_(parallel::upload(exec, setup.slices)) {}
  [[nodiscard]] SetupView view() const {
    return {shared_,
            {ux_.data(), ux_.size()},
            {uy_.data(), uy_.size()},
            {slices_.data(), slices_.size()}};
  }

 private:
  SharedSetup shared_;
  parallel::DeviceBuffer<float> ux_, uy_;
  parallel::DeviceBuffer<Slice> slices_;
};

}  // namespace rastrum::terrain
