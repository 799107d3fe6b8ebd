// SPDX-License-Identifier: BSD-3-Clause
// Replays recorded loops on simulated workers: how long a frame would take on more cores than there
// are, if each of its tasks took as long as on one.
//
// Simulates Threads (rastrum/parallel/exec.cpp) with oneTBB's simple partitioner. A worker halves a
// range, queues the right half at the end of its own queue and goes on with the left one. A free
// worker takes the last of its own queue, else the first of a random other one's. A loop ends when
// all its tasks have ended and its caller has seen it. Loops in order take indices from a counter.
// The caller alone runs what is between two loops.
//
// It does not simulate shared memory (bandwidth, caches, sockets) or cores that slow down together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/parallel/recording.hpp>

namespace rastrum::bench {

/// Costs of oneTBB, ns.
struct LoopCosts {
  double loop = 0;       ///< a loop, on the calling thread
  double task = 0;       ///< a task: splitting a range, its begin and end
  double take = 0;       ///< from queueing a range to its start on another worker
  double look = 0;       ///< a look into another worker's empty queue
  double claim = 0;      ///< the next index of a loop in order; one worker at a time
  double join = 0;       ///< from the end of the last task to the caller, if another worker had it
  double wake = 0;       ///< until sleeping workers have started; each wakes two
  double linger = 1e18;  ///< how long workers wait for a loop before they sleep
};

/// Recorded loops as they are replayed, in ns.
struct ReplayedLoop {
  double before = 0;  ///< the caller alone, since the previous loop (or the frame's start)
  bool in_order = false;
  std::size_t n = 0, grain = 1;
  std::vector<double> at;  ///< duration of the task that starts at this index; n elements

  [[nodiscard]] double work() const;
  [[nodiscard]] double largest() const;
  [[nodiscard]] std::size_t tasks() const;
};
struct ReplayedFrame {
  std::vector<ReplayedLoop> loops;
  double after = 0;  ///< the caller alone, after the last loop
};

/// Merges the frames of one scene: the median of each task and of each gap. Frames whose loops
/// differ from the last one's are left out. `begin_ns` and `end_ns` belong to the frames.
struct RecordedFrame {
  parallel::Recording recording;
  std::int64_t begin_ns = 0, end_ns = 0;
};
[[nodiscard]] ReplayedFrame median_frame(std::span<const RecordedFrame> frames);

/// How long the caller waits for a loop on `workers` workers. `sleep`: the others sleep when it
/// begins. Deterministic. Throws Error{invalid_argument} if the tasks are not those that its ranges
/// split into.
[[nodiscard]] double replay(const ReplayedLoop& loop, int workers, const LoopCosts& costs,
                            bool sleep = false);

/// The time of each loop, and the sum of all loops and gaps.
struct Replay {
  std::vector<double> loops;
  double ns = 0;
};
[[nodiscard]] Replay replay(const ReplayedFrame& frame, int workers, const LoopCosts& costs);

}  // namespace rastrum::bench
