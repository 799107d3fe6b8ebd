// PNG through libpng: 8-bit RGBA, straight alpha.
#include <png.h>

#include <csetjmp>
#include <cstdio>

#include <rastrum/io.hpp>

namespace rastrum::io {
namespace {

/// Measured on a rendered and a photographic picture of 1920 × 1080: level 1 with the filter UP is
/// the fastest that still filters; level 3 takes 1.5 to 2 times as long for files 6 to 10 %
/// smaller, level 6 4 to 6 times for 15 to 35 %, choosing between SUB and UP in each row 1.2 to 1.4
/// times for about 0. No filter is 4 times faster on flat pictures, but files of photographs grow
/// by half.
constexpr int kLevel = 1;

struct PngWriter {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::FILE* stream = nullptr;
  char message[200] = "";
  std::jmp_buf jump;

  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

void on_write_error(png_structp png, png_const_charp message) {
  auto* state = static_cast<PngWriter*>(png_get_error_ptr(png));
  std::snprintf(state->message, sizeof state->message, "%s", message);
  std::longjmp(state->jump, 1);
}

void on_write_warning(png_structp, png_const_charp) {}

/// Holds no object with a destructor: libpng leaves by longjmp.
bool write_rows(PngWriter* state, ImageView<const Rgba8> image) {
  if (setjmp(state->jump) != 0) return false;
  state->png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, state, on_write_error, on_write_warning);
  if (state->png == nullptr) return false;
  state->info = png_create_info_struct(state->png);
  if (state->info == nullptr) return false;
  png_structp png = state->png;
  png_init_io(png, state->stream);
  png_set_compression_level(png, kLevel);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
  png_set_IHDR(png, state->info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB_ALPHA,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, state->info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, state->info);
  for (int y = 0; y < image.height; ++y)
    png_write_row(png, reinterpret_cast<png_const_bytep>(image.row(y)));
  png_write_end(png, state->info);
  return true;
}

}  // namespace

void write_png(AtomicFile& out, ImageView<const Rgba8> image) {
  if (image.empty() || image.width < 1 || image.height < 1)
    throw Error(Errc::invalid_argument, out.name().string() + ": an empty image cannot be written");
  check_stride(image, out.name().string());
  PngWriter state;
  state.stream = out.stream();
  if (!write_rows(&state, image)) out.fail(state.message);
}

}  // namespace rastrum::io
