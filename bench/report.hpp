// SPDX-License-Identifier: BSD-3-Clause
// The output of a benchmark: a table for people, JSON for programs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "measure.hpp"

namespace rastrum::bench {

/// A table that prints each row at once, so that a long run shows its progress. Numbers are
/// right-aligned.
class Table {
 public:
  struct Column {
    std::string title;
    int width = 8;  ///< characters; longer cells push the rest of the row
    bool left = false;
  };
  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  void print_head() const;
  void print_row(const std::vector<std::string>& cells) const;

 private:
  std::vector<Column> columns_;
};

/// The number of characters, not bytes: a text may hold ² or ×.
[[nodiscard]] std::size_t characters(std::string_view text);

/// `value` with `digits` significant digits, without an exponent: 0.123, 4.56, 123, 45678.
[[nodiscard]] std::string significant(double value, int digits = 3);
/// Times with their names: "setup 1.20, draw 3.40".
template <class Times>
[[nodiscard]] std::string times_text(const Times& times_ms) {
  std::string text;
  for (const auto& [name, ms] : times_ms)
    text.append(text.empty() ? "" : ", ").append(name).append(" ").append(significant(ms));
  return text;
}
/// Millions of bytes, with three digits.
[[nodiscard]] std::string megabytes(std::uint64_t bytes);

/// `value` with the fewest digits that give it back, as a paper prints it: 1.02, 0.5, 16.
[[nodiscard]] std::string shortest(double value);

/// {"median_ms", "spread", "samples_ms", "cpu_median_ms"}.
[[nodiscard]] nlohmann::json to_json(const Timing& timing);

/// {"cpu", "cores", "memory_gib", "load", "compiler", "commit", "version", "date"}: the
/// circumstances of a figure.
[[nodiscard]] nlohmann::json machine_json();
/// The same as text, with a warning if the machine is busy.
[[nodiscard]] std::string machine_text();

/// Writes `document` to a temporary file beside `file` and renames it. Throws Error{io}.
void write_json(const std::string& file, const nlohmann::json& document);

}  // namespace rastrum::bench
