// SPDX-License-Identifier: BSD-3-Clause
// Options of a benchmark, parsed like all options of the program.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <apps/command_line/parser.hpp>

namespace rastrum::bench {

class OptionParser : public cli::Parser {
 public:
  OptionParser(const std::string& name, const std::string& description)
      : Parser("rastrum bench " + name, description) {}

  /// Returns the exit status if there is nothing to run: 0 after `--help`, 2 after a usage error.
  [[nodiscard]] std::optional<int> parse(std::span<const std::string_view> options);
};

}  // namespace rastrum::bench
