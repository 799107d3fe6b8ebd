// NPY 1.0 to 3.0 (numpy.lib.format): a magic, the length of a Python dictionary, the dictionary,
// the values. Only what numpy.save writes of a dictionary is read: three keys, in any order.
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include <rastrum/io.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/text_cursor.hpp>

namespace rastrum::io {
namespace {

struct Layout {
  std::string_view type;
  bool fortran = false;
  std::size_t rows = 0, columns = 0;
};

class NpyReader {
 public:
  NpyReader(std::span<const std::byte> bytes, const std::string& name)
      : bytes_(bytes), name_(name) {}

  [[nodiscard]] HeightGrid read() {
    const Layout layout = header();
    const std::string_view kind = layout.type.substr(1);
    if (kind == "f4") return values<float>(layout);
    if (kind == "f8") return values<double>(layout);
    if (kind == "i1") return values<std::int8_t>(layout);
    if (kind == "u1") return values<std::uint8_t>(layout);
    if (kind == "i2") return values<std::int16_t>(layout);
    if (kind == "u2") return values<std::uint16_t>(layout);
    if (kind == "i4") return values<std::int32_t>(layout);
    if (kind == "u4") return values<std::uint32_t>(layout);
    throw Error(Errc::unsupported,
                name_ + ": heights of type " + quoted(layout.type) +
                    " are not read (float32, float64, int or uint of 8, 16 or 32 bits are)");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Errc::bad_format, name_ + ": is not a sound NPY file: " + what);
  }
  [[nodiscard]] std::size_t byte(std::size_t i) const {
    return std::to_integer<std::size_t>(bytes_[i]);
  }

  Layout header() {
    if (bytes_.size() < 12 || as_text(bytes_).substr(0, 6) != "\x93NUMPY") fail("it has no header");
    const bool wide = byte(6) >= 2;  // 2.0 and 3.0: four bytes of length
    const std::size_t begin = wide ? 12 : 10;
    const std::size_t length =
        byte(8) | byte(9) << 8 | (wide ? byte(10) << 16 | byte(11) << 24 : 0);
    if (byte(6) < 1 || byte(6) > 3) fail("its version is " + std::to_string(byte(6)));
    if (length > bytes_.size() - begin) fail("it ends inside its header");
    data_ = begin + length;
    text_ = as_text(bytes_).substr(begin, length);
    Layout layout;
    layout.type = descr(after("'descr'"));
    const std::string_view order = after("'fortran_order'");
    if (order.starts_with("True"))
      layout.fortran = true;
    else if (!order.starts_with("False"))
      fail("fortran_order is neither True nor False");
    shape(after("'shape'"), layout);
    return layout;
  }
  /// What follows `key` and its colon.
  std::string_view after(std::string_view key) {
    const std::size_t at = text_.find(key);
    if (at == std::string_view::npos) fail("its header has no " + std::string(key));
    std::string_view rest = text_.substr(at + key.size());
    const std::size_t value = rest.find_first_not_of(" :");
    if (value == std::string_view::npos) fail("its header has no value of " + std::string(key));
    return rest.substr(value);
  }
  std::string_view descr(std::string_view text) {
    const std::size_t end = text.find('\'', 1);
    if (text.front() != '\'' || end == std::string_view::npos)
      throw Error(Errc::unsupported, name_ + ": holds records, not numbers");
    const std::string_view type = text.substr(1, end - 1);
    if (type.size() < 3 || std::string_view("<>|=").find(type[0]) == std::string_view::npos)
      fail("its type is " + quoted(type));
    return type;
  }
  void shape(std::string_view text, Layout& layout) {
    std::array<std::size_t, 2> size{};
    std::size_t n = 0;
    const char* at = text.data() + 1;
    const char* const end = text.data() + text.size();
    if (text.front() != '(') fail("its shape is no tuple");
    for (;; ++n) {
      while (at != end && (*at == ' ' || *at == ',')) ++at;
      if (at == end) fail("its shape does not end");
      if (*at == ')') break;
      std::size_t value = 0;
      const auto [next, error] = std::from_chars(at, end, value);
      if (error != std::errc{}) fail("its shape holds what is no number");
      if (n < 2) size[n] = value;
      at = next;
    }
    if (n != 2)
      throw Error(Errc::unsupported, name_ + ": has " + std::to_string(n) +
                                         " dimensions, but a height map has 2 (rows, columns)");
    layout.rows = size[0];
    layout.columns = size[1];
    const auto most = static_cast<std::size_t>(kMaxImageSize);
    if (layout.rows < 1 || layout.columns < 1 || layout.rows > most || layout.columns > most)
      throw Error(Errc::unsupported, name_ + ": its size " + std::to_string(layout.columns) + "x" +
                                         std::to_string(layout.rows) +
                                         " is outside 1x1 to 32768x32768");
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
  /// Beyond float32 is infinite, by the language only for what it calls in range: so said here.
  template <class T>
  static float height(T value) {
    if constexpr (std::is_same_v<T, double>) {
      constexpr double kMost = std::numeric_limits<float>::max();
      if (value > kMost) return std::numeric_limits<float>::infinity();
      if (value < -kMost) return -std::numeric_limits<float>::infinity();
    }
    return static_cast<float>(value);
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
  std::string_view text_;
  std::size_t data_ = 0;
};

}  // namespace

HeightGrid decode_height_npy(std::span<const std::byte> bytes, const std::string& name) {
  return NpyReader(bytes, name).read();
}

}  // namespace rastrum::io
