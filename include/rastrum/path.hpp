// SPDX-License-Identifier: BSD-3-Clause
// File names as functions take them. Paths of <filesystem> are taken without including it, because
// it takes longer to compile than what includes this file.
#pragma once

#include <concepts>
#include <string>
#include <string_view>

#include <rastrum/config.hpp>

namespace RASTRUM_API rastrum {

/// A view of a file's name: of text (`const char*`, std::string, std::string_view) or of a
/// std::filesystem::path. It must not outlive that: take it as a parameter, do not keep it.
class PathView {
 public:
  template <class Text>
  requires std::convertible_to<const Text&, std::string_view> PathView(const Text& name)
      : text_(name) {}
  template <class Path>
  requires requires(const Path& path) {
    { path.native() } -> std::same_as<const std::string&>;
  }
  PathView(const Path& path) : text_(path.native()) {}
#if defined(_WIN32)
  // Paths are UTF-16 there. Text is in the process's code page, as all that <filesystem> gets.
  template <class Path>
  requires requires(const Path& path) {
    { path.native() } -> std::same_as<const std::wstring&>;
  }
  PathView(const Path& path) : narrow_(path.string()) {}

  [[nodiscard]] std::string_view text() const {
    return narrow_.empty() ? text_ : narrow_;
  }

 private:
  std::string narrow_;
  std::string_view text_;
#else

  /// The name as it was given; a zero byte need not follow it.
  [[nodiscard]] std::string_view text() const {
    return text_;
  }

 private:
  std::string_view text_;
#endif
};

}  // namespace rastrum
