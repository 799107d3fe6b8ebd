// SPDX-License-Identifier: BSD-3-Clause
// Layers on whatever the build calls a device, for tests that do not know of it.
#pragma once

#include <cstdint>
#include <vector>

#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/transparency/cuda/device_layers.hpp>
#include <rastrum/vec.hpp>

namespace rastrum::test {

/// A frame on the host: pieces, the opaque surface, and what the colours of a LayerScene are made
/// of.
struct LayersFrame {
  int width = 0, height = 0;
  std::vector<raster::Piece> pieces;
  std::vector<std::uint64_t> keys;
  std::vector<Vec4> colors;
  std::vector<Vec4> paint;           ///< by id
  std::vector<std::uint8_t> opaque;  ///< by id
  bool by_pixel = false;             ///< Paint::pixel; else Paint::triangle
};

/// Room of the queues by which layers are blended without the host (layer_queues.cuh).
struct QueueRooms {
  bool are_there = false;               ///< else the listing blends them
  std::size_t pieces = 0, records = 0;  ///< of these; 0: as many as a frame of any test needs
  mutable std::uint64_t too_small = 0;  ///< bands of which a queue was, so that they were listed
};

/// Changes keys and colours, which are rows of pixels here, as blend_layers does: in bands of
/// `band_rows` rows, whole blocks; 0: at once. Counts are those of all bands.
transparency::DeviceLayerCounts blend_on_device(LayersFrame& frame,
                                                const TransparencyOptions& options,
                                                const transparency::DeviceLayerTuning& tuning,
                                                int band_rows = 0, const QueueRooms& rooms = {});
/// Two frames alike, one after the other: by how many bytes the second made the device's memory
/// grow.
std::uint64_t growth_of_a_second_frame(const LayersFrame& frame);

/// Sorts pairs, orders keys and sums up, in a team's memory: what team.cuh makes of `values`, of
/// which there are at most so many.
inline constexpr std::size_t kMostTeamKeys = 1024;
struct TeamResult {
  std::vector<std::uint32_t> sorted, places, order, sums;
};
TeamResult team_keys(const std::vector<std::uint32_t>& values);

}  // namespace rastrum::test
