// SPDX-License-Identifier: BSD-3-Clause
// Exact transparency on a device with the colours and holes of generated scenes, for nvcc and, on
// the CPU, for a C++ compiler.
#include "layers_on_device.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/transparency/cuda/device_layers.cuh>

namespace rastrum::test {
namespace {

/// The first number of Random(v).
RASTRUM_HD std::uint64_t mix(std::uint64_t v) {
  std::uint64_t z = v + 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

/// LayerScene's colours: Paint::triangle, or Paint::pixel.
struct PaintFragment {
  std::span<const Vec4> paint;
  std::span<const std::uint8_t> opaque;
  bool by_pixel;

  RASTRUM_HD Vec4 operator()(std::uint64_t key, int x, int y) const {
    const std::uint64_t id = raster::id_of_key(key);
    const Vec4 c = paint[id];
    if (!by_pixel) return c;
    const std::uint64_t h =
        mix(id << 32 ^ static_cast<std::uint64_t>(y) << 16 ^ static_cast<std::uint64_t>(x));
    const auto factor = [&](int shift) {
      return 0.5F + 0.5F * static_cast<float>(h >> shift & 255) / 255;
    };
    const float a = opaque[id] != 0 ? 1 : factor(0);
    return {c.x * a * factor(8), c.y * a * factor(16), c.z * a * factor(24), c.w * a};
  }
};
/// LayerScene::is_hole, for scenes with holes.
struct IsNoHole {
  RASTRUM_HD bool operator()(std::uint64_t key, int x, int y) const {
    const std::uint64_t id = raster::id_of_key(key);
    return id % 2 != 0 ||
           mix(id << 32 ^ static_cast<std::uint64_t>(x) << 16 ^ static_cast<std::uint64_t>(y)) %
                   3 !=
               0;
  }
};

/// Rows [y0, y1) of a frame on the device.
class OnDevice {
 public:
  OnDevice(parallel::Cuda& exec, const LayersFrame& f, int y0, int y1)
      : exec_(exec),
        view_{0, y0, f.width, y1},
        by_pixel_(f.by_pixel),
        pieces_(parallel::to_device(exec, f.pieces)),
        keys_(parallel::to_device(exec, in_blocks(f.keys))),
        colors_(parallel::to_device(exec, in_blocks(f.colors))),
        paint_(parallel::to_device(exec, f.paint)),
        opaque_(parallel::to_device(exec, f.opaque)) {}

  transparency::DeviceLayerCounts blend(const TransparencyOptions& options,
                                        const transparency::DeviceLayerTuning& tuning) {
    using parallel::view_of;
    const transparency::DeviceLayers layers{view_, view_of(std::as_const(pieces_)), view_of(keys_),
                                            view_of(colors_)};
    return transparency::blend_layers(exec_, layers, options, painter(), IsNoHole{}, tuning);
  }
  /// The same by queues, which a rasterizer has filled. If one is too small, by the listing.
  transparency::DeviceLayerCounts blend(const TransparencyOptions& options,
                                        const transparency::DeviceLayerTuning& tuning,
                                        const QueueRooms& rooms) {
    using parallel::view_of;
    namespace cuda = transparency::cuda;
    const std::size_t room = rooms.pieces == 0 ? pieces_.size() + 1 : rooms.pieces;
    auto pieces = parallel::make_buffer<raster::Piece>(exec_, room);
    parallel::cuda_system::copy(exec_.stream(), pieces.data(), pieces_.data(),
                                std::min(room, pieces_.size()) * sizeof(raster::Piece));
    // The queue's counter, *held, and those of the layers.
    std::vector<std::uint64_t> begin(2 + cuda::kQueueCounters, 0);
    begin[0] = pieces_.size();
    auto counters = parallel::to_device(exec_, begin);
    transparency::LeftLayers left;
    left.pieces = {view_of(pieces), counters.data()};
    left.records = rooms.records == 0 ? std::size_t{1} << 16 : rooms.records;
    left.held = counters.data() + 1;
    left.counters = counters.data() + 2;
    const transparency::DeviceLayers layers{view_, view_of(std::as_const(pieces)), view_of(keys_),
                                            view_of(colors_)};
    transparency::LayerQueueCounts last;
    const auto finish = [&](const std::uint64_t* held) {
      const auto now = parallel::to_host(exec_, counters);
      last.pieces = now[0];
      std::copy(now.begin() + 2, now.end(), last.of.begin());
      // Kernels that make the picture read *held.
      is_held_ = held != nullptr && now[1] != 0;
      return last;
    };
    if (!transparency::blend_left_layers(exec_, layers, left, options, painter(), IsNoHole{},
                                         tuning, finish)) {
      if (!is_held_) throw std::logic_error("a picture that is not done was not held");
      ++rooms.too_small;
      return blend(options, tuning);
    }
    if (is_held_) throw std::logic_error("a picture that is done was held");
    return last.layers();
  }
  void fetch(LayersFrame& out) {
    const auto keys = parallel::to_host(exec_, keys_);
    const auto colors = parallel::to_host(exec_, colors_);
    each_pixel([&](std::size_t pixel, std::size_t element) {
      out.keys[pixel] = keys[element];
      out.colors[pixel] = colors[element];
    });
  }

 private:
  [[nodiscard]] PaintFragment painter() const {
    return {parallel::view_of(paint_), parallel::view_of(opaque_), by_pixel_};
  }
  /// Calls f(index in the frame's rows, index in the view's blocks).
  template <class F>
  void each_pixel(F f) const {
    const auto columns = static_cast<std::size_t>((view_.x1 + 7) / 8);
    for (int y = view_.y0; y < view_.y1; ++y)
      for (int x = 0; x < view_.x1; ++x) {
        const auto u = static_cast<std::size_t>(x), v = static_cast<std::size_t>(y - view_.y0);
        f(static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.x1) + u,
          ((v / 8) * columns + u / 8) * 64 + v % 8 * 8 + u % 8);
      }
  }
  template <class T>
  [[nodiscard]] std::vector<T> in_blocks(const std::vector<T>& rows) const {
    const auto columns = static_cast<std::size_t>((view_.x1 + 7) / 8);
    std::vector<T> out(columns * static_cast<std::size_t>((view_.y1 - view_.y0 + 7) / 8) * 64);
    each_pixel([&](std::size_t pixel, std::size_t element) { out[element] = rows[pixel]; });
    return out;
  }

  parallel::Cuda& exec_;
  const raster::Rect view_;
  const bool by_pixel_;
  bool is_held_ = false;
  parallel::DeviceBuffer<raster::Piece> pieces_;
  parallel::DeviceBuffer<std::uint64_t> keys_;
  parallel::DeviceBuffer<Vec4> colors_, paint_;
  parallel::DeviceBuffer<std::uint8_t> opaque_;
};

struct TeamScratch {
  std::uint32_t keys[kMostTeamKeys], places[kMostTeamKeys], sums[kMostTeamKeys + 1];
};
struct TeamKeys {
  std::span<const std::uint32_t> in;
  std::span<std::uint32_t> sorted, places, order, sums;
  template <class Team>
  RASTRUM_HD void operator()(std::size_t, TeamScratch& s, const Team& team) const {
    const std::size_t n = in.size();
    for (std::size_t i = team.rank(); i < n; i += team.size()) {
      s.keys[i] = s.sums[i] = in[i];
      s.places[i] = static_cast<std::uint32_t>(i);
    }
    parallel::team_sort(s.keys, s.places, n, team);
    parallel::team_prefix_sums(s.sums, n, team);
    for (std::size_t i = team.rank(); i < n; i += team.size()) {
      sorted[i] = s.keys[i];
      places[i] = s.places[i];
    }
    for (std::size_t i = team.rank(); i <= n; i += team.size()) sums[i] = s.sums[i];
    team.sync();
    for (std::size_t i = team.rank(); i < n; i += team.size()) s.keys[i] = in[i];
    parallel::team_order(s.keys, s.places, n, team);
    for (std::size_t i = team.rank(); i < n; i += team.size()) order[i] = s.places[i];
  }
};

}  // namespace

transparency::DeviceLayerCounts blend_on_device(LayersFrame& frame,
                                                const TransparencyOptions& options,
                                                const transparency::DeviceLayerTuning& tuning,
                                                int band_rows, const QueueRooms& rooms) {
  parallel::Cuda exec;
  transparency::DeviceLayerCounts sum;
  const int rows = band_rows == 0 ? frame.height : band_rows;
  for (int y = 0; y < frame.height; y += rows) {
    OnDevice band(exec, frame, y, std::min(y + rows, frame.height));
    const transparency::DeviceLayerCounts c =
        rooms.are_there ? band.blend(options, tuning, rooms) : band.blend(options, tuning);
    band.fetch(frame);
    sum.add(c);
  }
  return sum;
}

std::uint64_t growth_of_a_second_frame(const LayersFrame& frame) {
  parallel::Cuda exec;
  OnDevice first(exec, frame, 0, frame.height), second(exec, frame, 0, frame.height);
  first.blend({}, {});
  const std::uint64_t held = exec.memory()->held();
  second.blend({}, {});
  return exec.memory()->held() - held;
}

TeamResult team_keys(const std::vector<std::uint32_t>& values) {
  parallel::Cuda exec;
  const auto in = parallel::to_device(exec, values);
  auto sorted = parallel::make_buffer<std::uint32_t>(exec, values.size());
  auto places = parallel::make_buffer<std::uint32_t>(exec, values.size());
  auto order = parallel::make_buffer<std::uint32_t>(exec, values.size());
  auto sums = parallel::make_buffer<std::uint32_t>(exec, values.size() + 1);
  parallel::for_each_team<TeamScratch, 64>(
      exec, 1,
      TeamKeys{parallel::view_of(in), parallel::view_of(sorted), parallel::view_of(places),
               parallel::view_of(order), parallel::view_of(sums)});
  return {parallel::to_host(exec, sorted), parallel::to_host(exec, places),
          parallel::to_host(exec, order), parallel::to_host(exec, sums)};
}

}  // namespace rastrum::test
