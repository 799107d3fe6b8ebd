// Heights of an NPY file of two dimensions, of any type and order.
#include <array>
#include <bit>
#include <string_view>
#include <type_traits>
#include <utility>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/npy_header.hpp>
#include <rastrum/io/text_cursor.hpp>
#include <rastrum/io/wide_positions.hpp>

namespace rastrum::io {
namespace {

struct Layout {
  std::string type;
  bool fortran = false;
  std::size_t rows = 0, columns = 0;
};

class NpyReader {
 public:
  NpyReader(std::span<const std::byte> bytes, const std::string& name)
      : bytes_(bytes), name_(name) {}

  [[nodiscard]] HeightGrid read() {
    const Layout layout = header();
    const std::string_view kind = std::string_view(layout.type).substr(1);
    if (kind == "f4") return values<float>(layout);
    if (kind == "f8") return values<double>(layout);
    if (kind == "i1") return values<std::int8_t>(layout);
    if (kind == "u1") return values<std::uint8_t>(layout);
    if (kind == "i2") return values<std::int16_t>(layout);
    if (kind == "u2") return values<std::uint16_t>(layout);
    if (kind == "i4") return values<std::int32_t>(layout);
    if (kind == "u4") return values<std::uint32_t>(layout);
    throw Error(Errc::unsupported,
                name_ + ": heights of type " + quoted(std::string_view(layout.type)) +
                    " are not read (float32, float64, int or uint of 8, 16 or 32 bits are)");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Errc::bad_format, name_ + ": is not a sound NPY file: " + what);
  }
  Layout header() {
    NpyHeader header = parse_npy_header(bytes_, name_);
    data_ = header.data;
    if (header.shape.size() != 2)
      throw Error(Errc::unsupported, name_ + ": has " + std::to_string(header.shape.size()) +
                                         " dimensions, but a height map has 2 (rows, columns)");
    Layout layout{std::move(header.type), header.fortran, header.shape[0], header.shape[1]};
    const auto most = static_cast<std::size_t>(kMaxImageSize);
    if (layout.rows < 1 || layout.columns < 1 || layout.rows > most || layout.columns > most)
      throw Error(Errc::unsupported, name_ + ": its size " + std::to_string(layout.columns) + "x" +
                                         std::to_string(layout.rows) +
                                         " is outside 1x1 to 32768x32768");
    return layout;
  }

  template <class T>
  HeightGrid values(const Layout& layout) {
    const std::size_t count = layout.rows * layout.columns;
    if (count * sizeof(T) > bytes_.size() - data_)
      fail("it ends after " + std::to_string((bytes_.size() - data_) / sizeof(T)) + " of " +
           std::to_string(count) + " heights");
    const bool big = layout.type[0] == '>';
    const bool swap =
        layout.type[0] == '<' || big ? big != (std::endian::native == std::endian::big) : false;
    HeightGrid grid{Image<float>(static_cast<int>(layout.columns), static_cast<int>(layout.rows)),
                    1, sizeof(T) == 1};
    const std::byte* at = bytes_.data() + data_;
    for (std::size_t i = 0; i < count; ++i, at += sizeof(T)) {
      std::array<std::byte, sizeof(T)> raw;
      for (std::size_t b = 0; b < sizeof(T); ++b) raw[b] = at[swap ? sizeof(T) - 1 - b : b];
      const std::size_t to =
          layout.fortran ? i % layout.rows * layout.columns + i / layout.rows : i;
      grid.heights.pixels()[to] = height(std::bit_cast<T>(raw));
    }
    return grid;
  }
  template <class T>
  static float height(T value) {
    if constexpr (std::is_same_v<T, double>)
      return float32_of(value);
    else
      return static_cast<float>(value);
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
  std::size_t data_ = 0;
};

}  // namespace

HeightGrid decode_height_npy(std::span<const std::byte> bytes, const std::string& name) {
  const FloatScope floats;
  return NpyReader(bytes, name).read();
}

}  // namespace rastrum::io
