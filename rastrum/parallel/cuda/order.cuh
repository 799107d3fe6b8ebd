// SPDX-License-Identifier: BSD-3-Clause
// Which folds may be cut anywhere: those with the same bits for any grouping and, except in scans,
// any order of the operands. All others keep the CPU's cut (reduce.hpp).
#pragma once

#include <concepts>
#include <functional>

#include <rastrum/parallel/reduce_by_index.hpp>

namespace rastrum::parallel {

/// Whether operands may come in any order. Specialize it for associative and commutative functions.
template <class T, class Op>
inline constexpr bool kAnyOrder = false;
template <std::integral T>
inline constexpr bool kAnyOrder<T, std::plus<>> = true;
template <std::integral T>
inline constexpr bool kAnyOrder<T, std::plus<T>> = true;
template <std::integral T>
inline constexpr bool kAnyOrder<T, std::bit_or<>> = true;
template <std::integral T>
inline constexpr bool kAnyOrder<T, Maximum> = true;

/// Whether operands may be grouped in any way, in their order, which suffices for a scan.
/// Specialize it for associative functions.
template <class T, class Op>
inline constexpr bool kAnyGrouping = kAnyOrder<T, Op>;

}  // namespace rastrum::parallel
