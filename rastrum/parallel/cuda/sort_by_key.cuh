// SPDX-License-Identifier: BSD-3-Clause
// sort_by_key on a device: CUB's radix sort of the low bits.
//
// Work O(n · bits), span O(bits · log n). Allocates n keys, n values and CUB's scratch. Does not
// wait. Source: Adinets and Merrill, "Onesweep", 2022.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>

#include <rastrum/parallel/cuda/buffer.cuh>

namespace rastrum::parallel {

/// As on the CPU (sort_by_key.hpp): stable, by the low `bits` bits of unsigned keys.
template <class Keys, class Values>
void sort_by_key(Cuda& exec, Keys&& key_range, Values&& value_range, int bits = -1) {
  const auto keys = device_view(key_range);
  const auto values = device_view(value_range);
  using K = typename decltype(keys)::value_type;
  using V = typename decltype(values)::value_type;
  static_assert(std::unsigned_integral<K>);
  assert(keys.size() == values.size());
  if (bits < 0) bits = std::numeric_limits<K>::digits;
  assert(bits <= std::numeric_limits<K>::digits);
  const std::size_t n = keys.size();
  if (n < 2 || bits == 0) return;
  auto other_keys = make_buffer<K>(exec, n);
  auto other_values = make_buffer<V>(exec, n);
  K* key_rooms[2] = {keys.data(), other_keys.data()};
  V* value_rooms[2] = {values.data(), other_values.data()};
  const int at = cuda_system::sort_pairs(
      exec.stream(), key_rooms, value_rooms, n, bits,
      [&](std::size_t bytes) { return make_buffer<std::byte>(exec, bytes); });
  if (at == 0) return;
  cuda_system::copy(exec.stream(), keys.data(), other_keys.data(), n * sizeof(K));
  cuda_system::copy(exec.stream(), values.data(), other_values.data(), n * sizeof(V));
}

}  // namespace rastrum::parallel
