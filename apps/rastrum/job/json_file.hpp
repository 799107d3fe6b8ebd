// SPDX-License-Identifier: BSD-3-Clause
// Reads JSON files that people write: errors name the file and the place, and unknown names are
// errors. Writes files whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <rastrum/io.hpp>

namespace rastrum::cli {

/// Throws Error{not_found, io, bad_format} naming the file.
[[nodiscard]] nlohmann::ordered_json read_json(const std::filesystem::path& file);

/// The members of one object, read by name. Each throws Error{bad_format} naming the place for a
/// wrong type.
class JsonFields {
 public:
  /// `place`: the file and the way to `object`, for messages. `object` must outlive this.
  JsonFields(const nlohmann::ordered_json& object, std::string place);

  [[nodiscard]] bool has(const char* name);
  [[nodiscard]] std::optional<double> number(const char* name);  ///< finite
  [[nodiscard]] std::optional<std::vector<double>> numbers(const char* name, std::size_t count);
  [[nodiscard]] std::optional<std::string> text(const char* name);
  [[nodiscard]] std::optional<bool> boolean(const char* name);
  /// The member itself, or null.
  [[nodiscard]] const nlohmann::ordered_json* value(const char* name);
  /// The elements of an array, each with its place; none if the member is absent.
  struct Element {
    const nlohmann::ordered_json* value;
    std::string place;
  };
  [[nodiscard]] std::vector<Element> array(const char* name);

  /// Throws Error{bad_format} for a member that was not read; lists those that were.
  void finish() const;
  [[noreturn]] void fail(const std::string& problem) const;
  [[noreturn]] void fail(std::string_view name, const std::string& problem) const;

 private:
  const nlohmann::ordered_json& object_;
  std::string place_;
  std::vector<std::string> known_;
};

/// Both throw Error{io} naming the file; the first leaves the commit to the caller.
void write_json(io::AtomicFile& file, const nlohmann::ordered_json& value);
void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& value);

}  // namespace rastrum::cli
