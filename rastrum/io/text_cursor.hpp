// SPDX-License-Identifier: BSD-3-Clause
// Text files: lines, tokens, numbers, and errors that name file and line. std::from_chars rounds
// correctly, so a file gives the same bits on every machine.
#pragma once

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <rastrum/error.hpp>

namespace rastrum::io {

/// Replaces what does not print by question marks, for messages.
[[nodiscard]] inline std::string printable(std::string_view s) {
  std::string r(s);
  std::ranges::replace_if(
      r, [](char c) { return c < ' ' || c > '~'; }, '?');
  return r;
}
/// At most 20 printable characters of `s` in quotes, for messages.
[[nodiscard]] inline std::string quoted(std::string_view s) {
  return std::string("'").append(printable(s.substr(0, 20))).append("'");
}

/// The length of UTF-8's byte order mark: 0 or 3. Throws Error{unsupported} for UTF-16.
[[nodiscard]] inline std::size_t byte_order_mark(std::string_view text, const std::string& name) {
  // UTF-16 without its mark: one byte of each letter is 0.
  const bool wide = text.size() > 3 && (text[0] == '\0') != (text[1] == '\0') &&
                    (text[0] == '\0') == (text[2] == '\0') &&
                    (text[1] == '\0') == (text[3] == '\0');
  if (wide || text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw Error(Errc::unsupported, name + ": is text in UTF-16; save it as UTF-8");
  return text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
}

/// Borrows `text` and `name`.
class TextCursor {
 public:
  TextCursor(std::string_view text, const std::string& name)
      : begin_(text.data()), at_(begin_), end_(begin_ + text.size()), name_(&name) {}

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  [[nodiscard]] std::string_view text() const {
    return {begin_, static_cast<std::size_t>(end_ - begin_)};
  }
  [[nodiscard]] std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
  [[nodiscard]] std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  [[nodiscard]] char peek() const { return at_ == end_ ? '\n' : *at_; }
  void advance(std::size_t n) { at_ += n; }

  static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
  }
  static bool is_space(char c) { return is_blank(c) || c == '\n'; }

  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  void skip_space() {
    while (at_ != end_ && is_space(*at_)) ++at_;
  }
  void skip_line() {
    at_ = std::find(at_, end_, '\n');
    if (at_ != end_) ++at_;
  }
  /// The rest of this line without the line end; moves to the next line.
  std::string_view line() {
    const char* first = at_;
    const char* last = std::find(at_, end_, '\n');
    at_ = last == end_ ? end_ : last + 1;
    while (last != first && is_blank(last[-1])) --last;
    return {first, static_cast<std::size_t>(last - first)};
  }
  /// Skips blanks. True if nothing else is left of this line.
  [[nodiscard]] bool at_line_end() {
    skip_blanks();
    return at_ == end_ || *at_ == '\n';
  }
  /// The characters up to the next space; empty at the end.
  std::string_view token() {
    skip_space();
    const char* first = at_;
    while (at_ != end_ && !is_space(*at_)) ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  /// The next number, after blanks or, with `across_lines`, any space.
  template <class T>
  T number(const char* what, bool across_lines = false) {
    across_lines ? skip_space() : skip_blanks();
    T value{};
    const auto [next, error] = parse(value);
    if (error == std::errc::result_out_of_range)
      fail(std::string(what) + " is out of range: " + excerpt());
    if (error != std::errc{}) fail(std::string("expected ") + what + ", found " + excerpt());
    at_ = next;
    return value;
  }
  /// Likewise, for formats where a space must follow.
  template <class T>
  T word(const char* what, bool across_lines = false) {
    const T value = number<T>(what, across_lines);
    if (at_ != end_ && !is_space(*at_))
      fail(std::string("expected ") + what + ", found " + excerpt());
    return value;
  }

  /// Likewise without an error: none if no such word is next on this line.
  template <class T>
  std::optional<T> optional_word() {
    skip_blanks();
    T value{};
    const auto [next, error] = parse(value);
    if (error != std::errc{} || (next != end_ && !is_space(*next))) return {};
    at_ = next;
    return value;
  }

  [[noreturn]] void fail(const std::string& message) const { fail_at(offset(), message); }
  /// Throws for the line that holds `offset`.
  [[noreturn]] void fail_at(std::size_t offset, const std::string& message) const {
    throw Error(Errc::bad_format, *name_ + ":" + std::to_string(line_of(offset)) + ": " + message);
  }
  /// Counted on demand: keeping it would slow every reader.
  [[nodiscard]] std::size_t line_of(std::size_t offset) const {
    assert(offset <= static_cast<std::size_t>(end_ - begin_));
    return 1 + static_cast<std::size_t>(std::count(begin_, begin_ + offset, '\n'));
  }

 private:
  [[nodiscard]] std::string excerpt() const {
    if (at_ == end_) return "the end of the file";
    if (*at_ == '\n') return "the end of the line";
    const char* last = std::find_if(at_, end_, is_space);
    return quoted({at_, static_cast<std::size_t>(last - at_)});
  }
  /// As std::from_chars, but a plus may come first, and no float is out of range.
  template <class T>
  std::from_chars_result parse(T& value) const {
    const char* first = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
    std::from_chars_result read = std::from_chars(first, end_, value);
    if constexpr (std::is_floating_point_v<T>)
      if (read.ec == std::errc::result_out_of_range) {
        value = out_of_range<T>(first, read.ptr);
        read.ec = {};
      }
    return read;
  }
  /// from_chars does not set a value out of range: this gives the nearest of 0 and infinity.
  template <class T>
  static T out_of_range(const char* first, const char* last) {
    double wide = 0;
    if (std::from_chars(first, last, wide).ec == std::errc{}) {
      if (std::abs(wide) < 1) return static_cast<T>(wide);
      return std::copysign(std::numeric_limits<T>::infinity(), static_cast<T>(wide < 0 ? -1 : 1));
    }
    // Beyond float64, too. Tiny if the exponent is negative or, without one, only zeros precede the
    // point.
    const bool negative = *first == '-';
    const char* e = std::find_if(first, last, [](char c) { return c == 'e' || c == 'E'; });
    const bool tiny =
        e != last ? e + 1 != last && e[1] == '-' : *std::find_if(first, last, [](char c) {
          return c == '.' || (c >= '1' && c <= '9');
        }) == '.';
    const T magnitude = tiny ? T{0} : std::numeric_limits<T>::infinity();
    return negative ? -magnitude : magnitude;
  }

  const char* begin_;
  const char* at_;
  const char* end_;
  const std::string* name_;
};

/// A whole text file. If lines end in CR alone, as on old Macs, it is copied with LF instead.
class TextFile {
 public:
  /// Borrows its arguments. Throws as byte_order_mark.
  TextFile(std::string_view text, const std::string& name)
      : text_(text.substr(byte_order_mark(text, name))), name_(&name) {
    if (text_.find('\n') != std::string_view::npos || text_.find('\r') == std::string_view::npos)
      return;
    copy_ = text_;
    std::replace(copy_.begin(), copy_.end(), '\r', '\n');
    text_ = copy_;
  }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  [[nodiscard]] TextCursor cursor() const { return {text_, *name_}; }

 private:
  std::string copy_;
  std::string_view text_;
  const std::string* name_;
};

}  // namespace rastrum::io
