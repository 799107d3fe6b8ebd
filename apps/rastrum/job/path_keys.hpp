// SPDX-License-Identifier: BSD-3-Clause
// Keys in time of all camera paths (docs/window.md). A key takes what it leaves out from the one
// before.
#pragma once

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <rastrum/error.hpp>

#include "json_file.hpp"
#include "key_curve.hpp"

namespace rastrum::cli {

/// Smooth if absent.
[[nodiscard]] Interpolation read_interpolation(JsonFields& fields);

/// 0 if the first key leaves it out. `before_s`: the key before.
[[nodiscard]] double read_key_time(JsonFields& fields, std::optional<double> before_s);

/// Returns f(); adds the file's name to its Error.
template <class F>
auto of_path(const std::filesystem::path& file, const F& f) {
  try {
    return f();
  } catch (const Error& e) {
    throw Error(e.code(), file.string() + ": " + e.what());
  }
}

/// `base`: for values that the first key leaves out. `read_key(element, before, first)` returns a
/// Key. Throws Error{not_found, io, bad_format} naming the file and the key.
template <class Key, class ReadKey>
[[nodiscard]] std::pair<std::vector<Key>, Interpolation> read_path_keys(
    const std::filesystem::path& file, const Key& base, const ReadKey& read_key) {
  const nlohmann::ordered_json json = read_json(file);
  JsonFields fields(json, file.string());
  const Interpolation interpolation = read_interpolation(fields);
  const std::vector<JsonFields::Element> elements = fields.array("keys");
  static_cast<void>(fields.has("events"));  // of a script, which a window replays
  static_cast<void>(fields.has("fps"));
  fields.finish();
  if (elements.empty()) fields.fail("keys", "a path needs at least one key");
  std::vector<Key> keys;
  Key before = base;
  for (const JsonFields::Element& element : elements)
    before = keys.emplace_back(read_key(element, before, keys.empty()));
  return {std::move(keys), interpolation};
}

}  // namespace rastrum::cli
