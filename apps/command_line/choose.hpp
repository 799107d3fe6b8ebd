// SPDX-License-Identifier: BSD-3-Clause
// Options whose value is one of a few words.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "parser.hpp"

namespace rastrum::cli {

template <class T>
using Choices = std::vector<std::pair<const char*, T>>;

template <class T>
const char* word_of(const Choices<T>& choices, std::type_identity_t<T> value) {
  return std::ranges::find(choices, value, &std::pair<const char*, T>::second)->first;
}

/// Throws UsageError that lists the words.
template <class T>
T choose(std::string_view option, const std::string& text, const Choices<T>& choices) {
  std::string known;
  for (const auto& [word, value] : choices) {
    if (text == word) return value;
    known.append(known.empty() ? "" : ", ").append(word);
  }
  throw UsageError(option, "expected one of " + known + ", got '" + text + "'");
}

/// `name` has static storage.
template <class T>
Option add_choice(Parser& app, const char* name, const char* type, const std::string& help,
                  T& value, std::type_identity_t<Choices<T>> choices) {
  return app.add(name, type, help,
                 [name, &value, choices = std::move(choices)](const std::string& text) {
                   value = choose<T>(name, text, choices);
                 });
}

}  // namespace rastrum::cli
