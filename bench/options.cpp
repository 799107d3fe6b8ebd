// SPDX-License-Identifier: BSD-3-Clause
#include "options.hpp"

#include <cstdio>

namespace rastrum::bench {

std::optional<int> OptionParser::parse(std::span<const std::string_view> options) {
  try {
    if (Parser::parse(options)) return std::nullopt;
    return 0;
  } catch (const cli::UsageError& e) {
    std::fprintf(stderr, "rastrum bench: error: %s\nRun it with --help for more information.\n",
                 e.what());
    return 2;
  }
}

}  // namespace rastrum::bench
