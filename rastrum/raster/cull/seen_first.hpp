// SPDX-License-Identifier: BSD-3-Clause
// In which order a frame draws what may be hidden: first the clusters that the last one saw, then
// those that are not hidden by that (Greene, Kass and Miller, "Hierarchical Z-buffer visibility",
// 1993). A method draws the first ones, looks at what is seen, and draws the rest; it keeps keys
// of the whole view between the two.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/core/memory.hpp>
#include <rastrum/raster/cull/depth_map.hpp>
#include <rastrum/raster/cull/selection.hpp>

namespace rastrum::raster {

/// Which clusters were seen in the frame before, so that they are drawn first in this one. A hint:
/// whatever it says, all that may be seen is drawn.
class LastSeen {
 public:
  /// Whether something is known of the frame's clusters.
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

  /// Chooses among triangles [first, last) of the frame. Returns whether to look for hidden ones,
  /// which no frame does without `may_look`: there are so many triangles that it can pay, and where
  /// it did not in the frame that last looked, it is tried only now and then.
  [[nodiscard]] bool choose(FrameContext& frame, std::uint64_t first, std::uint64_t last,
                            bool may_look);
  /// All that was chosen, for a frame that does not look for hidden ones.
  [[nodiscard]] std::span<const SetupRun> all() { return selection_.runs(); }

  /// The runs to draw first. Nothing is known of depths() then.
  [[nodiscard]] std::span<const SetupRun> first(const FrameContext& frame);
  /// The rest, as far as depths() do not hide it.
  [[nodiscard]] std::span<const SetupRun> rest(FrameContext& frame);
  /// After all of it: learns for the next frame. `cost`: of keeping keys and looking at them, in
  /// triangles that might be set up instead.
  void finish(FrameContext& frame, std::uint64_t cost);

  /// The caller tells it what is seen in each bin.
  [[nodiscard]] DepthMap& depths() { return depths_; }

 private:
  enum class State : std::uint8_t { first, later, hidden };
  /// Some candidates, one after the other, so that tasks are large.
  struct Part {
    std::size_t runs = 0, first_run = 0;
    SetupRun last{.cluster = 0};
    std::uint64_t drawn = 0, missed = 0, hidden = 0;
  };
  template <class F>
  void for_each(const FrameContext& frame, const F& f);
  std::span<const SetupRun> collect(const FrameContext& frame, State state);

  /// Fewer triangles are set up sooner than keys of a picture are kept.
  static constexpr std::uint64_t kLeastTriangles = 50'000;
  /// Frames at most that do not look after one that found too little: 1, 3, 7 and so on, each time
  /// in a row.
  static constexpr int kMostWaits = 15;
  /// Where more than this part of what is seen was not seen before, which clusters face the viewer
  /// is the better hint.
  static constexpr std::uint64_t kWorth = 8;

  Selection selection_;
  DepthMap depths_;
  LastSeen seen_;
  ScratchBuffer<SetupRun> runs_;
  std::vector<State> state_;  ///< by candidate
  std::vector<Part> parts_;
  std::size_t at_once_ = 1;  ///< candidates of a part
  bool knows_ = false;
  bool is_hinted_ = true;     ///< what the last frame saw tells what this one sees
  double seen_part_ = 1;      ///< of the triangles of the last frame that looked
  int waits_ = 0, wait_ = 0;  ///< after the last frame that looked, and still
};

}  // namespace rastrum::raster
