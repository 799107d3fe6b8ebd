// SPDX-License-Identifier: BSD-3-Clause
// atomic on a device: the 64-bit maximum of keys (paper 1, section 3.2.3), one thread a sample.
#pragma once

#include <cstdint>
#include <span>

#include <papers/axes/fragments.cuh>

namespace rastrum::family {

struct RaiseKey {
  const Piece* pieces;
  SurfaceView keys;
  RASTRUM_HD void operator()(const Block& b, int i) const {
    const Fragment f = fragment_at(pieces, keys, b, i);
    parallel::atomic_maximum(keys.keys[f.element], f.key);
  }
};

/// Work O(fragments); no memory.
template <class Exec>
class AtomicOnDevice final : public DeviceVisibility<Exec> {
 public:
  explicit AtomicOnDevice(FamilyFrame<Exec>&) {}
  void resolve(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
               std::span<const Block> blocks, std::uint64_t) override {
    for_each_sample(frame.exec, blocks, RaiseKey{pieces.data(), frame.surface.keys});
  }
};

}  // namespace rastrum::family
