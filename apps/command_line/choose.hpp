// One of a few words of a command line.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "parser.hpp"

namespace rastrum::cli {

/// The value of the word `text`. Throws UsageError that lists the words.
template <class T>
T choose(std::string_view option, const std::string& text,
         std::initializer_list<std::pair<const char*, T>> choices) {
  std::string known;
  for (const auto& [word, value] : choices) {
    if (text == word) return value;
    known.append(known.empty() ? "" : ", ").append(word);
  }
  throw UsageError(option, "expected one of " + known + ", got '" + text + "'");
}

}  // namespace rastrum::cli
