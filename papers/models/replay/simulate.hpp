// SPDX-License-Identifier: BSD-3-Clause
// The replay of recorded loops on simulated workers: what a frame would take with more cores than
// there are, if each of its tasks took as long as it did on one.
//
// It simulates Threads (rastrum/parallel/exec.cpp) with oneTBB's simple partitioner. A worker
// splits a range in halves, puts up the right one at the end of its own queue and goes on with the
// left one. A free worker takes the last of its own queue, else the first of a random other one's.
// A loop ends when all its tasks have ended and its caller has seen it. Loops in order take indices
// from a counter. The caller alone runs what is between two loops.
//
// It does not simulate memory that all share (bandwidth, caches, sockets), or cores that slow down
// together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/parallel/recording.hpp>

namespace rastrum::bench {

/// Costs of oneTBB itself, ns.
struct LoopCosts {
  double loop = 0;       ///< a loop, on the thread that begins it
  double task = 0;       ///< a task: splitting a range, its begin and end
  double take = 0;       ///< from a range that is put up to its begin on another worker
  double look = 0;       ///< a look into another worker's queue that is empty
  double claim = 0;      ///< the next index of a loop in order; one worker at a time
  double join = 0;       ///< from the end of the last task to the caller, where another had it
  double wake = 0;       ///< until workers that sleep have begun; each wakes two
  double linger = 1e18;  ///< workers sleep after so long without a loop
};

/// Recorded loops as they are replayed, in ns.
struct ReplayedLoop {
  double before = 0;  ///< the caller alone, since the loop before (or the frame's begin)
  bool in_order = false;
  std::size_t n = 0, grain = 1;
  std::vector<double> at;  ///< by the first index of a task: how long it took; n elements

  [[nodiscard]] double work() const;
  [[nodiscard]] double largest() const;
  [[nodiscard]] std::size_t tasks() const;
};
struct ReplayedFrame {
  std::vector<ReplayedLoop> loops;
  double after = 0;  ///< the caller alone, after the last loop
};

/// The frames of one scene as one: the median of each task and of each gap. Frames whose loops
/// differ from the last one's are left out. `begin_ns` and `end_ns` are those of the frames.
struct RecordedFrame {
  parallel::Recording recording;
  std::int64_t begin_ns = 0, end_ns = 0;
};
[[nodiscard]] ReplayedFrame median_frame(std::span<const RecordedFrame> frames);

/// How long a loop takes on so many workers, from its begin on the caller's thread to when that
/// goes on; they `sleep` when it begins or wait for it. The same for the same arguments.
/// Throws Error{invalid_argument} where the tasks are not those that its ranges are split into.
[[nodiscard]] double replay(const ReplayedLoop& loop, int workers, const LoopCosts& costs,
                            bool sleep = false);

/// The frame: of each loop what it takes, and their sum with what is between them.
struct Replay {
  std::vector<double> loops;
  double ns = 0;
};
[[nodiscard]] Replay replay(const ReplayedFrame& frame, int workers, const LoopCosts& costs);

}  // namespace rastrum::bench
