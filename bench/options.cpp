#include "options.hpp"

#include <utility>
#include <vector>

namespace rastrum::bench {

OptionParser::OptionParser(const std::string& name, const std::string& description)
    : app_(description, "rastrum bench " + name) {}

OptionParser::~OptionParser() = default;

std::optional<int> OptionParser::parse(std::span<const std::string_view> options) {
  // CLI11 takes the arguments as a stack.
  std::vector<std::string> reversed(options.rbegin(), options.rend());
  try {
    app_.parse(std::move(reversed));
  } catch (const CLI::ParseError& e) {
    return app_.exit(e) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

}  // namespace rastrum::bench
