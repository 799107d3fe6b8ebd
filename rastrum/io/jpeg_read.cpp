// SPDX-License-Identifier: BSD-3-Clause
// JPEG through libjpeg-turbo, to RGBA8 with alpha 255. The function that calls the library holds no
// object with a destructor, because the library leaves by longjmp. A file that ends too early is an
// error (the library would fill it with grey).
#include <cstddef>
#include <cstdio>
// jpeglib.h needs what <cstdio> declares before it.
#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <csetjmp>
#include <limits>
#include <string>

#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>

namespace rastrum::io {
namespace {

/// A progressive file may repeat scans without end; real ones have about ten.
constexpr int kMostScans = 500;

struct State {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX] = "";
  bool unsupported = false;

  ~State() { jpeg_destroy_decompress(&jpeg); }
};

State* state_of(j_common_ptr info) {
  return static_cast<State*>(info->client_data);
}

void on_error(j_common_ptr info) {
  State* state = state_of(info);
  info->err->format_message(info, state->message);
  std::longjmp(state->jump, 1);
}

void on_message(j_common_ptr info, int level) {
  if (level >= 0) return;  // traces
  ++info->err->num_warnings;
  if (info->err->msg_code == JWRN_JPEG_EOF || info->err->msg_code == JWRN_HIT_MARKER)
    on_error(info);
}

void on_progress(j_common_ptr info) {
  if (info->is_decompressor &&
      reinterpret_cast<j_decompress_ptr>(info)->input_scan_number > kMostScans) {
    State* state = state_of(info);
    std::snprintf(state->message, sizeof state->message, "it has more than %d scans", kMostScans);
    std::longjmp(state->jump, 1);
  }
}

bool read_header(State* state, Bytes bytes) {
  if (setjmp(state->jump) != 0) return false;
  state->jpeg.err = jpeg_std_error(&state->errors);
  state->errors.error_exit = on_error;
  state->errors.emit_message = on_message;
  state->jpeg.client_data = state;
  jpeg_create_decompress(&state->jpeg);
  state->jpeg.client_data = state;
  state->progress.progress_monitor = on_progress;
  state->jpeg.progress = &state->progress;
  // Windows' long has 32 bits.
  const auto size = static_cast<unsigned long>(
      std::min<std::size_t>(bytes.size(), std::numeric_limits<unsigned long>::max()));
  jpeg_mem_src(&state->jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), size);
  jpeg_read_header(&state->jpeg, TRUE);
  if (state->jpeg.jpeg_color_space == JCS_CMYK || state->jpeg.jpeg_color_space == JCS_YCCK) {
    state->unsupported = true;
    return false;
  }
  state->jpeg.out_color_space = JCS_EXT_RGBA;
  return true;
}

bool read_rows(State* state, ImageView<Rgba8> image) {
  if (setjmp(state->jump) != 0) return false;
  jpeg_start_decompress(&state->jpeg);
  while (state->jpeg.output_scanline < state->jpeg.output_height) {
    JSAMPROW row =
        reinterpret_cast<JSAMPROW>(image.row(static_cast<int>(state->jpeg.output_scanline)));
    jpeg_read_scanlines(&state->jpeg, &row, 1);
  }
  jpeg_finish_decompress(&state->jpeg);
  return true;
}

}  // namespace

Image<Rgba8> decode_jpeg(Bytes bytes, const std::string& name, Budget& budget) {
  State state;
  const auto fail = [&](const std::string& what) {
    throw Error(Errc::bad_format, name + ": is not a valid JPEG: " + what);
  };
  if (!read_header(&state, bytes)) {
    if (state.unsupported)
      throw Error(Errc::unsupported, name + ": is a CMYK JPEG; convert it to RGB");
    fail(state.message);
  }
  const std::size_t w = state.jpeg.image_width, h = state.jpeg.image_height;
  if (w > kMaxImageSize || h > kMaxImageSize)
    throw Error(Errc::unsupported, name + ": its size " + std::to_string(w) + "x" +
                                       std::to_string(h) + " is beyond 32768x32768");
  // Every 8 × 8 block costs at least a bit, so a small file cannot ask for a huge image.
  if (w * h / 512 > bytes.size()) fail("it is too short for its size");
  Image<Rgba8> image = budget.image<Rgba8>(static_cast<int>(w), static_cast<int>(h));
  if (!read_rows(&state, image.view())) fail(state.message);
  return image;
}

}  // namespace rastrum::io
