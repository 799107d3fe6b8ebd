// Options of a benchmark, by CLI11, which spells help and errors as the program does elsewhere.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace rastrum::bench {

/// What makes and runs CLI11's parser lies in the source: in each benchmark it would be compiled
/// again, for longer than the benchmark itself.
class OptionParser {
 public:
  OptionParser(const std::string& name, const std::string& description);
  ~OptionParser();
  OptionParser(const OptionParser&) = delete;
  OptionParser& operator=(const OptionParser&) = delete;

  [[nodiscard]] CLI::App& app() { return app_; }

  /// The exit status where there is nothing to run: 0 after `--help`, 2 after a usage error.
  [[nodiscard]] std::optional<int> parse(std::span<const std::string_view> options);

 private:
  CLI::App app_;
};

}  // namespace rastrum::bench
