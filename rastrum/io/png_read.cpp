// PNG through libpng, to straight RGBA8: palettes, grey, tRNS and 16 bit expanded or scaled,
// interlaced or not. Strict: a damaged chunk is an error, not a warning. libpng leaves by longjmp;
// so the two functions that call it hold no object with a destructor, and what it needs is in a
// state that outlives them.
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>

namespace rastrum::io {
namespace {

struct State {
  png_structp png = nullptr;
  png_infop info = nullptr;
  const std::byte* at = nullptr;
  std::size_t left = 0;
  char message[200] = "";
  png_uint_32 width = 0, height = 0;
  std::size_t raw_bytes = 0;  ///< filtered rows as compressed in the file
  std::jmp_buf jump;

  ~State() { png_destroy_read_struct(&png, &info, nullptr); }
};

void on_error(png_structp png, png_const_charp message) {
  auto* state = static_cast<State*>(png_get_error_ptr(png));
  std::snprintf(state->message, sizeof state->message, "%s", message);
  std::longjmp(state->jump, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep to, png_size_t n) {
  auto* state = static_cast<State*>(png_get_io_ptr(png));
  if (n > state->left) png_error(png, "the file ends too early");
  std::memcpy(to, state->at, n);
  state->at += n;
  state->left -= n;
}

bool read_header(State* state) {
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

bool read_rows(State* state, png_bytepp rows) {
  if (setjmp(state->jump) != 0) return false;
  png_structp png = state->png;
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xFF, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, state->info);
  if (png_get_rowbytes(png, state->info) != std::size_t{4} * state->width)
    png_error(png, "its pixels do not become RGBA");
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

}  // namespace

Image<Rgba8> decode_png(Bytes bytes, const std::string& name) {
  // Apple's own variant: no zlib header, BGRA, premultiplied.
  if (bytes.size() >= 16 && as_text(bytes).substr(12, 4) == "CgBI")
    throw Error(Errc::unsupported,
                name +
                    ": is an iPhone PNG (CgBI), which only Apple's tools read; convert it with "
                    "`pngcrush -revert-iphone-optimizations`");
  State state;
  state.at = bytes.data();
  state.left = bytes.size();
  const auto fail = [&](const char* what) {
    throw Error(Errc::bad_format, name + ": is not a sound PNG: " + what);
  };
  if (!read_header(&state)) fail(state.message);
  // Deflate makes at most 1,032 bytes of one: a small file cannot ask for a huge image.
  if (state.raw_bytes / 1032 > bytes.size()) fail("it is too short for its size");
  Image<Rgba8> image(static_cast<int>(state.width), static_cast<int>(state.height));
  std::vector<png_bytep> rows(state.height);
  for (std::size_t y = 0; y < rows.size(); ++y)
    rows[y] = reinterpret_cast<png_bytep>(&image(0, static_cast<int>(y)));
  if (!read_rows(&state, rows.data())) fail(state.message);
  return image;
}

}  // namespace rastrum::io
