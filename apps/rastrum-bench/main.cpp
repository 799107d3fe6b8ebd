// SPDX-License-Identifier: BSD-3-Clause
// The program `rastrum-bench`, which `rastrum bench` starts.
#include <cstdio>
#include <exception>
#include <string_view>
#include <vector>

#include <bench/bench.hpp>

int main(int argc, char** argv) {
  try {
    const std::vector<std::string_view> arguments(argv + 1, argv + argc);
    return rastrum::bench::run(arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "rastrum bench: error: %s\n", e.what());
    return 1;
  }
}
