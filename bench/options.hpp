// Options of a benchmark, by CLI11, which spells help and errors as the program does elsewhere.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rastrum::bench {

class OptionParser {
 public:
  OptionParser(const std::string& name, const std::string& description)
      : app_(description, "rastrum bench " + name) {}

  [[nodiscard]] CLI::App& app() { return app_; }

  /// The exit status where there is nothing to run: 0 after `--help`, 2 after a usage error.
  [[nodiscard]] std::optional<int> parse(std::span<const std::string_view> options) {
    // CLI11 takes the arguments as a stack.
    std::vector<std::string> reversed(options.rbegin(), options.rend());
    try {
      app_.parse(std::move(reversed));
    } catch (const CLI::ParseError& e) {
      return app_.exit(e) == 0 ? 0 : 2;
    }
    return std::nullopt;
  }

 private:
  CLI::App app_;
};

}  // namespace rastrum::bench
