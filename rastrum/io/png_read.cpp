// SPDX-License-Identifier: BSD-3-Clause
// PNG through libpng, to straight RGBA8 (palettes, grey, tRNS, 16 bits, interlaced or not) or to
// heights, which keep 16 bits. A damaged chunk is an error, not a warning. libpng leaves by
// longjmp, so the two functions that call it hold no object with a destructor; their state outlives
// them.
#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>
#include <rastrum/io/stored_png.hpp>

namespace rastrum::io {
namespace {

struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::span<const Bytes> parts;  ///< still unread
  std::size_t done = 0;          ///< of the first
  bool is_checked = false;       ///< sums of the picture's data are right
  char message[200] = "";
  png_uint_32 width = 0, height = 0;
  std::size_t raw_bytes = 0;  ///< filtered rows as compressed in the file
  std::jmp_buf jump;

  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void on_error(png_structp png, png_const_charp message) {
  auto* state = static_cast<PngReader*>(png_get_error_ptr(png));
  std::snprintf(state->message, sizeof state->message, "%s", message);
  std::longjmp(state->jump, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep to, png_size_t n) {
  auto* state = static_cast<PngReader*>(png_get_io_ptr(png));
  while (n > 0) {
    if (state->parts.empty()) png_error(png, "the file ends too early");
    const Bytes part = state->parts.front().subspan(state->done);
    const std::size_t some = std::min(n, part.size());
    if (some != 0) std::memcpy(to, part.data(), some);
    to += some;
    n -= some;
    state->done += some;
    if (some == part.size()) {
      state->parts = state->parts.subspan(1);
      state->done = 0;
    }
  }
}

bool read_header(PngReader* state) {
  if (setjmp(state->jump) != 0) return false;
  state->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, state, on_error, on_warning);
  if (state->png == nullptr) return false;
  state->info = png_create_info_struct(state->png);
  if (state->info == nullptr) return false;
  png_structp png = state->png;
  png_set_read_fn(png, state, on_read);
  png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_set_user_limits(png, kMaxImageSize, kMaxImageSize);
  png_set_chunk_malloc_max(png, png_alloc_size_t{8} << 20);
  png_set_chunk_cache_max(png, 100);
  png_read_info(png, state->info);
  state->width = png_get_image_width(png, state->info);
  state->height = png_get_image_height(png, state->info);
  state->raw_bytes = (png_get_rowbytes(png, state->info) + 1) * state->height;
  return true;
}

/// Rows of RGBA, `channel_bytes` (1 or 2, in this machine's order) per channel.
bool read_rows(PngReader* state, png_bytepp rows, std::size_t channel_bytes) {
  if (setjmp(state->jump) != 0) return false;
  png_structp png = state->png;
  if (channel_bytes == 1) {
    png_set_expand(png);
    png_set_scale_16(png);
  } else {
    png_set_expand_16(png);
    if (std::endian::native == std::endian::little) png_set_swap(png);
  }
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, channel_bytes == 1 ? 0xFF : 0xFFFF, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  // Faster code has checked, or made, the sums of the picture's chunk.
  if (state->is_checked) {
    png_set_crc_action(png, PNG_CRC_QUIET_USE, PNG_CRC_ERROR_QUIT);
    png_set_option(png, PNG_IGNORE_ADLER32, PNG_OPTION_ON);
  }
  png_read_update_info(png, state->info);
  if (png_get_rowbytes(png, state->info) != channel_bytes * 4 * state->width)
    png_error(png, "its pixels do not become RGBA");
  png_read_image(png, rows);
  png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_read_end(png, nullptr);
  return true;
}

[[noreturn]] void fail(const std::string& name, const char* what) {
  throw Error(Errc::bad_format, name + ": is not a valid PNG: " + what);
}

/// Reads the header of a PNG whose size its bytes can fill. `stored`: made from `bytes`.
void open(PngReader& state, Bytes bytes, const StoredPng& stored, const std::string& name) {
  // Apple's own variant: no zlib header, BGRA, premultiplied.
  if (bytes.size() >= 16 && as_text(bytes).substr(12, 4) == "CgBI")
    throw Error(Errc::unsupported,
                name +
                    ": is an iPhone PNG (CgBI), which only Apple's tools read; convert it with "
                    "`pngcrush -revert-iphone-optimizations`");
  state.parts = stored.parts();
  state.is_checked = stored.is_checked();
  if (!read_header(&state)) fail(name, state.message);
  // Deflate makes at most 1,032 bytes of one, so small files cannot ask for huge images.
  if (state.raw_bytes / 1032 > bytes.size()) fail(name, "it is too short for its size");
}

template <class Pixel>
Image<Pixel> read_pixels(PngReader& state, const std::string& name, Budget& budget) {
  auto image = budget.image<Pixel>(static_cast<int>(state.width), static_cast<int>(state.height));
  std::vector<png_bytep> rows(state.height);
  for (std::size_t y = 0; y < rows.size(); ++y)
    rows[y] = reinterpret_cast<png_bytep>(&image(0, static_cast<int>(y)));
  if (!read_rows(&state, rows.data(), sizeof(Pixel) / 4)) fail(name, state.message);
  return image;
}

}  // namespace

Image<Rgba8> decode_png(Bytes bytes, const std::string& name, Budget& budget) {
  const StoredPng stored(bytes);
  PngReader state;
  open(state, bytes, stored, name);
  return read_pixels<Rgba8>(state, name, budget);
}

HeightGrid decode_height_png(Bytes bytes, const std::string& name, const ReadOptions& options) {
  const FloatScope floats;
  struct Rgba16 {
    std::uint16_t r = 0, g = 0, b = 0, a = 0;
  };
  const StoredPng stored(bytes);
  PngReader state;
  open(state, bytes, stored, name);
  const bool wide = png_get_bit_depth(state.png, state.info) == 16;
  Budget budget(name, bytes.size(), options);
  const Image<Rgba16> pixels = read_pixels<Rgba16>(state, name, budget);
  HeightGrid grid{budget.image<float>(pixels.width(), pixels.height()), wide ? 257.0 : 1.0, !wide};
  for (int y = 0; y < pixels.height(); ++y)
    for (int x = 0; x < pixels.width(); ++x) {
      const Rgba16 p = pixels(x, y);
      if (p.a != 0 && (p.r != p.g || p.r != p.b))
        throw Error(Errc::unsupported, name + ": its pixel (" + std::to_string(x) + ", " +
                                           std::to_string(y) +
                                           ") has a colour, but heights are grey");
      // libpng makes 16 bits from 8 by a factor of 257. A transparent pixel is a hole.
      grid.heights(x, y) = p.a == 0 ? std::numeric_limits<float>::quiet_NaN()
                                    : static_cast<float>(wide ? p.r : p.r / 257);
    }
  return grid;
}

}  // namespace rastrum::io
