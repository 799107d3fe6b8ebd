// SPDX-License-Identifier: BSD-3-Clause
// Writes files and reads them at once.
#pragma once

#include <string>
#include <string_view>

#include <rastrum/io.hpp>

#include "tests/io/files.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test {

/// The scene of a file with this name and these bytes, alone in its folder.
[[nodiscard]] inline Scene read_file(const std::string& name, std::string_view bytes,
                                     const io::ReadOptions& options = {}) {
  const TempFolder folder;
  return io::read_scene(folder.write(name, bytes), options);
}

/// Expects an error with `part` in its message.
inline void expect_bad_file(const std::string& part, const std::string& name,
                            std::string_view bytes, Errc code = Errc::bad_format) {
  expect_refused(part, code, [&] { (void)read_file(name, bytes); });
}

/// Expects one warning, which contains `part`.
inline void expect_warning(std::string_view part, const Scene& scene) {
  ASSERT_EQ(scene.warnings.size(), 1U) << io::describe(scene);
  EXPECT_TRUE(holds(scene.warnings[0], part));
}

/// A picture of this pixel.
inline void write_pixel(const std::filesystem::path& file, Rgba8 color) {
  Image<Rgba8> image(1, 1);
  image(0, 0) = color;
  io::write_png(file, image);
}

/// The text with one occurrence of `from` replaced, which must exist.
[[nodiscard]] inline std::string changed(std::string text, std::string_view from,
                                         std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace rastrum::test
