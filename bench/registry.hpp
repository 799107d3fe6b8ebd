// The benchmarks by name: a static table, one row a benchmark.
#pragma once

#include <span>
#include <string_view>

namespace rastrum::bench {

struct Benchmark {
  std::string_view name, description;
  /// Parses its own options; returns an exit status.
  int (*run)(std::span<const std::string_view> options);
};

[[nodiscard]] std::span<const Benchmark> benchmarks();

// The rows' functions, each in the file of its name.
int run_machine(std::span<const std::string_view> options);
int run_peers(std::span<const std::string_view> options);
int run_peers_check(std::span<const std::string_view> options);
int run_words(std::span<const std::string_view> options);

}  // namespace rastrum::bench
