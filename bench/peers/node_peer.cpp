// SPDX-License-Identifier: BSD-3-Clause
#include "node_peer.hpp"

#include <span>
#include <string>
#include <vector>

#include "child.hpp"

namespace rastrum::bench {

struct NodePeer::Impl {
  TemporaryFile file;
  Child child;
  std::uint64_t hash = 0;

  Impl(const terrain::HeightMap& map, int width, int height, double distance)
      : child("node (apt-get install nodejs)",
              {"node", RASTRUM_BENCH_DIR "/peers/voxel_space.js", written(file, map),
               std::to_string(width), std::to_string(height), std::to_string(distance)}) {
    try {
      hash = std::stoull(child.line(), nullptr, 16);
    } catch (const std::exception&) {
      throw Error(Errc::no_device, "node: voxel_space.js did not draw");
    }
  }
  static const std::string& written(const TemporaryFile& file, const terrain::HeightMap& map) {
    std::vector<std::uint8_t> heights;
    for (const float h : map.heights.pixels())
      heights.push_back(static_cast<std::uint8_t>(static_cast<int>(h)));
    file.write(std::span<const std::uint8_t>(heights), map.colors.pixels());
    return file.name();
  }
};

NodePeer::NodePeer(const terrain::HeightMap& map, int width, int height, double distance)
    : impl_(std::make_unique<Impl>(map, width, height, distance)) {}
NodePeer::~NodePeer() = default;
NodePeer::NodePeer(NodePeer&&) noexcept = default;

std::uint64_t NodePeer::hash() const {
  return impl_->hash;
}

double NodePeer::turn_ms() {
  impl_->child.tell("");
  const std::string answer = impl_->child.line();
  if (answer.empty()) throw Error(Errc::unsupported, "node: its process ended");
  return std::stod(answer);
}

}  // namespace rastrum::bench
