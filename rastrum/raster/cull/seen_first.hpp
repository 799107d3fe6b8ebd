// SPDX-License-Identifier: BSD-3-Clause
// The order in which a frame draws what may be hidden: first the clusters that the last frame saw,
// then those that these do not hide (Greene, Kass and Miller, "Hierarchical Z-buffer visibility",
// 1993). A method draws the first, finds the depths seen, and draws the rest. It keeps keys of the
// whole view between the two.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/cull/depth_map.hpp>
#include <rastrum/raster/cull/selection.hpp>

namespace rastrum::raster {

/// The clusters that the last frame saw, to be drawn first in this one. Only a hint: all that may
/// be seen is drawn.
class LastSeen {
 public:
  [[nodiscard]] bool knows(const Selection& now) const {
    return fingerprint_ == now.fingerprint() && slots_ == now.slots();
  }
  [[nodiscard]] bool has(std::uint64_t slot) const { return seen_[slot] != 0; }
  void begin(const Selection& now) {
    fingerprint_ = now.fingerprint();
    slots_ = now.slots();
    seen_.assign(static_cast<std::size_t>(slots_), 0);
  }
  /// Thread-safe for distinct slots.
  void add(std::uint64_t slot) { seen_[slot] = 1; }

 private:
  std::uint64_t fingerprint_ = 0, slots_ = 0;
  std::vector<std::uint8_t> seen_;
};

class SeenFirst {
 public:
  explicit SeenFirst(MemoryAccount& memory) : selection_(memory), depths_(memory), runs_(memory) {}

  /// Chooses among triangles [first, last) of the frame. Returns whether to test for hidden ones:
  /// if `may_look`, and there are so many triangles that it can pay. After a frame where it did not
  /// pay it is tried only now and then.
  [[nodiscard]] bool choose(FrameContext& frame, std::uint64_t first, std::uint64_t last,
                            bool may_look);
  /// All that was chosen, for a frame that does not test for hidden ones.
  [[nodiscard]] std::span<const SetupRun> all() { return selection_.runs(); }

  /// The runs to draw first. depths() knows nothing yet.
  [[nodiscard]] std::span<const SetupRun> first(const FrameContext& frame);
  /// Without what depths() hides.
  [[nodiscard]] std::span<const SetupRun> rest(FrameContext& frame);
  /// After all of it: learns for the next frame. `cost`: of keeping and testing keys, in triangles
  /// that might be set up instead.
  void finish(FrameContext& frame, std::uint64_t cost);

  /// The caller stores here what is seen in each bin.
  [[nodiscard]] DepthMap& depths() { return depths_; }

 private:
  enum class State : std::uint8_t { first, later, hidden };
  /// Consecutive candidates, enough for a large task.
  struct Part {
    std::size_t runs = 0, first_run = 0;
    SetupRun last{.cluster = 0};
    std::uint64_t drawn = 0, missed = 0, hidden = 0;
  };
  template <class F>
  void for_each(const FrameContext& frame, const F& f);
  std::span<const SetupRun> collect(const FrameContext& frame, State state);

  /// Setting up fewer triangles is faster than keeping a picture's keys.
  static constexpr std::uint64_t kLeastTriangles = 50'000;
  /// Most frames in a row without a test, after tests that found too little: 1, 3, 7 and so on.
  static constexpr int kMostWaits = 15;
  /// Beyond this part (1/kWorth) of newly seen clusters, facing the viewer is the better hint.
  static constexpr std::uint64_t kWorth = 8;

  Selection selection_;
  DepthMap depths_;
  LastSeen seen_;
  ScratchBuffer<SetupRun> runs_;
  std::vector<State> state_;  ///< by candidate
  std::vector<Part> parts_;
  std::size_t at_once_ = 1;  ///< candidates of a part
  bool knows_ = false;
  bool is_hinted_ = true;     ///< what the last frame saw predicts this one
  double seen_part_ = 1;      ///< part of the triangles that the last frame with a test saw
  int waits_ = 0, wait_ = 0;  ///< frames without a test: in all, and still to come
};

}  // namespace rastrum::raster
