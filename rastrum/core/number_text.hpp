// SPDX-License-Identifier: BSD-3-Clause
// Numbers as text with a decimal point, whatever the locale; std::to_string, printf and streams
// depend on it.
#pragma once

#include <charconv>
#include <string>
#include <type_traits>

namespace rastrum {

/// The shortest text that reads back as the same number.
template <class Number>
[[nodiscard]] std::string number_text(Number value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}
/// As printf's %.6g with `digits` digits, at most 17.
[[nodiscard]] inline std::string number_text(double value, int digits) {
  char text[32];
  return {text,
          std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr};
}
/// As printf's %.2f with `decimals` decimals, at most 9.
[[nodiscard]] inline std::string fixed_text(double value, int decimals) {
  char text[330];  // the greatest double has 309 digits
  return {text,
          std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr};
}

/// Concatenates the parts; numbers as number_text writes them.
template <class... Parts>
[[nodiscard]] std::string text_of(const Parts&... parts) {
  std::string text;
  const auto add = [&](const auto& part) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(part)>>)
      text.append(number_text(part));
    else
      text.append(part);
  };
  (add(parts), ...);
  return text;
}

}  // namespace rastrum
