// What the members of a team do together in their shared memory: a sort, prefix sums, and the
// atomics of words that several of them change. For bodies of for_each_team; every member calls
// them.
//
// Sources: Batcher, "Sorting networks and their applications", 1968 (bitonic); Blelloch, "Prefix
// sums and their applications", 1990 (two sweeps over a tree). Both are in place and right for a
// team of any size: an element's value never waits in a register for a sync.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <rastrum/config.hpp>

namespace rastrum::parallel {

/// word |= bits, by many threads at once.
/// 32 bits, which shared memory has an instruction for.
RASTRUM_HD inline void atomic_or(std::uint32_t& word, std::uint32_t bits) noexcept {
#if defined(__CUDA_ARCH__)
  atomicOr(&word, bits);
#else
  std::atomic_ref<std::uint32_t>(word).fetch_or(bits, std::memory_order_relaxed);
#endif
}

/// The next power of two: how many elements the two below need room for.
[[nodiscard]] RASTRUM_HD constexpr std::size_t team_room(std::size_t n) {
  std::size_t room = 1;
  while (room < n) room *= 2;
  return room;
}

namespace team_detail {

/// Fills the room behind n pairs with what sorts last.
template <class K, class V, class Team>
RASTRUM_HD void fill_room(K* keys, V* values, std::size_t n, std::size_t room, const Team& team) {
  for (std::size_t i = n + team.rank(); i < room; i += team.size()) {
    keys[i] = std::numeric_limits<K>::max();
    values[i] = V{};
  }
  team.sync();
}
/// Compares and exchanges pairs that lie `step` apart, in runs that rise and fall by turns.
template <class K, class V, class Team>
RASTRUM_HD void bitonic_step(K* keys, V* values, std::size_t room, std::size_t run,
                             std::size_t step, const Team& team) {
  for (std::size_t i = team.rank(); i < room / 2; i += team.size()) {
    const std::size_t below = i & (step - 1);
    const std::size_t a = (i - below) * 2 + below, b = a + step;
    const K first = keys[a], second = keys[b];
    const bool rising = (a & run) == 0;
    if (rising ? !(second < first) : !(first < second)) continue;
    keys[a] = second;
    keys[b] = first;
    const V value = values[a];
    values[a] = values[b];
    values[b] = value;
  }
  team.sync();
}

#if defined(__CUDA_ARCH__)
/// Of 32 values by a team that is a warp: in registers, without the syncs of the two sweeps.
template <class T, class Team>
__device__ void warp_prefix_sums(T* values, const Team& team) {
  const auto lane = static_cast<unsigned>(team.rank());
  T sum = values[lane];
  for (unsigned step = 1; step < 32; step *= 2) {
    const T before = __shfl_up_sync(~0U, sum, step);
    if (lane >= step) sum += before;
  }
  values[lane + 1] = sum;
  if (lane == 0) values[0] = 0;
  team.sync();
}
#endif

}  // namespace team_detail

/// Sorts n pairs by their keys, ascending; keys are unsigned, and for equal ones the order is open.
/// Overwrites team_room(n) keys and values. Begins and ends with a sync.
/// Work O(n log² n), span O(log² n) steps of n / team.
template <class K, class V, class Team>
RASTRUM_HD void team_sort(K* keys, V* values, std::size_t n, const Team& team) {
  const std::size_t room = team_room(n);
  team_detail::fill_room(keys, values, n, room, team);
  for (std::size_t run = 2; run <= room; run *= 2)
    for (std::size_t step = run / 2; step > 0; step /= 2)
      team_detail::bitonic_step(keys, values, room, run, step, team);
}

/// values[i] becomes the sum of the first i values, for i ≤ n: the last is the sum of all.
/// Overwrites team_room(n) + 1 values. Begins and ends with a sync. Work O(n), span O(log n) steps.
template <class T, class Team>
RASTRUM_HD void team_prefix_sums(T* values, std::size_t n, const Team& team) {
  const std::size_t room = team_room(n);
  for (std::size_t i = n + team.rank(); i < room; i += team.size()) values[i] = 0;
  team.sync();
#if defined(__CUDA_ARCH__)
  if (room == 32 && team.size() == 32) return team_detail::warp_prefix_sums(values, team);
#endif
  for (std::size_t step = 1; step < room; step *= 2) {
    for (std::size_t i = team.rank(); i < room / (2 * step); i += team.size())
      values[(2 * i + 2) * step - 1] += values[(2 * i + 1) * step - 1];
    team.sync();
  }
  if (team.rank() == 0) {
    values[room] = values[room - 1];
    values[room - 1] = 0;
  }
  team.sync();
  for (std::size_t step = room / 2; step > 0; step /= 2) {
    for (std::size_t i = team.rank(); i < room / (2 * step); i += team.size()) {
      T& left = values[(2 * i + 1) * step - 1];
      T& right = values[(2 * i + 2) * step - 1];
      const T sum = left + right;
      left = right;
      right = sum;
    }
    team.sync();
  }
}

}  // namespace rastrum::parallel
