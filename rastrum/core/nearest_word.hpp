// SPDX-License-Identifier: BSD-3-Clause
// "Did you mean": finds the nearest word to one that is unknown.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace rastrum {

/// The first of the nearest words that need at most a third of their letters left out, added,
/// changed or swapped with a neighbour. Otherwise the first that begins with `given`, if that has
/// at least three letters. Otherwise empty. Ignores case. Cost: O(words · length²).
[[nodiscard]] std::string_view nearest_word(std::string_view given,
                                            std::span<const std::string_view> words);

/// "; did you mean 'word'?", or nothing.
[[nodiscard]] std::string did_you_mean(std::string_view given,
                                       std::span<const std::string_view> words);

}  // namespace rastrum
