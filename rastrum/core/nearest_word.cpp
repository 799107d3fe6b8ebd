// SPDX-License-Identifier: BSD-3-Clause
// The distance is the restricted Damerau–Levenshtein distance (optimal string alignment): no letter
// is edited twice.
#include <rastrum/core/nearest_word.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <rastrum/core/lower.hpp>

namespace rastrum {
namespace {

bool same(char a, char b) {
  return lower(a) == lower(b);
}

std::size_t distance(std::string_view a, std::string_view b) {
  // Rows of the table: the last but one, the last, the current one.
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool equal = same(a[i - 1], b[j - 1]);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (equal ? 0 : 1)});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(now);
  }
  return last[b.size()];
}

}  // namespace

std::string_view nearest_word(std::string_view given, std::span<const std::string_view> words) {
  constexpr std::size_t kShortestBeginning = 3;
  std::string_view nearest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string_view word : words) {
    const std::size_t d = distance(given, word);
    if (d * 3 <= std::max(given.size(), word.size()) && d < least) {
      nearest = word;
      least = d;
    }
  }
  if (!nearest.empty() || given.size() < kShortestBeginning) return nearest;
  for (const std::string_view word : words)
    if (word.size() > given.size() && std::equal(given.begin(), given.end(), word.begin(), same))
      return word;
  return {};
}

std::string did_you_mean(std::string_view given, std::span<const std::string_view> words) {
  const std::string_view word = nearest_word(given, words);
  return word.empty() ? std::string() : "; did you mean '" + std::string(word) + "'?";
}

}  // namespace rastrum
