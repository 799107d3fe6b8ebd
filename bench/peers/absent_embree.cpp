// SPDX-License-Identifier: BSD-3-Clause
// Replaces the Embree peer in builds without it. Its constructor throws.
#include "embree_peer.hpp"

#include <rastrum/error.hpp>

namespace rastrum::bench {

struct EmbreePeer::Impl {};

EmbreePeer::EmbreePeer(int) {
  throw Error(Errc::no_device, "Embree: this build is without it (Debian: libembree-dev)");
}
// No object exists, so these are never called.
EmbreePeer::~EmbreePeer() = default;
std::string EmbreePeer::description() const {
  return {};
}
void EmbreePeer::set_mesh(const MeshView&) {}
void EmbreePeer::set_spheres(std::span<const Vec3>, std::span<const float>) {}
void EmbreePeer::set_tubes(std::span<const Vec3>, std::span<const float>,
                           std::span<const std::uint32_t>) {}
void EmbreePeer::build() {}
void EmbreePeer::trace(const Camera&, ImageView<Rgba8>) {}

}  // namespace rastrum::bench
