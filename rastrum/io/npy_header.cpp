// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/npy_header.hpp>

#include <charconv>
#include <string_view>

#include <rastrum/error.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/text_cursor.hpp>

namespace rastrum::io {
namespace {

/// numpy's own maximum (NPY_MAXDIMS of version 2).
constexpr std::size_t kMostAxes = 64;

class NpyHeaderReader {
 public:
  NpyHeaderReader(Bytes bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  [[nodiscard]] NpyHeader read() {
    if (bytes_.size() < 12 || as_text(bytes_).substr(0, 6) != "\x93NUMPY") fail("it has no header");
    const bool wide = byte(6) >= 2;  // 2.0 and 3.0: four bytes of length
    const std::size_t begin = wide ? 12 : 10;
    const std::size_t length =
        byte(8) | byte(9) << 8 | (wide ? byte(10) << 16 | byte(11) << 24 : 0);
    if (byte(6) < 1 || byte(6) > 3) fail("its version is " + std::to_string(byte(6)));
    if (length > bytes_.size() - begin)
      fail("it ends inside its header, which would be " + std::to_string(length) +
           " bytes from byte " + std::to_string(begin) + " on");
    NpyHeader header;
    header.data = begin + length;
    text_ = as_text(bytes_).substr(begin, length);
    header.type = descr(after("'descr'"));
    const std::string_view order = after("'fortran_order'");
    if (order.starts_with("True"))
      header.fortran = true;
    else if (!order.starts_with("False"))
      fail("fortran_order is neither True nor False");
    shape(after("'shape'"), header);
    header.keeps_float64 = text_.find(kKeepsFloat64) != std::string_view::npos;
    // A length that is too great would take numbers for header, and shift all others.
    const std::size_t end = text_.find('}');
    if (end == std::string_view::npos ||
        text_.find_first_not_of(" \n", end + 1) != std::string_view::npos)
      fail("its header of " + std::to_string(length) + " bytes from byte " + std::to_string(begin) +
           " on is not a dictionary and spaces: its length is wrong");
    return header;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Errc::bad_format, name_ + ": is not a valid NPY file: " + what);
  }
  [[nodiscard]] std::size_t byte(std::size_t i) const {
    return std::to_integer<std::size_t>(bytes_[i]);
  }
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
    if (type.size() < 2 || std::string_view("<>|=").find(type[0]) == std::string_view::npos)
      fail("its type is " + quoted(type));
    return type;
  }
  void shape(std::string_view text, NpyHeader& header) {
    const char* at = text.data() + 1;
    const char* const end = text.data() + text.size();
    if (text.front() != '(') fail("its shape is no tuple");
    for (;;) {
      while (at != end && (*at == ' ' || *at == ',')) ++at;
      if (at == end) fail("its shape does not end");
      if (*at == ')') break;
      std::size_t value = 0;
      const auto [next, error] = std::from_chars(at, end, value);
      if (error == std::errc::result_out_of_range)
        fail("its shape holds what is no number below 2⁶⁴");
      if (error != std::errc{}) fail("its shape holds what is no number");
      if (header.shape.size() == kMostAxes)
        fail("its shape has more than " + std::to_string(kMostAxes) + " sizes");
      header.shape.push_back(value);
      at = next;
    }
  }

  Bytes bytes_;
  const std::string& name_;
  std::string_view text_;
};

}  // namespace

std::string NpyHeader::shape_text() const {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text.append(i == 0 ? "" : ", ").append(std::to_string(shape[i]));
  return text + (shape.size() == 1 ? ",)" : ")");
}

NpyHeader parse_npy_header(Bytes bytes, const std::string& name) {
  return NpyHeaderReader(bytes, name).read();
}

std::string npy_header_text(const std::string& type, const std::string& shape) {
  std::string dictionary =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  constexpr std::size_t kPrefix = 10;
  dictionary.append(63 - (kPrefix + dictionary.size()) % 64, ' ').push_back('\n');
  std::string text("\x93NUMPY\x01\x00", 8);
  text.push_back(static_cast<char>(dictionary.size() & 0xFF));
  text.push_back(static_cast<char>(dictionary.size() >> 8));
  return text + dictionary;
}

NpyTriangles parse_npy_triangles(Bytes bytes, const std::string& name) {
  NpyTriangles triangles{parse_npy_header(bytes, name)};
  const NpyHeader& header = triangles.header;
  const auto refuse = [&](const std::string& what) {
    throw Error(Errc::unsupported, name + ": " + what);
  };
  const std::vector<std::size_t>& shape = header.shape;
  const bool nine = shape.size() == 2 && shape[1] == 9;
  if (!nine && !(shape.size() == 3 && shape[1] == 3 && shape[2] == 3))
    refuse("its shape " + header.shape_text() +
           " is not that of triangles, (n, 3, 3) or (n, 9); a height map is drawn by "
           "'rastrum terrain --height'");
  const std::string type = header.type.substr(1);
  if (type != "f4" && type != "f8")
    refuse("its numbers have type " + quoted(std::string_view(header.type)) +
           ", but corners of triangles must be float32 ('<f4') or float64 ('<f8')");
  if (header.type[0] != '<')
    refuse("its numbers of type " + quoted(std::string_view(header.type)) +
           " are not little-endian; save array.astype('<" + type + "')");
  if (header.fortran) refuse("its array is in Fortran order; save numpy.ascontiguousarray(array)");
  triangles.wide = type == "f8";
  triangles.count = shape[0];
  const std::size_t there = (bytes.size() - header.data) / triangles.bytes_each();
  if (triangles.count > there)
    throw Error(Errc::bad_format,
                name + ": is not a valid NPY file: it ends after " + std::to_string(there) +
                    " of " + std::to_string(triangles.count) + " triangles, which begin at byte " +
                    std::to_string(header.data));
  return triangles;
}

}  // namespace rastrum::io
