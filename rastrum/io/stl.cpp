// STL, ASCII and binary. Corners with equal position bits become one vertex (which is what vertex
// normals want to share); triangles keep the file's order. The facets' normals are not used: files
// often have them zero or wrong, and the corners say it already.
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/text_cursor.hpp>
#include <rastrum/io/vertex_table.hpp>

namespace rastrum::io {
namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;

std::uint32_t little_endian_u32(const std::byte* p) {
  std::uint32_t v = 0;
  for (int i = 3; i >= 0; --i) v = v << 8 | static_cast<std::uint32_t>(p[i]);
  return v;
}

Scene read_binary(Bytes bytes, std::size_t count, const std::string& name) {
  Mesh mesh;
  mesh.indices.resize(count * 3);
  // A closed mesh has half as many vertices as triangles.
  mesh.positions.reserve(count / 2 + 3);
  VertexTable vertex(mesh.positions, count / 2);
  const std::byte* facet = bytes.data() + kHeader;
  for (std::size_t t = 0; t < count; ++t, facet += kFacet)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::byte* p = facet + 12 + 12 * c;
      Vec3 v;
      if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(&v, p, 12);
      } else {
        v = {std::bit_cast<float>(little_endian_u32(p)),
             std::bit_cast<float>(little_endian_u32(p + 4)),
             std::bit_cast<float>(little_endian_u32(p + 8))};
      }
      mesh.indices[3 * t + c] = vertex(v);
    }
  Scene scene = scene_of(std::move(mesh));
  const std::size_t rest = bytes.size() - kHeader - kFacet * count;
  if (rest != 0)
    scene.warnings.push_back(name + ": " + std::to_string(rest) +
                             " bytes behind the last triangle are left out");
  return scene;
}

bool equals_ignoring_case(std::string_view a, std::string_view lower) {
  if (a.size() != lower.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char c = a[i] >= 'A' && a[i] <= 'Z' ? static_cast<char>(a[i] + 32) : a[i];
    if (c != lower[i]) return false;
  }
  return true;
}

Scene read_ascii(Bytes bytes, const std::string& name) {
  TextCursor in(as_text(bytes), name);
  Mesh mesh;
  VertexTable vertex(mesh.positions, bytes.size() / 400);
  std::uint32_t corner[3] = {};
  int corners = -1;  // −1: outside of a loop
  bool in_facet = false, in_solid = false;
  for (;;) {
    in.skip_space();
    const std::size_t start = in.offset();
    const std::string_view word = in.token();
    if (word.empty()) break;
    if (equals_ignoring_case(word, "vertex")) {
      if (corners < 0) in.fail_at(start, "a vertex stands outside of a loop");
      if (corners == 3) in.fail_at(start, "a facet has more than 3 vertices");
      const float x = in.word<float>("a coordinate", true);
      const float y = in.word<float>("a coordinate", true);
      const float z = in.word<float>("a coordinate", true);
      corner[corners++] = vertex({x, y, z});
    } else if (equals_ignoring_case(word, "endloop")) {
      if (corners != 3)
        in.fail_at(start, "a facet has " + std::to_string(corners < 0 ? 0 : corners) +
                              " vertices instead of 3");
      mesh.indices.insert(mesh.indices.end(), corner, corner + 3);
      corners = -1;
    } else if (equals_ignoring_case(word, "outer")) {
      if (!in_facet || corners >= 0) in.fail_at(start, "a loop stands outside of a facet");
      if (!equals_ignoring_case(in.token(), "loop")) in.fail_at(start, "expected 'outer loop'");
      corners = 0;
    } else if (equals_ignoring_case(word, "facet")) {
      if (in_facet) in.fail_at(start, "a facet begins inside of a facet");
      in_facet = true;
      // The normal's three words are not used and need not be numbers ("nan", "-1.#IND").
      if (!equals_ignoring_case(in.token(), "normal")) in.fail_at(start, "expected 'facet normal'");
      for (int i = 0; i < 3; ++i)
        if (in.at_line_end() || in.token().empty())
          in.fail_at(start, "expected three components of a normal");
    } else if (equals_ignoring_case(word, "endfacet")) {
      if (!in_facet || corners >= 0) in.fail_at(start, "'endfacet' stands outside of a facet");
      in_facet = false;
    } else if (equals_ignoring_case(word, "solid") || equals_ignoring_case(word, "endsolid")) {
      if (in_facet) in.fail_at(start, "the solid ends inside of a facet");
      in_solid = word.size() == 5;
      in.skip_line();  // its name may be anything
    } else {
      in.fail_at(start, "expected an STL keyword, found " + quoted(word));
    }
  }
  if (in_facet) in.fail("the file ends inside of a facet");
  Scene scene = scene_of(std::move(mesh));
  if (in_solid) scene.warnings.push_back(name + ": the last solid has no 'endsolid'");
  return scene;
}

/// A text begins with "solid" and goes on with facets or the end of the solid; some binary files
/// begin with "solid" too.
bool looks_ascii(Bytes bytes, const std::string& name) {
  TextCursor in(as_text(bytes), name);
  if (!equals_ignoring_case(in.token(), "solid")) return false;
  in.skip_line();
  const std::string_view next = in.token();
  return next.empty()
             ? bytes.size() < kHeader
             : equals_ignoring_case(next, "facet") || equals_ignoring_case(next, "endsolid");
}

}  // namespace

Scene parse_stl(Bytes bytes, const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::size_t capacity = bytes.size() < kHeader ? 0 : (bytes.size() - kHeader) / kFacet;
  const std::size_t count = bytes.size() < kHeader ? 0 : little_endian_u32(bytes.data() + 80);
  const bool exact = bytes.size() >= kHeader && bytes.size() == kHeader + count * kFacet;
  Scene scene;
  if (!exact && looks_ascii(bytes, name)) {
    scene = read_ascii(bytes, name);
  } else {
    if (bytes.size() < kHeader)
      throw Error(Errc::bad_format, name + ": is not STL: " + std::to_string(bytes.size()) +
                                        " bytes that do not begin with 'solid'");
    if (count > capacity || (count == 0 && bytes.size() > kHeader))
      throw Error(Errc::bad_format, name + ": the header says " + std::to_string(count) +
                                        " triangles, but there are bytes for " +
                                        std::to_string(capacity));
    scene = read_binary(bytes, count, name);
  }
  scene.meshes[0].name = file.stem().string();
  if (scene.meshes[0].indices.empty()) scene.warnings.push_back(name + ": holds no triangles");
  return scene;
}

}  // namespace rastrum::io
