// reduce_by_index and segmented_reduce_by_index on a device; see the headers of these names for
// what they compute.
//
// The 64-bit maximum is the device's own atomic, in place: work O(n), span O(1) beside what
// contended words cost. Other functions sort and reduce runs, as on the CPU.
// segmented_reduce_by_index gives a segment to a team, each member of which owns every size-th bin
// and folds what is its own out of all values of the segment, in order: no atomics, any function,
// the CPU's bits. Work O(team · n + segments · bins), span O(longest segment). Allocates two values
// a bin of each team.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <type_traits>
#include <utility>

#include <rastrum/parallel/cuda/by_key.cuh>
#include <rastrum/parallel/cuda/sort_by_key.cuh>
#include <rastrum/parallel/segmented_reduce_by_index.hpp>

namespace rastrum::parallel {
namespace cuda_detail {

/// Whether 0 ≤ index < bins, of any integers.
template <class Index>
[[nodiscard]] RASTRUM_HD constexpr bool in_range(Index index, std::size_t bins) {
  if constexpr (std::is_signed_v<Index>)
    if (index < 0) return false;
  return static_cast<std::size_t>(index) < bins;
}

template <class Dest, class Indices, class Values>
struct MaximumInPlace {
  Dest dest;
  Indices indices;
  Values values;
  RASTRUM_HD void operator()(std::size_t i) const {
    if (in_range(indices[i], dest.size()))
      atomic_maximum(dest[static_cast<std::size_t>(indices[i])],
                     static_cast<std::uint64_t>(values[i]));
  }
};
template <class Indices>
struct IndexInRange {
  Indices indices;
  std::size_t bins;
  RASTRUM_HD bool operator()(std::size_t i) const { return in_range(indices[i], bins); }
};
template <class Indices>
struct KeyAt {
  Indices indices;
  RASTRUM_HD std::size_t operator()(std::size_t i) const {
    return static_cast<std::size_t>(indices[i]);
  }
};
template <class T, class Values>
struct ValueAt {
  Values values;
  std::span<const std::size_t> position;
  RASTRUM_HD T operator()(std::size_t k) const { return static_cast<T>(values[position[k]]); }
};
template <class Dest, class T, class Op>
struct FoldIntoBin {
  Dest dest;
  std::span<const std::size_t> keys;
  std::span<const T> sums;
  Op op;
  RASTRUM_HD void operator()(std::size_t k) const {
    Op plus = op;
    T& bin = dest[keys[k]];
    bin = static_cast<T>(plus(bin, sums[k]));
  }
};

/// Histograms of the segments t, t + teams, … by team t, whose bins are [2t, 2t + 2) · bins.
template <class First, class Indices, class Values, class T, class Op, class F>
struct Histograms {
  First first;
  Indices indices;
  Values values;
  std::size_t bins, teams, per_piece;
  T neutral;
  Op op;
  F f;
  T* room;

  template <class Team>
  RASTRUM_HD void operator()(std::size_t t, std::byte&, const Team& team) const {
    T* const sum = room + 2 * t * bins;
    for (std::size_t s = t; s < first.size(); s += teams) {
      const std::size_t begin = static_cast<std::size_t>(first[s]);
      const std::size_t end =
          s + 1 < first.size() ? static_cast<std::size_t>(first[s + 1]) : indices.size();
      fill(begin, end, sum, team);
      team.sync();
      if (team.rank() == 0) f(s, std::span<const T>(sum, bins));
      team.sync();
    }
  }
  template <class Team>
  RASTRUM_HD void fill(std::size_t begin, std::size_t end, T* sum, const Team& team) const {
    Op plus = op;
    T* const piece = sum + bins;
    for (std::size_t at = begin; at == begin || at < end; at += per_piece) {
      T* const bin = at == begin ? sum : piece;
      for (std::size_t b = team.rank(); b < bins; b += team.size()) bin[b] = neutral;
      const std::size_t stop = end - at < per_piece ? end : at + per_piece;
      for (std::size_t i = at; i < stop; ++i) {
        if (!in_range(indices[i], bins)) continue;
        const auto b = static_cast<std::size_t>(indices[i]);
        if (b % team.size() == team.rank())
          bin[b] = static_cast<T>(plus(bin[b], static_cast<T>(values[i])));
      }
      if (at == begin) continue;
      for (std::size_t b = team.rank(); b < bins; b += team.size())
        sum[b] = static_cast<T>(plus(sum[b], piece[b]));
    }
  }
};

}  // namespace cuda_detail

template <Writable Dest, Readable Indices, Readable Values, class Op>
void reduce_by_index(Cuda& exec, Dest&& dest, const Indices& indices, const Values& values, Op op) {
  using T = std::remove_cvref_t<decltype(dest[0])>;
  assert(std::size(indices) == std::size(values));
  auto to = device_view(dest);
  auto at = device_view(indices);
  auto from = device_view(values);
  const std::size_t n = std::size(indices), bins = std::size(dest);
  if constexpr (std::is_same_v<T, std::uint64_t> && std::is_same_v<Op, Maximum>) {
    for_each_index(
        exec, n,
        cuda_detail::MaximumInPlace<decltype(to), decltype(at), decltype(from)>{to, at, from});
  } else {
    auto position = filter(exec, counting(n), cuda_detail::IndexInRange<decltype(at)>{at, bins});
    auto key = make_buffer<std::size_t>(exec, position.size());
    transform(exec, position, key, cuda_detail::KeyAt<decltype(at)>{at});
    sort_by_key(exec, key, position, static_cast<int>(std::bit_width(bins)));
    const auto sums = reduce_by_key(
        exec, key,
        Computed(position.size(), cuda_detail::ValueAt<T, decltype(from)>{from, view_of(position)}),
        op);
    for_each_index(exec, sums.keys.size(),
                   cuda_detail::FoldIntoBin<decltype(to), T, Op>{to, view_of(sums.keys),
                                                                 view_of(sums.values), op});
  }
}

/// f is called by one member of a team; its span is memory of the device.
template <Readable First, Readable Indices, Readable Values, class T, class Op, class F>
void segmented_reduce_by_index(Cuda& exec, const First& first, const Indices& indices,
                               const Values& values, std::size_t bins, T neutral, Op op, F&& f) {
  assert(std::size(indices) == std::size(values));
  constexpr std::size_t kMostTeams = 2048;  // more than any device has at work at a time
  const std::size_t teams = std::size(first) < kMostTeams ? std::size(first) : kMostTeams;
  const std::size_t per_piece = kHistogramPiece > 4 * bins ? kHistogramPiece : 4 * bins;
  auto room = make_buffer<T>(exec, 2 * teams * bins);
  using Body = cuda_detail::Histograms<decltype(device_view(first)), decltype(device_view(indices)),
                                       decltype(device_view(values)), T, Op, std::decay_t<F>>;
  for_each_team<std::byte>(exec, teams,
                           Body{device_view(first), device_view(indices), device_view(values), bins,
                                teams, per_piece, neutral, op, f, room.data()});
}

}  // namespace rastrum::parallel
