// SPDX-License-Identifier: BSD-3-Clause
// An MP4 from ffmpeg, which gets the pictures through a pipe.
#pragma once

#include <memory>

#include <rastrum/image.hpp>
#include <rastrum/io.hpp>

namespace rastrum::cli {

/// Whole or absent: ffmpeg writes into a file that the caller has begun and commits after finish().
class Mp4Writer {
 public:
  /// H.264, 4:2:0, so width and height must be even. Throws Error{not_found} if PATH has no ffmpeg,
  /// Error{invalid_argument} for an odd size, Error{io} if `file` cannot be written. `file` must
  /// outlive this.
  Mp4Writer(io::AtomicFile& file, int width, int height, double fps);
  /// Ends ffmpeg unless finish() was called.
  ~Mp4Writer();
  Mp4Writer(const Mp4Writer&) = delete;
  Mp4Writer& operator=(const Mp4Writer&) = delete;

  /// Transparent pixels are laid over black. Throws Error{io} with ffmpeg's words if it has ended.
  void add(ImageView<const Rgba8> picture);
  void finish();

  /// Throws as the constructor, before any work.
  static void check(int width, int height);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::cli
