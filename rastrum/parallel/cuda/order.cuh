// SPDX-License-Identifier: BSD-3-Clause
// Which folds may be cut anywhere: those whose result is the same bits however the operands are
// grouped and, but for scans, in whatever order they come. All others keep the CPU's cut
// (reduce.hpp).
#pragma once

#include <concepts>
#include <functional>

#include <rastrum/parallel/reduce_by_index.hpp>

namespace rastrum::parallel {

/// Whether operands may come in any order. Specialize it for an associative and commutative
/// function of yours.
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

/// Whether operands may be grouped in any way, in their order: enough for a scan. Specialize it for
/// an associative function.
template <class T, class Op>
inline constexpr bool kAnyGrouping = kAnyOrder<T, Op>;

}  // namespace rastrum::parallel
