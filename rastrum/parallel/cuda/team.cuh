// SPDX-License-Identifier: BSD-3-Clause
// Functions for bodies of for_each_team, in shared memory: sorting, ordering, prefix sums, atomics.
// Every member calls them.
//
// Sources: Batcher, "Sorting networks and their applications", 1968 (bitonic); Blelloch, "Prefix
// sums and their applications", 1990 (two sweeps over a tree). Both work in place for any team
// size, because no member holds a value across a sync. A GPU's teams are whole warps, so one warp
// sums few values in registers.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <rastrum/config.hpp>

namespace rastrum::parallel {

/// word |= bits, atomically. 32 bits, for which shared memory has an instruction.
RASTRUM_HD inline void atomic_or(std::uint32_t& word, std::uint32_t bits) noexcept {
#if defined(__CUDA_ARCH__)
  atomicOr(&word, bits);
#else
  std::atomic_ref<std::uint32_t>(word).fetch_or(bits, std::memory_order_relaxed);
#endif
}

/// The next power of two: the room that the functions below need for n elements.
[[nodiscard]] RASTRUM_HD constexpr std::size_t team_room(std::size_t n) {
  std::size_t room = 1;
  while (room < n) room *= 2;
  return room;
}

namespace team_detail {

/// Pads n pairs with keys that sort last.
template <class K, class V, class Team>
RASTRUM_HD void fill_room(K* keys, V* values, std::size_t n, std::size_t room, const Team& team) {
  for (std::size_t i = n + team.rank(); i < room; i += team.size()) {
    keys[i] = std::numeric_limits<K>::max();
    values[i] = V{};
  }
  team.sync();
}
/// Compares and exchanges pairs `step` apart; runs alternately ascend and descend.
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
/// team_prefix_sums of `room` values, a power of two, in the first warp: each lane takes a run of
/// them, which saves the syncs of the two sweeps.
template <class T, class Team>
__device__ void warp_prefix_sums(T* values, std::size_t room, const Team& team) {
  constexpr unsigned kLanes = 32;
  if (team.rank() < kLanes) {
    const auto lane = static_cast<unsigned>(team.rank()), n = static_cast<unsigned>(room);
    const unsigned each = n < kLanes ? 1 : n / kLanes;
    T* const mine = values + lane * each;
    const unsigned count = lane < n ? each : 0;
    T sum{};
    for (unsigned k = 0; k < count; ++k) sum += mine[k];
    T until = sum;
    for (unsigned step = 1; step < kLanes; step *= 2) {
      const T before = __shfl_up_sync(~0U, until, step);
      if (lane >= step) until += before;
    }
    T before = until - sum;
    for (unsigned k = 0; k < count; ++k) {
      const T value = mine[k];
      mine[k] = before;
      before += value;
    }
    if (lane == kLanes - 1) values[room] = before;
  }
  team.sync();
}
#endif

}  // namespace team_detail

/// Sorts n pairs by unsigned keys, ascending; not stable. Overwrites team_room(n) keys and values.
/// Begins and ends with a sync. Work O(n log² n), span O(log² n) steps of n / team.
template <class K, class V, class Team>
RASTRUM_HD void team_sort(K* keys, V* values, std::size_t n, const Team& team) {
  const std::size_t room = team_room(n);
  team_detail::fill_room(keys, values, n, room, team);
  for (std::size_t run = 2; run <= room; run *= 2)
    for (std::size_t step = run / 2; step > 0; step /= 2)
      team_detail::bitonic_step(keys, values, room, run, step, team);
}

/// order[i] becomes the index of the i-th smallest of n keys; equal keys come in any order.
/// Overwrites team_room(n) of both. Begins and ends with a sync. Few keys take O(n²) work without
/// syncs between (each member counts the keys before its own), more that of team_sort.
template <class K, class V, class Team>
RASTRUM_HD void team_order(K* keys, V* order, std::size_t n, const Team& team) {
  constexpr std::size_t kFew = 256;
  if (n > kFew) {
    for (std::size_t k = team.rank(); k < n; k += team.size()) order[k] = static_cast<V>(k);
    return team_sort(keys, order, n, team);
  }
  team.sync();
  const auto count = static_cast<std::uint32_t>(n);
  for (std::uint32_t k = static_cast<std::uint32_t>(team.rank()); k < count;
       k += static_cast<std::uint32_t>(team.size())) {
    const K key = keys[k];
    std::uint32_t before = 0;
    for (std::uint32_t j = 0; j < count; ++j)
      before += keys[j] < key || (keys[j] == key && j < k) ? 1 : 0;
    order[before] = static_cast<V>(k);
  }
  team.sync();
}

/// values[i] becomes the sum of the first i values for i ≤ n, so values[n] is the total. Overwrites
/// team_room(n) + 1 values. Begins and ends with a sync. Work O(n), span O(log n) steps.
template <class T, class Team>
RASTRUM_HD void team_prefix_sums(T* values, std::size_t n, const Team& team) {
  const std::size_t room = team_room(n);
  for (std::size_t i = n + team.rank(); i < room; i += team.size()) values[i] = 0;
  team.sync();
#if defined(__CUDA_ARCH__)
  constexpr std::size_t kByAWarp = 256;
  if (room <= kByAWarp) return team_detail::warp_prefix_sums(values, room, team);
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
