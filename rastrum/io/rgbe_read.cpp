// SPDX-License-Identifier: BSD-3-Clause
// Radiance pictures (.hdr, .pic): RGBE, three mantissas and an exponent per pixel, plain or in runs
// of either kind. Facts: Ward, "Real Pixels" (Graphics Gems II); Radiance's file formats.
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>

namespace rastrum::io {
namespace {

class Rgbe {
 public:
  Rgbe(Bytes bytes, const std::string& name, Budget& budget)
      : bytes_(bytes), name_(name), budget_(budget) {}

  Image<Vec3> read() {
    read_header();
    Image<Vec3> image = budget_.image<Vec3>(width_, height_);
    std::vector<Pixel> row(static_cast<std::size_t>(width_));
    for (int y = 0; y < height_; ++y) {
      row_ = y;
      if (is_in_runs())
        read_runs(row);
      else
        read_pixels(row);
      for (int x = 0; x < width_; ++x) image(x, y) = light(row[static_cast<std::size_t>(x)]);
    }
    return image;
  }

 private:
  using Pixel = std::array<std::uint8_t, 4>;

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Errc::bad_format, name_ + ": is not a valid Radiance picture: " + what);
  }
  [[noreturn]] void fail_row(const std::string& what) const {
    fail("row " + std::to_string(row_) + ": " + what);
  }
  std::uint8_t byte() {
    if (at_ >= bytes_.size()) fail_row("the file ends too early");
    return std::to_integer<std::uint8_t>(bytes_[at_++]);
  }
  std::string_view line() {
    const std::string_view rest = as_text(bytes_.subspan(at_));
    const std::size_t end = rest.substr(0, 4096).find('\n');
    if (end == std::string_view::npos) fail("its header does not end");
    at_ += end + 1;
    return rest.substr(0, end);
  }

  void read_header() {
    (void)line();  // "#?RADIANCE" or "#?RGBE", checked before
    for (std::string_view text = line(); !text.empty(); text = line()) {
      if (text.starts_with("FORMAT=") && text != "FORMAT=32-bit_rle_rgbe")
        throw Error(Errc::unsupported,
                    name_ + ": has " + std::string(text) + "; only 32-bit_rle_rgbe is read");
      if (text.starts_with("EXPOSURE=")) {
        const double given = number(text.substr(9));
        // Written so that a NaN fails.
        if (!(given > 1e-30 && given < 1e30))
          fail("its EXPOSURE is " + std::string(text.substr(9)));
        scale_ /= given;
      }
    }
    if (!(scale_ > 1e-30 && scale_ < 1e30)) fail("its exposures are beyond what light can be");
    read_size(line());
    // Two bytes make a run of at most 127 numbers of a channel; in the old form four bytes 255
    // pixels.
    if (static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) / 64 > bytes_.size())
      fail("it is too short for its size");
  }

  double number(std::string_view text) const {
    while (text.starts_with(' ')) text.remove_prefix(1);
    double value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    if (error != std::errc{} || end != last) fail("'" + std::string(text) + "' is no number");
    return value;
  }

  void read_size(std::string_view text) {
    const std::string all(text);
    constexpr std::string_view kY = "-Y ";
    const std::size_t x = text.find(" +X ");
    if (!text.starts_with(kY) || x == std::string_view::npos) {
      if (text.find('Y') != std::string_view::npos && text.find('X') != std::string_view::npos)
        throw Error(Errc::unsupported,
                    name_ + ": its rows lie as '" + all + "'; only -Y HEIGHT +X WIDTH is read");
      fail("its size is '" + all + "'");
    }
    const double h = number(text.substr(kY.size(), x - kY.size())), w = number(text.substr(x + 4));
    if (!(w >= 1 && h >= 1) || w != std::floor(w) || h != std::floor(h))
      fail("its size is '" + all + "'");
    if (w > kMaxImageSize || h > kMaxImageSize)
      throw Error(Errc::unsupported, name_ + ": its size '" + all + "' is beyond 32768x32768");
    width_ = static_cast<int>(w);
    height_ = static_cast<int>(h);
  }

  [[nodiscard]] bool is_in_runs() const {
    if (width_ < 8 || width_ > 0x7fff || bytes_.size() - at_ < 4) return false;
    const auto b = [&](std::size_t i) { return std::to_integer<int>(bytes_[at_ + i]); };
    return b(0) == 2 && b(1) == 2 && b(2) < 128;
  }

  /// Channel by channel.
  void read_runs(std::vector<Pixel>& row) {
    const std::size_t width =
        static_cast<std::size_t>(bytes_[at_ + 2]) << 8 | static_cast<std::size_t>(bytes_[at_ + 3]);
    if (width != row.size()) fail_row("it says that it has " + std::to_string(width) + " pixels");
    at_ += 4;
    for (std::size_t channel = 0; channel < 4; ++channel)
      for (std::size_t x = 0; x < row.size();) {
        const std::uint8_t code = byte();
        const bool repeats = code > 128;
        const std::size_t count = repeats ? code - 128U : code;
        if (count == 0 || count > row.size() - x) fail_row("a run does not fit");
        std::uint8_t value = repeats ? byte() : std::uint8_t{0};
        for (std::size_t i = 0; i < count; ++i, ++x) {
          if (!repeats) value = byte();
          row[x][channel] = value;
        }
      }
  }

  /// Pixel by pixel. (1, 1, 1, n) repeats the pixel before it n times; after another such, 256 n
  /// times, and so on.
  void read_pixels(std::vector<Pixel>& row) {
    unsigned shift = 0;
    for (std::size_t x = 0; x < row.size();) {
      Pixel p;
      for (std::uint8_t& channel : p) channel = byte();
      if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
        row[x++] = p;
        shift = 0;
        continue;
      }
      if (x == 0) fail_row("it repeats a pixel before the first");
      const std::size_t count = shift < 24 ? std::size_t{p[3]} << shift : row.size();
      if (count > row.size() - x) fail_row("a run does not fit");
      for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
      shift += 8;
    }
  }

  [[nodiscard]] Vec3 light(const Pixel& p) const {
    if (p[3] == 0) return {};
    const double unit = std::ldexp(scale_, int{p[3]} - (128 + 8));
    return {static_cast<float>(p[0] * unit), static_cast<float>(p[1] * unit),
            static_cast<float>(p[2] * unit)};
  }

  Bytes bytes_;
  const std::string& name_;
  Budget& budget_;
  std::size_t at_ = 0;
  int width_ = 0, height_ = 0, row_ = 0;
  double scale_ = 1;  ///< 1 / the product of EXPOSURE
};

}  // namespace

Image<Vec3> decode_rgbe(Bytes bytes, const std::string& name, Budget& budget) {
  return Rgbe(bytes, name, budget).read();
}

}  // namespace rastrum::io
