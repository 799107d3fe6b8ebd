// SPDX-License-Identifier: BSD-3-Clause
// "Did you mean": the nearest of some words to one that is not among them.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace rastrum {

/// The first of the nearest words, where one is near enough to be meant: it begins with `given` (of
/// at least three letters), or at most a third of its letters are left out, added, changed or
/// swapped with their neighbour, whatever their case. Else empty.
/// Cost: O(words · length²).
[[nodiscard]] std::string_view nearest_word(std::string_view given,
                                            std::span<const std::string_view> words);

/// "; did you mean 'word'?", or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view given,
                                       std::span<const std::string_view> words);

}  // namespace rastrum
