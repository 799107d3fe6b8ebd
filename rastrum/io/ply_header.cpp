// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/ply_header.hpp>

#include <algorithm>

#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/text_cursor.hpp>

namespace rastrum::io::ply {
namespace {

constexpr std::size_t kLongestHeader = std::size_t{1} << 20;
constexpr std::size_t kMostElements = 1000, kMostProperties = 10000;

Type parse_type(TextCursor& in) {
  struct Name {
    std::string_view text;
    Type type;
  };
  static constexpr Name kNames[] = {
      {"char", Type::i8},   {"int8", Type::i8},     {"uchar", Type::u8},   {"uint8", Type::u8},
      {"short", Type::i16}, {"int16", Type::i16},   {"ushort", Type::u16}, {"uint16", Type::u16},
      {"int", Type::i32},   {"int32", Type::i32},   {"uint", Type::u32},   {"uint32", Type::u32},
      {"float", Type::f32}, {"float32", Type::f32}, {"double", Type::f64}, {"float64", Type::f64},
  };
  in.skip_blanks();
  const std::size_t at = in.offset();
  const std::string_view word = in.at_line_end() ? std::string_view{} : in.token();
  for (const Name& n : kNames)
    if (n.text == word) return n.type;
  in.fail_at(at, quoted(word) + " is no type of a property");
}

std::string parse_name(TextCursor& in) {
  if (in.at_line_end()) in.fail("a name is missing");
  return std::string(in.token().substr(0, 200));
}

Property parse_property(TextCursor& in) {
  Property p;
  in.skip_blanks();
  TextCursor ahead = in;
  if (ahead.token() == "list") {
    in = ahead;
    p.is_list = true;
    const std::size_t at = in.offset();
    p.count_type = parse_type(in);
    if (!is_integer(p.count_type)) in.fail_at(at, "a list's count must be an integer");
  }
  p.type = parse_type(in);
  p.name = parse_name(in);
  return p;
}

/// Comments are free text, but for a few that some programs write.
void parse_comment(TextCursor& in, Header& header) {
  if (in.at_line_end()) return;
  const std::string_view word = in.token();
  in.skip_blanks();
  TextCursor rest = in;
  if (word == "TextureFile" && !in.at_line_end()) {
    header.texture_files.emplace_back(rest.line());
  } else if (word == "colour_units" && !in.at_line_end()) {
    const std::string_view element = rest.token();
    const auto rgb = rest.optional_word<float>(), alpha = rest.optional_word<float>();
    if (rgb && alpha)
      (element == "face" ? header.face_units : header.vertex_units) = {*rgb, *alpha};
  } else if (word == "position_type" && !in.at_line_end()) {
    const std::string_view type = rest.token();
    if (type == "double" || type == "float") header.wide_positions = type == "double";
  }
}

}  // namespace

std::size_t Element::least_bytes() const {
  std::size_t n = 0;
  for (const Property& p : properties) n += size_of(p.is_list ? p.count_type : p.type);
  return n;
}

bool Element::has_list() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const Property& p) { return p.is_list; });
}

int Element::find(std::initializer_list<std::string_view> names) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    for (const std::string_view n : names)
      if (properties[i].name == n) return static_cast<int>(i);
  return -1;
}

int Element::find_number(std::initializer_list<std::string_view> names) const {
  const int k = find(names);
  return k >= 0 && properties[static_cast<std::size_t>(k)].is_list ? -1 : k;
}

Places<3> find_positions(const Element& e) {
  return {{e.find_number({"x"}), e.find_number({"y"}), e.find_number({"z"})}};
}

Places<3> find_normals(const Element& e) {
  return {{e.find_number({"nx", "normal_x"}), e.find_number({"ny", "normal_y"}),
           e.find_number({"nz", "normal_z"})}};
}

Places<2> find_texcoords(const Element& e) {
  return {{e.find_number({"s", "u", "texture_u", "texture_s"}),
           e.find_number({"t", "v", "texture_v", "texture_t"})}};
}

ColorPlaces find_colors(const Element& e) {
  const ColorPlaces places{{e.find_number({"red", "diffuse_red", "r"}),
                            e.find_number({"green", "diffuse_green", "g"}),
                            e.find_number({"blue", "diffuse_blue", "b"}),
                            e.find_number({"alpha", "diffuse_alpha", "a"})}};
  const auto& c = places.channel;
  return c[0] >= 0 && c[1] >= 0 && c[2] >= 0 ? places : ColorPlaces{};
}

Header parse_header(Bytes bytes, const std::string& name) {
  std::string_view text = as_text(bytes.first(std::min(bytes.size(), kLongestHeader)));
  const std::size_t mark = byte_order_mark(text, name);
  text.remove_prefix(mark);
  // Lines of a header may end in CR alone, and binary data may follow it.
  std::string copy;
  if (text.starts_with("ply\r") && !text.starts_with("ply\r\n")) {
    constexpr std::string_view kEnd = "end_header\r";
    copy = text.substr(0, text.find(kEnd));
    if (copy.size() < text.size()) copy += kEnd;
    std::replace(copy.begin(), copy.end(), '\r', '\n');
    text = copy;
  }
  TextCursor in(text, name);
  Header header;
  if (in.line() != "ply")
    throw Error(Errc::bad_format, name + ": is not PLY: no 'ply' at its start");
  bool has_format = false;
  std::size_t properties = 0;
  for (;;) {
    if (in.at_end()) in.fail("the header has no 'end_header'");
    const std::size_t start = in.offset();
    if (in.at_line_end()) {
      in.skip_line();
      continue;
    }
    const std::string_view word = in.token();
    if (word == "end_header") {
      in.skip_line();
      break;
    }
    if (word == "comment" || word == "obj_info") {
      parse_comment(in, header);
    } else if (word == "format") {
      const std::string_view format = in.at_line_end() ? std::string_view{} : in.token();
      if (format == "ascii") {
        header.format = Format::ascii;
      } else if (format == "binary_little_endian") {
        header.format = Format::little_endian;
      } else if (format == "binary_big_endian") {
        header.format = Format::big_endian;
      } else {
        in.fail_at(start, quoted(format) + " is no format of PLY");
      }
      has_format = true;
    } else if (word == "element") {
      Element e;
      e.name = parse_name(in);
      e.count = in.word<std::size_t>("a count");
      if (header.elements.size() == kMostElements) in.fail_at(start, "there are too many elements");
      header.elements.push_back(std::move(e));
    } else if (word == "property") {
      if (header.elements.empty()) in.fail_at(start, "a property stands before any element");
      if (++properties > kMostProperties) in.fail_at(start, "there are too many properties");
      header.elements.back().properties.push_back(parse_property(in));
    } else {
      in.fail_at(start, quoted(word) + " does not belong in a header");
    }
    in.skip_line();
  }
  if (!has_format) in.fail("the header has no 'format'");
  header.size = mark + in.offset();
  return header;
}

}  // namespace rastrum::io::ply
