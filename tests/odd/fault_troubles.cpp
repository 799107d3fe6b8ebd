// Faults, hostile input and files that are in the way.
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "tests/odd/trouble.hpp"

namespace rastrum::odd {
namespace {

std::string refusal_of(const std::string& text, const char* format) {
  try {
    (void)io::decode_scene(std::as_bytes(std::span(text)), format, "input");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

void long_lines_are_quoted_in_short() {
  constexpr std::size_t kLong = 10'000'000, kMost = 2100;
  const std::string word(kLong, 'w');
  for (const auto& [text, format] : {std::pair{"v " + word + " 0 0\n", "obj"},
                                     {"ply\nformat ascii 1.0\nelement " + word + "\n", "ply"},
                                     {"OFF\n" + word + " 1 1\n", "off"},
                                     {R"({"asset":{"version":")" + word + "\"}}", "gltf"},
                                     {"{" + word, "gltf"},
                                     {"solid x\nfacet " + word + "\n", "stl"}}) {
    const std::string message = refusal_of(text, format);
    EXPECT_EQ(message.find("input"), 0U) << format;
    EXPECT_LE(message.size(), kMost) << format;
  }
}

}  // namespace

std::vector<Trouble> fault_troubles() {
  return {
      {"Message_LinesOfTenMegabytes", "a word of ten megabytes where a number is expected",
       "a message that names the file and quotes the word's begin and end",
       long_lines_are_quoted_in_short},
  };
}

}  // namespace rastrum::odd
