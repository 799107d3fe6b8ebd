// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <optional>
#include <string_view>
#include <variant>

#include <rastrum/digest.hpp>
#include <rastrum/image.hpp>
#include <rastrum/io.hpp>
#include <rastrum/vec.hpp>

#include "parse/output.hpp"

namespace rastrum::cli {

/// The files of one picture or one run. commit() makes all visible at once.
class OutputFiles {
 public:
  /// Requires that `output` is asked for. Throws Error{io}.
  [[nodiscard]] io::AtomicFile& begin(const Output& output);
  void commit();

 private:
  std::list<io::AtomicFile> files_;
};

using ImageOfFile =
    std::variant<ImageView<const Rgba8>, ImageView<const Vec4>, ImageView<const Vec3>,
                 ImageView<const Vec2>, ImageView<const float>, ImageView<const std::int64_t>,
                 ImageView<const std::int32_t>>;
/// Requires that `format` has such pixels.
void write_image(io::AtomicFile& file, Format format, const ImageOfFile& image, int threads = 1);

/// `--hash`: prints a line with the digest, what it is of, and the picture's number if there are
/// many.
void print_hash(const Digest& digest, std::string_view what, std::optional<std::size_t> number);

}  // namespace rastrum::cli
