// SPDX-License-Identifier: BSD-3-Clause
// ASCII letters in lower case, in every locale.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace rastrum {

[[nodiscard]] constexpr char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}
[[nodiscard]] inline std::string lower(std::string text) {
  for (char& c : text) c = lower(c);
  return text;
}
[[nodiscard]] inline bool equal_but_for_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace rastrum
