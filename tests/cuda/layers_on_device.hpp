// SPDX-License-Identifier: BSD-3-Clause
// Layers on the build's device, for tests that do not depend on it.
#pragma once

#include <cstdint>
#include <vector>

#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/transparency/cuda/device_layers.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::test {

/// A frame on the host: pieces, the opaque surface, and the source of a LayerScene's colours.
struct LayersFrame {
  int width = 0, height = 0;
  std::vector<raster::Piece> pieces;
  std::vector<std::uint64_t> keys;
  std::vector<Vec4> colors;
  std::vector<Vec4> paint;           ///< by id
  std::vector<std::uint8_t> opaque;  ///< by id
  bool by_pixel = false;             ///< Paint::pixel; else Paint::triangle
};

/// The sizes of the queues that blend layers without the host (layer_queues.cuh).
struct QueueRooms {
  bool are_there = false;               ///< otherwise the listing blends
  std::size_t pieces = 0, records = 0;  ///< sizes of these queues; 0: enough for any test
  mutable std::uint64_t too_small = 0;  ///< bands with too small a queue, which were listed
};

/// Changes keys and colours, rows of pixels here, like blend_layers, in bands of `band_rows` rows
/// (whole blocks); 0: at once. Counts are of all bands.
transparency::DeviceLayerCounts blend_on_device(LayersFrame& frame,
                                                const TransparencyOptions& options,
                                                const transparency::DeviceLayerTuning& tuning,
                                                int band_rows = 0, const QueueRooms& rooms = {});
/// Draws the same frame twice. Returns by how many bytes the second one grew the device's memory.
std::uint64_t growth_of_a_second_frame(const LayersFrame& frame);

/// Sorts pairs, orders keys and sums up in a team's memory: results of team.cuh for at most
/// kMostTeamKeys `values`.
inline constexpr std::size_t kMostTeamKeys = 1024;
struct TeamResult {
  std::vector<std::uint32_t> sorted, places, order, sums;
};
TeamResult team_keys(const std::vector<std::uint32_t>& values);

}  // namespace rastrum::test
