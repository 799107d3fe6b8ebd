// Numbers as text, with a point in every locale: std::to_string, printf and streams would follow
// the locale of the program that uses the library.
#pragma once

#include <charconv>
#include <string>

namespace rastrum {

/// The shortest text that reads as the same number.
template <class Number>
[[nodiscard]] std::string number_text(Number value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}
/// As printf's %.6g with so many digits, at most 17.
[[nodiscard]] inline std::string number_text(double value, int digits) {
  char text[32];
  return {text,
          std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr};
}
/// As printf's %.2f with so many decimals, at most 9.
[[nodiscard]] inline std::string fixed_text(double value, int decimals) {
  char text[330];  // the greatest double has 309 digits
  return {text,
          std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr};
}

}  // namespace rastrum
