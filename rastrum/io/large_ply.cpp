// SPDX-License-Identifier: BSD-3-Clause
// Binary PLY out of core. Vertices have one size and faces are triangles, so places can be
// computed; a list keeps the places of faces of fewer corners, which are skipped. Positions are
// read in place. A chunk copies its indices, because a face begins with its count, and counts them
// from its lowest vertex, so that no other vertices are projected.
#include <algorithm>
#include <cstring>
#include <limits>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>

#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>
#include <rastrum/io/colors.hpp>
#include <rastrum/io/large_indexed.hpp>
#include <rastrum/io/ply_header.hpp>
#include <rastrum/io/ply_source.hpp>

namespace rastrum::io {
namespace {

using ply::Element;
using ply::Property;
using ply::Type;

constexpr std::size_t kFaceCorners = 12;

class LargePly final : public LargeIndexed {
 public:
  explicit LargePly(const std::filesystem::path& file)
      : LargeIndexed(file), header_(ply::parse_header(bytes_of_file(), name_)) {
    meshes_.resize(1);
    constexpr auto kOwn = kLittleEndian ? ply::Format::little_endian : ply::Format::big_endian;
    if (header_.format != kOwn)
      refuse(header_.format == ply::Format::ascii
                 ? "it is text; write it as binary PLY"
                 : "its numbers are not in this machine's order; write them little-endian");
    if (header_.elements.size() != 2 || header_.elements[0].name != "vertex" ||
        header_.elements[1].name != "face")
      refuse("it has more or other elements than 'vertex' and then 'face'");
    place_vertices(header_.elements[0]);
    place_faces(header_.elements[1]);
  }

  [[nodiscard]] bool has_normals() const override { return has_normals_; }
  [[nodiscard]] bool has_materials() const override {
    return has_texcoords_ && !header_.texture_files.empty();
  }
  [[nodiscard]] std::uint64_t bytes_in_memory() const override {
    return triangles_ * kFaceCorners + vertices_ * vertex_in_memory();
  }
  [[nodiscard]] std::uint64_t bytes_beside() const override {
    return mesh().gaps.size() * sizeof(IndexedPlace::Gap);
  }
  [[nodiscard]] std::uint64_t bytes_a_triangle() const override {
    // A property of a face takes at most 10 bytes: colours 28 bytes for three channels or more.
    return mesh().face_bytes + kFaceCorners + 10 * (header_.elements[1].properties.size() - 1) +
           3 * (mesh().vertex_bytes + vertex_in_memory());
  }

  [[nodiscard]] FileSelection selection(std::span<const std::uint64_t> triangles) const override {
    check_length();
    VertexSet used(vertices_);
    each_face(triangles, [&](const std::byte* corners) {
      for (int c = 0; c < 3; ++c) used.add(index_at(corners, c));
    });
    const std::size_t n = used.find_places();
    const std::uint64_t translucent = translucent_vertex();
    const std::size_t vertices = n + (translucent != vertices_ ? 1 : 0);
    const std::string head = header_text(vertices, triangles.size());
    std::vector<std::byte> small(head.size() + vertices * mesh().vertex_bytes +
                                 triangles.size() * mesh().face_bytes);
    std::memcpy(small.data(), head.data(), head.size());
    std::byte* to = small.data() + head.size();
    const auto copy_vertex = [&](std::size_t v) {
      std::memcpy(to, bytes_of_file().data() + mesh().vertex_at(v), mesh().vertex_bytes);
      to += mesh().vertex_bytes;
    };
    {
      WalkWindow window(mapped(), mesh().vertex_at(0));
      used.for_each([&](std::size_t v) {
        window.reach(mesh().vertex_at(v));
        copy_vertex(v);
      });
    }
    if (translucent != vertices_) copy_vertex(translucent);
    each_face(triangles, [&](const std::byte* corners) {
      std::memcpy(to, corners - corners_, mesh().face_bytes);
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t place = used.place(index_at(corners, c));
        std::memcpy(to + corners_ + 4 * c, &place, sizeof(place));
      }
      to += mesh().face_bytes;
    });
    return FileSelection::of_one(std::move(small), triangles);
  }

 private:
  [[nodiscard]] static std::uint32_t index_at(const std::byte* corners, int c) {
    return load<std::uint32_t>(corners + 4 * c);
  }
  [[nodiscard]] std::uint64_t vertex_in_memory() const {
    return (mesh().far ? 36U : 12U) + (has_normals_ ? 12U : 0U) + (has_colors_ ? 16U : 0U) +
           8U * scalars_;
  }

  [[nodiscard]] IndexedPlace& mesh() { return meshes_[0]; }
  [[nodiscard]] const IndexedPlace& mesh() const { return meshes_[0]; }

  void check_room(const Element& e, std::size_t at) const {
    ply::check_room(e, bytes_of_file().size() - at, false,
                    [&](const std::string& why) { fail(why); });
  }

  void place_vertices(const Element& e) {
    if (e.has_list()) refuse("its vertices have lists");
    mesh().first_vertex = header_.size;
    check_room(e, mesh().first_vertex);
    vertices_ = mesh().vertices = e.count;
    if (vertices_ > std::numeric_limits<std::uint32_t>::max())
      throw Error(Errc::unsupported, name_ + ": more than 2³² vertices");
    mesh().vertex_bytes = e.least_bytes();
    const int x = e.find({"x"});
    if (x < 0 || e.find({"y"}) < 0 || e.find({"z"}) < 0) fail("its vertices have no x, y and z");
    const auto k = static_cast<std::size_t>(x);
    if (e.find({"y"}) != x + 1 || e.find({"z"}) != x + 2)
      refuse("its x, y and z are not side by side");
    const Type type = e.properties[k].type;
    if (type != e.properties[k + 1].type || type != e.properties[k + 2].type ||
        ply::is_integer(type))
      refuse("its x, y and z are not all float32 or all float64");
    mesh().position = offset_of(e, k);
    mesh().wide = type == Type::f64;
    mesh().far =
        mesh().wide && (header_.wide_positions ? *header_.wide_positions
                                               : lie_far(mesh().vertex_at(0) + mesh().position,
                                                         mesh().vertex_bytes, vertices_));
    has_normals_ = ply::find_normals(e).any();
    has_colors_ = ply::find_colors(e).any();
    scalars_ = e.properties.size() - 3U - (has_normals_ ? 3U : 0U) - (has_colors_ ? 3U : 0U);
    has_texcoords_ = ply::find_texcoords(e).any();
  }

  void place_faces(const Element& e) {
    const int found = e.find({"vertex_indices", "vertex_index"});
    if (e.count == 0 || found < 0) refuse("it has no faces");
    const auto list = static_cast<std::size_t>(found);
    const Property& p = e.properties[list];
    if (!p.is_list || !ply::is_integer(p.type)) fail("vertex_indices is not a list of integers");
    if (ply::size_of(p.type) != 4) refuse("its vertex_indices are not of 32 bits");
    for (std::size_t k = 0; k < e.properties.size(); ++k)
      if (k != list && e.properties[k].is_list) refuse("its faces have a second list");
    mesh().first_face = mesh().first_vertex + vertices_ * mesh().vertex_bytes;
    check_room(e, mesh().first_face);
    triangles_ = mesh().triangles = e.count;
    count_type_ = p.count_type;
    count_at_ = offset_of(e, list);
    corners_ = count_at_ + ply::size_of(p.count_type);
    mesh().face_bytes = e.least_bytes() + kFaceCorners;
    // The size suggests triangles alone. If that is wrong, reading the faces finds it.
    const std::size_t left = bytes_of_file().size() - mesh().first_face;
    if (left % mesh().face_bytes == 0 && left / mesh().face_bytes == e.count) return;
    std::tie(mesh().gaps, mesh().triangles) = look_at_faces();
    triangles_ = mesh().triangles;
    if (triangles_ == 0) refuse("it has no triangles");
  }

  /// Looks at all faces; those of fewer than three corners are gaps. Throws the reader's error for
  /// a bad face, else refuses the first of more than three corners.
  [[nodiscard]] std::pair<std::vector<IndexedPlace::Gap>, std::uint64_t> look_at_faces() const {
    const Bytes bytes = bytes_of_file();
    const std::size_t behind = mesh().face_bytes - kFaceCorners - corners_;
    std::vector<IndexedPlace::Gap> gaps;
    std::optional<std::pair<std::uint64_t, std::int64_t>> polygon;
    std::size_t at = mesh().first_face, gap = 0;
    std::uint64_t triangles = 0;
    WalkWindow window(mapped(), at);
    for (std::uint64_t face = 0; face < header_.elements[1].count; ++face) {
      window.reach(at);
      if (corners_ > bytes.size() - at) fail("the file ends inside of 'face'");
      const std::int64_t corners = corners_of(bytes.data() + at);
      if (corners < 0) fail("a list of 'face' has the count " + std::to_string(corners));
      const std::size_t size = corners_ + 4 * static_cast<std::size_t>(corners) + behind;
      if (size > bytes.size() - at) fail("the file ends inside of 'face'");
      if (corners > 3 && !polygon) polygon = {face, corners};
      at += size;
      if (corners >= 3) {
        ++triangles;
        continue;
      }
      gap += size;
      if (!gaps.empty() && gaps.back().triangle == triangles)
        gaps.back().bytes = gap;
      else
        gaps.push_back({triangles, gap});
    }
    if (polygon)
      refuse("face " + std::to_string(polygon->first) + " has " + std::to_string(polygon->second) +
             " corners; cut its faces into triangles");
    return {std::move(gaps), triangles};
  }

  [[nodiscard]] static std::size_t offset_of(const Element& e, std::size_t property) {
    std::size_t at = 0;
    for (std::size_t k = 0; k < property; ++k)
      at +=
          ply::size_of(e.properties[k].is_list ? e.properties[k].count_type : e.properties[k].type);
    return at;
  }

  [[nodiscard]] std::string header_text(std::size_t vertices, std::size_t faces) const {
    constexpr const char* kNames[] = {"char", "uchar", "short", "ushort",
                                      "int",  "uint",  "float", "double"};
    const auto type = [&](Type t) { return kNames[static_cast<std::size_t>(t)]; };
    std::string text = "ply\nformat ";
    text +=
        header_.format == ply::Format::little_endian ? "binary_little_endian" : "binary_big_endian";
    text += " 1.0\n";
    for (const std::string& picture : header_.texture_files)
      text.append("comment TextureFile ").append(picture).append("\n");
    // The reader decides this by all positions; a selection has only some.
    if (mesh().wide)
      text.append("comment position_type ").append(type(mesh().far ? Type::f64 : Type::f32)) +=
          '\n';
    const auto say_units = [&](const char* element, const ply::ColorUnits& units) {
      if (units.rgb != 0)
        text.append("comment colour_units ")
            .append(element)
            .append(text_of(" ", units.rgb, " ", units.alpha, "\n"));
    };
    say_units("vertex", vertex_colors().units);
    say_units("face", face_units_);
    const std::size_t counts[] = {vertices, faces};
    for (std::size_t i = 0; i < 2; ++i) {
      const Element& e = header_.elements[i];
      text += "element " + e.name + " " + std::to_string(counts[i]) + "\n";
      for (const Property& p : e.properties) {
        text += "property ";
        if (p.is_list) text.append("list ").append(type(p.count_type)).append(" ");
        text.append(type(p.type)).append(" ").append(p.name).append("\n");
      }
    }
    return text + "end_header\n";
  }

  [[nodiscard]] std::int64_t corners_of(const std::byte* face) const {
    return static_cast<std::int64_t>(ply::number_at(face + count_at_, count_type_));
  }
  void check_triangle(const std::byte* face) const {
    if (corners_of(face) == 3) return;
    (void)look_at_faces();
    refuse("it has faces of fewer than three corners, and bytes behind the last");
  }

  void copy_indices(const IndexedPlace& place, std::uint64_t first, std::size_t n,
                    std::uint32_t* to, std::uint32_t& lowest,
                    std::uint32_t& highest) const override {
    while (n != 0) {
      const std::size_t some = place.side_by_side(first, n);
      copy_some(first, some, to, lowest, highest);
      first += some;
      n -= some;
      to += 3 * some;
    }
  }

  void copy_some(std::uint64_t first, std::size_t n, std::uint32_t* to, std::uint32_t& lowest,
                 std::uint32_t& highest) const {
    const std::size_t face_bytes = mesh().face_bytes;
    const std::byte* face = bytes_of_file().data() + mesh().face_at(first);
    std::uint32_t low = lowest, high = highest;
    const bool short_count = ply::size_of(count_type_) == 1;
    for (std::size_t i = 0; i < n; ++i, face += face_bytes, to += 3) {
      if (!short_count || face[count_at_] != std::byte{3}) check_triangle(face);
      std::memcpy(to, face + corners_, kFaceCorners);
      low = std::min({low, to[0], to[1], to[2]});
      high = std::max({high, to[0], to[1], to[2]});
    }
    lowest = low;
    highest = high;
    if (high < vertices_) return;
    to -= 3 * n;
    for (std::size_t i = 0; i < 3 * n; ++i)
      if (to[i] >= vertices_) refuse_index(mesh(), first + i / 3, to[i]);
  }

  /// Calls f(corners) for these faces. Checks them, because nobody may have read the whole file.
  template <class F>
  void each_face(std::span<const std::uint64_t> triangles, const F& f) const {
    WalkWindow window(mapped(), mesh().first_face);
    for (const std::uint64_t t : triangles) {
      const std::size_t at = mesh().face_at(t);
      window.reach(at);
      const std::byte* const face = bytes_of_file().data() + at;
      check_triangle(face);
      for (int c = 0; c < 3; ++c)
        if (const std::uint32_t i = index_at(face + corners_, c); i >= vertices_)
          refuse_index(mesh(), t, i);
      f(face + corners_);
    }
  }

  /// Colours of vertices or faces, and what all of them together decide.
  struct Colors {
    const Element* element = nullptr;  ///< null: there are none
    ply::ColorPlaces places;
    std::uint64_t count = 0;
    ply::ColorUnits units;
    std::uint64_t translucent = 0;  ///< the first with an alpha below 1; else the count

    [[nodiscard]] bool has_alpha() const { return element != nullptr && places.channel[3] >= 0; }
  };

  [[nodiscard]] std::size_t place_of(const Colors& colors, std::uint64_t i) const {
    return colors.element == &header_.elements[0] ? mesh().vertex_at(i) : mesh().face_at(i);
  }

  [[nodiscard]] float channel(const Colors& colors, std::uint64_t i, int c) const {
    const auto k = static_cast<std::size_t>(colors.places.channel[c]);
    // Properties after the face's list lie three indices further.
    std::size_t at = offset_of(*colors.element, k);
    if (colors.element != &header_.elements[0] && at > count_at_) at += kFaceCorners;
    return float32_of(ply::number_at(bytes_of_file().data() + place_of(colors, i) + at,
                                     colors.element->properties[k].type));
  }

  /// Finds units and translucency by the reader's rules, if necessary from all `count` colours.
  [[nodiscard]] Colors look_at(const Element& e, std::uint64_t count) const {
    Colors colors{nullptr, ply::find_colors(e), count, {}, count};
    if (!colors.places.any()) return colors;
    colors.element = &e;
    const ply::ColorTypes types = ply::color_types(e, colors.places);
    LargestChannels largest;
    if (ply::depend_on_largest(types)) {
      each_color(colors, [&](std::uint64_t i) {
        Vec4 c{channel(colors, i, 0), channel(colors, i, 1), channel(colors, i, 2), 1};
        if (colors.has_alpha()) c.w = channel(colors, i, 3);
        largest.add(c);
        return true;
      });
    }
    colors.units = ply::units_of(largest, types);
    if (!colors.has_alpha()) return colors;
    const float scale = 1 / colors.units.alpha;
    colors.translucent = each_color(colors, [&](std::uint64_t i) {
      return channel(colors, i, 3) * scale >= 1;  // written so that a NaN is found
    });
    return colors;
  }

  /// Calls f(i) for the colours in order until it returns false. Returns that i.
  template <class F>
  std::uint64_t each_color(const Colors& colors, const F& f) const {
    WalkWindow window(mapped(), place_of(colors, 0));
    std::uint64_t i = 0;
    for (; i < colors.count && f(i); ++i)
      if (i % kAtOnce == 0) window.reach(place_of(colors, i));
    return i;
  }

  [[nodiscard]] const Colors& vertex_colors() const {
    look();
    return vertex_colors_;
  }
  [[nodiscard]] std::uint64_t translucent_vertex() const { return vertex_colors().translucent; }

  void look() const {
    const std::scoped_lock lock(once_);
    if (looked_) return;
    const Colors face_colors = look_at(header_.elements[1], triangles_);
    // A selection can add a translucent vertex, but no face.
    if (face_colors.translucent != triangles_) refuse("some colour of its faces is translucent");
    vertex_colors_ = look_at(header_.elements[0], vertices_);
    face_units_ = face_colors.units;
    looked_ = true;
  }

  ply::Header header_;
  std::size_t count_at_ = 0, corners_ = 0;
  Type count_type_ = Type::u8;
  std::size_t scalars_ = 0;
  bool has_normals_ = false, has_colors_ = false, has_texcoords_ = false;

  mutable std::mutex once_;
  mutable bool looked_ = false;
  mutable Colors vertex_colors_;
  mutable ply::ColorUnits face_units_;
};

}  // namespace

std::unique_ptr<LargeFile> open_large_ply(const std::filesystem::path& file) {
  return std::make_unique<LargePly>(file);
}

}  // namespace rastrum::io
