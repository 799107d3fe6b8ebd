// SPDX-License-Identifier: BSD-3-Clause
// The original Voxel Space program under node (peers/voxel_space.js), in a process of its own that
// draws on command, interleaved with ours.
#pragma once

#include <cstdint>
#include <memory>

#include <rastrum/terrain.hpp>

namespace rastrum::bench {

class NodePeer {
 public:
  /// `map`: 1024², whole heights 0 to 255. Throws Error{no_device}, which says what to install, if
  /// node does not start.
  NodePeer(const terrain::HeightMap& map, int width, int height, double distance);
  ~NodePeer();
  NodePeer(NodePeer&&) noexcept;

  /// FNV-1a over the pixels of the default camera's frame, as 0xAABBGGRR words.
  [[nodiscard]] std::uint64_t hash() const;
  /// Draws frames for 30 ms and returns their median.
  [[nodiscard]] double turn_ms();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::bench
