// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/golden.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <rastrum/io.hpp>

#include "tests/support/directories.hpp"
#include "tests/support/pixels.hpp"

namespace rastrum::test {
namespace {

namespace fs = std::filesystem;

// Black where the pictures agree; even a difference of 1 is clearly visible.
Image<Rgba8> difference(const Image<Rgba8>& a, const Image<Rgba8>& b) {
  const auto amplify = [](int x, int y) {
    const int d = std::abs(x - y);
    return static_cast<std::uint8_t>(d == 0 ? 0 : std::min(255, 64 + 4 * d));
  };
  Image<Rgba8> out(a.width(), a.height());
  for (const auto& [x, y] : pixels(a.width(), a.height())) {
    const Rgba8 p = a(x, y), q = b(x, y);
    const std::uint8_t alpha = amplify(p.a, q.a);
    out(x, y) = {std::max(amplify(p.r, q.r), alpha), std::max(amplify(p.g, q.g), alpha),
                 std::max(amplify(p.b, q.b), alpha), 255};
  }
  return out;
}

}  // namespace

testing::AssertionResult matches_golden(const std::string& name, const Image<Rgba8>& actual) {
  const fs::path golden = golden_dir() / (name + ".png");
  const fs::path failures = golden_failures_dir();
  const auto failed = [&](const char* kind) { return failures / (name + "." + kind + ".png"); };
  for (const char* kind : {"expected", "actual", "diff"}) {
    std::error_code absent;
    fs::remove(failed(kind), absent);
  }
  const auto fail = [&](const std::string& why) {
    return testing::AssertionFailure()
           << why << "; see " << failed("actual") << " (./dev golden shows and accepts)";
  };
  fs::create_directories(failures);
  if (!fs::exists(golden)) {
    io::write_png(failed("actual"), actual.view());
    return fail("there is no golden picture " + golden.string());
  }
  const Image<Rgba8> expected = io::read_image(golden);
  if (expected.width() == actual.width() && expected.height() == actual.height() &&
      std::ranges::equal(expected.pixels(), actual.pixels()))
    return testing::AssertionSuccess();
  io::write_png(failed("expected"), expected.view());
  io::write_png(failed("actual"), actual.view());
  if (expected.width() != actual.width() || expected.height() != actual.height())
    return fail(name + " is not of the golden picture's size");
  const Image<Rgba8> diff = difference(expected, actual);
  io::write_png(failed("diff"), diff.view());
  const auto differing = std::ranges::count_if(
      diff.pixels(), [](Rgba8 p) { return p.r != 0 || p.g != 0 || p.b != 0; });
  return fail(name + ": " + std::to_string(differing) + " pixels differ from the golden picture");
}

testing::AssertionResult matches_golden(const std::string& name, const Digest& actual) {
  const fs::path failure = golden_failures_dir() / (name + ".actual.sha256");
  std::error_code absent;
  fs::remove(failure, absent);
  std::ifstream golden(golden_dir() / "hashes.txt");
  std::string expected, of;
  while (golden >> expected >> of && of != name) {
  }
  if (of == name && expected == actual.hex()) return testing::AssertionSuccess();
  fs::create_directories(failure.parent_path());
  std::ofstream(failure) << actual.hex() << "\n";
  return testing::AssertionFailure()
         << name << " is " << actual.hex() << ", and hashes.txt has "
         << (of == name ? expected : "none of that name") << " (./dev golden shows and accepts)";
}

}  // namespace rastrum::test
