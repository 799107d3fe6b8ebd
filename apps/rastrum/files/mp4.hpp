// SPDX-License-Identifier: BSD-3-Clause
// An MP4 made by ffmpeg, which gets the pictures through a pipe.
#pragma once

#include <memory>

#include <rastrum/image.hpp>
#include <rastrum/io.hpp>

namespace rastrum::cli {

/// Whole or absent, as the other outputs: ffmpeg writes into a file that the caller has begun, and
/// commits after finish().
class Mp4Writer {
 public:
  /// H.264, 4:2:0, so width and height must be even. Throws Error{not_found} where no ffmpeg is in
  /// PATH, Error{invalid_argument} for an odd size, Error{io} where `file` cannot be written.
  /// `file` must outlive this.
  Mp4Writer(io::AtomicFile& file, int width, int height, double fps);
  /// Without finish(): ends ffmpeg.
  ~Mp4Writer();
  Mp4Writer(const Mp4Writer&) = delete;
  Mp4Writer& operator=(const Mp4Writer&) = delete;

  /// A picture of the size given; what is transparent is laid over black. Throws Error{io} with
  /// what ffmpeg said where it ended.
  void add(ImageView<const Rgba8> picture);
  void finish();

  /// Throws as the constructor does, before any work is done.
  static void check(int width, int height);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rastrum::cli
