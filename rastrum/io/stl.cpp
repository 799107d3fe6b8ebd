// SPDX-License-Identifier: BSD-3-Clause
// STL, ASCII and binary. Corners with equal position bits become one vertex, as vertex normals
// need; triangles keep the file's order. Facet normals are not used: they are often zero or wrong,
// and the corners determine them. Text may have `color` lines: inside a facet for it, before facets
// for all that follow.
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <rastrum/core/lower.hpp>
#include <rastrum/io/binary_stl.hpp>
#include <rastrum/io/colors.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/text_cursor.hpp>
#include <rastrum/io/vertex_table.hpp>
#include <rastrum/io/wide_positions.hpp>

namespace rastrum::io {
namespace {

Scene read_binary(Bytes bytes, std::size_t count, const std::string& name, Budget& budget) {
  Mesh mesh;
  budget.resize(mesh.indices, count * 3);
  // A closed mesh has half as many vertices as triangles.
  VertexTable vertex(mesh.positions, count / 2 + 3, budget);
  const std::byte* facet = bytes.data() + stl::kHeader;
  for (std::size_t t = 0; t < count; ++t, facet += stl::kFacet)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::byte* p = facet + stl::kCorners + 12 * c;
      mesh.indices[3 * t + c] =
          vertex({load_little_endian<float>(p), load_little_endian<float>(p + 4),
                  load_little_endian<float>(p + 8)});
    }
  const StlColors colors(bytes.first(80));
  mesh.colors = colors.read(bytes.data() + stl::kHeader, count, budget);
  Scene scene = scene_of(std::move(mesh));
  if (colors.has_material())
    scene.warnings.push_back(name + ": the highlight of the header's MATERIAL= is not drawn");
  const std::size_t rest = bytes.size() - stl::kHeader - stl::kFacet * count;
  if (rest != 0)
    scene.warnings.push_back(name + ": " + std::to_string(rest) +
                             " bytes behind the last triangle are left out");
  return scene;
}

/// Skips a solid's name, which may be anything, to the line's end or a facet or the solid's end on
/// it.
void skip_name(TextCursor& in) {
  while (!in.at_line_end()) {
    TextCursor ahead = in;
    const std::string_view word = ahead.token();
    if (equal_but_for_case(word, "endsolid") ||
        (equal_but_for_case(word, "facet") && !ahead.at_line_end() &&
         equal_but_for_case(ahead.token(), "normal")))
      return;
    (void)in.token();
  }
  in.skip_line();
}

template <class P>
class AsciiReader {
 public:
  AsciiReader(TextCursor in, const std::string& name, Budget& budget)
      : in_(in), name_(name), budget_(budget) {}

  Scene read() {
    for (;;) {
      in_.skip_space();
      start_ = in_.offset();
      const std::string_view word = in_.token();
      if (word.empty()) break;
      statement(word);
    }
    if (in_facet_) in_.fail("the file ends inside of a facet");
    std::vector<std::string> warnings;
    finish_colors(warnings);
    set_positions(mesh_, std::move(positions_), budget_);
    if (in_solid_) warnings.push_back(name_ + ": the last solid has no 'endsolid'");
    Scene scene = scene_of(std::move(mesh_));
    scene.warnings = std::move(warnings);
    return scene;
  }

 private:
  void statement(std::string_view word) {
    const auto is = [&](std::string_view keyword) { return equal_but_for_case(word, keyword); };
    if (is("vertex")) {
      if (corners_ < 0) fail("a vertex stands outside of a loop");
      if (corners_ == 3) fail("a facet has more than 3 vertices");
      corner_[corners_++] =
          vertex_({number("a coordinate"), number("a coordinate"), number("a coordinate")});
    } else if (is("endloop")) {
      if (corners_ != 3)
        fail("a facet has " + std::to_string(corners_ < 0 ? 0 : corners_) +
             " vertices instead of 3");
      for (const std::uint32_t v : corner_) budget_.add(mesh_.indices, v);
      corners_ = -1;
    } else if (is("outer")) {
      if (!in_facet_ || corners_ >= 0) fail("a loop stands outside of a facet");
      if (!equal_but_for_case(in_.token(), "loop")) fail("expected 'outer loop'");
      corners_ = 0;
    } else if (is("facet")) {
      if (in_facet_) fail("a facet begins inside of a facet");
      in_facet_ = true;
      // The normal's three words are not used and need not be numbers ("nan", "-1.#IND").
      if (!equal_but_for_case(in_.token(), "normal")) fail("expected 'facet normal'");
      for (int i = 0; i < 3; ++i)
        if (in_.at_line_end() || in_.token().empty()) fail("expected three components of a normal");
    } else if (is("endfacet")) {
      if (!in_facet_ || corners_ >= 0) fail("'endfacet' stands outside of a facet");
      in_facet_ = false;
      if (const auto& color = of_facet_ ? of_facet_ : of_solid_)
        colors_.add(*color, triangles());
      else
        colors_.add_none(triangles());
      of_facet_.reset();
    } else if (is("color") || is("colour")) {
      const auto channel = [&] { return static_cast<float>(number("a colour")); };
      const Vec4 color{channel(), channel(), channel(), 1};
      (void)in_.optional_word<float>();  // an alpha, which no program is known to write
      (in_facet_ ? of_facet_ : of_solid_) = color;
    } else if (is("solid") || is("endsolid")) {
      if (in_facet_) fail("the solid ends inside of a facet");
      in_solid_ = word.size() == 5;
      of_solid_.reset();
      skip_name(in_);
    } else {
      fail("expected an STL keyword, found " + quoted(word));
    }
  }

  auto number(const char* what) {
    return in_.word<std::conditional_t<std::is_same_v<P, Vec3d>, double, float>>(what, true);
  }
  [[noreturn]] void fail(const std::string& message) const { in_.fail_at(start_, message); }
  [[nodiscard]] std::size_t triangles() const { return mesh_.indices.size() / 3; }

  void finish_colors(std::vector<std::string>& warnings) {
    LargestChannels largest;
    largest.add(colors_.values());
    const float unit = color_unit(largest.rgb, 1);
    scale_colors(colors_.values(), unit, 1);
    mesh_.colors = colors_.take();
    if (unit != 1) warnings.push_back(name_ + ": " + said_unit(largest.rgb, unit));
  }

  TextCursor in_;
  const std::string& name_;
  Budget& budget_;
  Mesh mesh_;
  std::vector<P> positions_;
  VertexTable<P> vertex_{positions_, in_.left() / 400, budget_};
  std::size_t start_ = 0;  ///< of the statement being read
  std::uint32_t corner_[3] = {};
  int corners_ = -1;  ///< −1: outside of a loop
  bool in_facet_ = false, in_solid_ = false;
  std::optional<Vec4> of_facet_{}, of_solid_{};
  FaceColors colors_{budget_};
};

Scene read_ascii(TextCursor in, std::size_t passed_over, const std::string& name, Budget& budget) {
  Scene scene = AsciiReader<Vec3>(in, name, budget).read();
  if (lie_far(scene.meshes[0].positions)) scene = AsciiReader<Vec3d>(in, name, budget).read();
  if (passed_over != 0)
    scene.warnings.push_back(name + ": " + std::to_string(passed_over) +
                             " lines before 'solid' are left out");
  return scene;
}

/// The number of lines before "solid" in a text; leaves `in` there. None for other data: facets,
/// colours or the solid's end must follow, since some binary files begin with "solid".
std::optional<std::size_t> find_solid(TextCursor& in) {
  constexpr std::size_t kMostBefore = 100;
  for (std::size_t line = 0; line < kMostBefore && !in.at_end(); ++line) {
    TextCursor ahead = in;
    if (!ahead.at_line_end() && equal_but_for_case(ahead.token(), "solid")) {
      skip_name(ahead);
      const std::string_view next = ahead.token();
      for (const std::string_view word : {"facet", "endsolid", "color", "colour"})
        if (equal_but_for_case(next, word)) return line;
      // An empty solid, which is shorter than any binary file.
      if (next.empty() && in.text().size() < stl::kHeader) return line;
    }
    for (const char c : in.line())
      if (static_cast<unsigned char>(c) < ' ' && !TextCursor::is_space(c)) return {};
  }
  return {};
}

}  // namespace

Scene parse_stl(Bytes bytes, const std::filesystem::path& file, Reading& reading) {
  const std::string name = file.string();
  const bool exact = stl::is_exact(bytes);
  // A binary header may be anything, but hardly begins like a text in UTF-16.
  const TextFile text(exact ? std::string_view{} : as_text(bytes), name);
  TextCursor solid = text.cursor();
  Scene scene;
  if (const auto passed_over = exact ? std::nullopt : find_solid(solid)) {
    scene = read_ascii(solid, *passed_over, name, reading.budget);
  } else {
    const std::size_t count = stl::facet_count(
        bytes, [&](const std::string& why) { throw Error(Errc::bad_format, name + ": " + why); });
    scene = read_binary(bytes, count, name, reading.budget);
  }
  scene.meshes[0].name = file.stem().string();
  if (scene.meshes[0].indices.empty()) scene.warnings.push_back(name + ": holds no triangles");
  return scene;
}

}  // namespace rastrum::io
