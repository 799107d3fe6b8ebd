// SPDX-License-Identifier: BSD-3-Clause
// Picture files whose rows come in bands, from the top. Writers of whole pictures use one band.
#pragma once

#include <memory>

#include <rastrum/core/view_rows.hpp>
#include <rastrum/io.hpp>

namespace rastrum::io {

template <class Pixel>
class RowsOf {
 public:
  RowsOf() = default;
  RowsOf(const RowsOf&) = delete;
  RowsOf& operator=(const RowsOf&) = delete;
  virtual ~RowsOf() = default;
  /// The next rows: of the picture's width, no more than are missing, not overlapping.
  virtual void add(ImageView<const Pixel> rows) = 0;
  /// All rows have come.
  virtual void finish() {}
};

/// These write all that precedes the first row when they are made.
[[nodiscard]] std::unique_ptr<RowsOf<Rgba8>> png_rows(AtomicFile& out, int width, int height,
                                                      int threads);
/// For Vec4, Vec3 and float.
template <class Pixel>
[[nodiscard]] std::unique_ptr<RowsOf<Pixel>> exr_rows(AtomicFile& out, int width, int height);
/// For these, Vec2, int64 and int32.
template <class Pixel>
[[nodiscard]] std::unique_ptr<RowsOf<Pixel>> npy_rows(AtomicFile& out, int width, int height);

/// Throws Error{invalid_argument} for an image that no file can hold.
template <class Pixel>
void check_picture(const AtomicFile& out, ImageView<const Pixel> image) {
  if (image.empty() || image.width < 1 || image.height < 1)
    throw Error(Errc::invalid_argument, out.name() + ": an empty image cannot be written");
  check_stride(image, out.name());
}

/// A whole picture: `make` as png_rows.
template <class Pixel, class Make>
void write_whole(AtomicFile& out, ImageView<const Pixel> image, const Make& make) {
  check_picture(out, image);
  const std::unique_ptr<RowsOf<Pixel>> rows = make(out, image.width, image.height);
  rows->add(image);
  rows->finish();
}

}  // namespace rastrum::io
