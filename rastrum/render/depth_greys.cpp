// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/depth_greys.hpp>

#include <algorithm>
#include <vector>

#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum {
namespace {

/// Rows of a work item: a row of 1024 px takes less time than its scheduling.
constexpr std::size_t kRows = 16;

void widen(const float* depth, std::size_t n, DepthRange& range) noexcept {
  for (std::size_t x = 0; x < n; ++x) {
    if (!(depth[x] > 0)) continue;
    range.nearest = std::max(range.nearest, depth[x]);
    range.farthest = std::min(range.farthest, depth[x]);
  }
}

void grey_row(const float* depth, std::size_t n, const DepthGreys& greys, Rgba8* out) noexcept {
  for (std::size_t x = 0; x < n; ++x) {
    const float grey = greys.at(depth[x]);
    out[x] = depth[x] > 0 ? raster::to_straight_rgba8({grey, grey, grey, 1}) : greys.behind8;
  }
}

template <class F>
void for_each_row(std::size_t rows, parallel::Threads* threads, const F& f) {
  const std::size_t parts = (rows + kRows - 1) / kRows;
  parallel::for_each_index(threads, parts, [&](std::size_t part) {
    for (std::size_t y = part * kRows; y < std::min(rows, (part + 1) * kRows); ++y)
      f(part, static_cast<int>(y));
  });
}

}  // namespace

constexpr DepthLanes kScalarDepthLanes{widen, grey_row};

void depths_of_keys(ImageView<const std::uint64_t> keys, ImageView<float> depth,
                    parallel::Threads* threads) {
  for_each_row(static_cast<std::size_t>(depth.height), threads, [&](std::size_t, int y) {
    for (int x = 0; x < depth.width; ++x) depth(x, y) = raster::depth_of_key(keys(x, y));
  });
}

void stretch_depth(ImageView<float> depth, Vec4 background, const Targets& targets, Isa isa,
                   parallel::Threads* threads) {
  const DepthLanes& lanes = depth_lanes(isa);
  const auto width = static_cast<std::size_t>(depth.width);
  const auto rows = static_cast<std::size_t>(depth.height);

  std::vector<DepthRange> ranges((rows + kRows - 1) / kRows);
  for_each_row(rows, threads,
               [&](std::size_t part, int y) { lanes.widen(depth.row(y), width, ranges[part]); });
  DepthRange all;
  for (const DepthRange& range : ranges) {
    all.nearest = std::max(all.nearest, range.nearest);
    all.farthest = std::min(all.farthest, range.farthest);
  }
  const float scale = all.nearest > all.farthest ? 1 / (all.nearest - all.farthest) : 0.0F;
  const Vec4 behind = raster::premultiplied_from_straight(background);
  const DepthGreys greys{all.nearest, scale, raster::to_straight_rgba8(behind)};
  for_each_row(rows, threads, [&](std::size_t, int y) {
    const float* const row = depth.row(y);
    if (!targets.color8.empty()) lanes.greys(row, width, greys, targets.color8.row(y));
    if (targets.color.empty()) return;
    Vec4* const out = targets.color.row(y);
    for (std::size_t x = 0; x < width; ++x) {
      const float grey = greys.at(row[x]);
      out[x] = row[x] > 0 ? Vec4{grey, grey, grey, 1} : behind;
    }
  });
}

}  // namespace rastrum
