// SPDX-License-Identifier: BSD-3-Clause
// PLY: ASCII and binary of both endians, faces (polygons are cut) and triangle strips, colours of
// vertices or faces, pictures by `comment TextureFile`. Without faces its edges are lines, else its
// vertices points. Binary elements without lists are read as strided columns, property by property.
// Common layouts (`float x y z` side by side; faces of `uchar int[3]` alone) are copied 12 bytes at
// a time, at about memory speed. Counts are checked against the bytes before anything is allocated.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/io/colors.hpp>
#include <rastrum/io/faces_to_cut.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/ply_header.hpp>
#include <rastrum/io/ply_pictures.hpp>
#include <rastrum/io/ply_source.hpp>
#include <rastrum/io/wide_positions.hpp>
#include <rastrum/scene/mesh_checks.hpp>

namespace rastrum::io {
namespace {

using ply::Element;
using ply::Property;
using ply::Type;

/// Where a vertex property goes: a component of an array.
struct Target {
  float* first = nullptr;
  std::size_t stride = 0;    ///< floats
  double* number = nullptr;  ///< one scalar per vertex instead
};

struct FaceTargets {
  std::vector<int> scalars;  ///< its place in Mesh::scalars; −1: none
  ply::ColorPlaces colors;
  int texcoords = -1, picture = -1;  ///< `texcoord`, a list, and `texnumber`
};

class PlyReader {
 public:
  PlyReader(Bytes bytes, const std::filesystem::path& file, Reading& reading)
      : file_(file),
        name_(file.string()),
        header_(ply::parse_header(bytes, name_)),
        source_(bytes, header_, name_),
        budget_(reading.budget),
        pictures_(file_, header_.texture_files, reading) {}

  Scene read() {
    for (const Element& e : header_.elements) {
      source_.check_room(e);
      if (e.name == "vertex") {
        read_vertices(e);
      } else if (e.name == "face") {
        read_faces(e, false);
      } else if (e.name == "tristrips") {
        read_faces(e, true);
      } else if (e.name == "edge" && e.count != 0) {
        read_edges(e);
      } else {
        skip(e);
      }
    }
    check_indices(mesh_.indices, "triangle", 3);
    check_indices(edges_, "edge", 2);
    if (pictures_.has_faces())
      faces_to_cut_.finish(mesh_.positions,
                           {&mesh_.indices, &pictures_.corners(mesh_.indices.size())});
    else
      faces_to_cut_.finish(mesh_.positions, {&mesh_.indices});
    // Triangles of later elements have no number of an earlier one.
    for (NamedScalars& s : mesh_.scalars)
      if (s.per == Per::face) budget_.resize(s.values, mesh_.indices.size() / 3, kNoNumber);
    finish_colors();
    Scene scene;
    pictures_.finish(mesh_, scene, warnings_, unused_);
    const bool is_loose = faces_ == 0 && !mesh_.positions.empty();
    if (is_loose && !mesh_.texcoords.empty()) unused_.emplace_back("texture coordinates");
    if (!is_loose && !edges_.empty()) left_out(edges_.size() / 2, "edge");
    warn(is_loose);
    if (is_loose && edges_.empty()) {
      add_geometry(scene, cloud());
    } else if (is_loose) {
      add_geometry(scene, lines());
    } else {
      add_mesh(scene, std::move(mesh_));
    }
    scene.warnings = std::move(warnings_);
    return scene;
  }

 private:
  void say(const std::string& what) { warnings_.push_back(name_ + ": " + what); }
  void left_out(std::size_t count, const std::string& what) {
    say(std::to_string(count) + " of '" + what + "' are left out");
  }
  void skip(const Element& e) {
    if (e.count != 0 && e.name != "face") left_out(e.count, e.name);
    source_.skip(e);
  }

  Points cloud() {
    Points points;
    points.positions = std::move(mesh_.positions);
    points.wide_positions = std::move(mesh_.wide_positions);
    points.normals = std::move(mesh_.normals.values);
    points.colors = std::move(mesh_.colors.values);
    points.scalars = std::move(mesh_.scalars);
    return points;
  }

  /// With colours, no two edges share an end.
  Lines lines() {
    Lines lines;
    if (edge_colors_.empty()) {
      lines.positions = std::move(mesh_.positions);
      lines.wide_positions = std::move(mesh_.wide_positions);
      lines.colors = std::move(mesh_.colors.values);
      lines.scalars = std::move(mesh_.scalars);
      lines.indices = std::move(edges_);
      return lines;
    }
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      budget_.add(lines.positions, mesh_.positions[edges_[i]]);
      if (!mesh_.wide_positions.empty())
        budget_.add(lines.wide_positions, mesh_.wide_positions[edges_[i]]);
      budget_.add(lines.colors, edge_colors_[i / 2]);
    }
    for (const NamedScalars& s : mesh_.scalars) {
      NamedScalars& of_ends = lines.scalars.emplace_back();
      of_ends.name = s.name;
      for (const std::uint32_t v : edges_) budget_.add(of_ends.values, s.values[v]);
    }
    return lines;
  }

  void read_vertices(const Element& e) {
    if (!mesh_.positions.empty()) source_.fail("there is more than one element 'vertex'");
    const std::vector<Target> targets = make_targets(e);
    const ply::Source first = source_;
    if (source_.ascii() || e.has_list()) {
      for (std::size_t i = 0; i < e.count && !e.properties.empty(); ++i)
        for (std::size_t k = 0; k < e.properties.size(); ++k) value(e, k, targets[k], i);
    } else {
      columns(e, targets);
    }
    for (Vec2& t : mesh_.texcoords.values) t.y = 1 - t.y;  // PLY counts from the bottom
    if (is_wide(e) && header_.wide_positions.value_or(lie_far(mesh_.positions)))
      read_wide_positions(e, first);
  }

  [[nodiscard]] static bool is_wide(const Element& e) {
    return std::ranges::any_of(ply::find_positions(e).number, [&](int k) {
      return e.properties[static_cast<std::size_t>(k)].type == Type::f64;
    });
  }

  void read_wide_positions(const Element& e, const ply::Source& first) {
    const std::array<int, 3> xyz = ply::find_positions(e).number;
    std::vector<Vec3d> wide;
    budget_.resize(wide, e.count);
    ply::Source source = first;
    for (Vec3d& p : wide)
      for (std::size_t k = 0; k < e.properties.size(); ++k) {
        double* const to[3] = {&p.x, &p.y, &p.z};
        const auto c = std::ranges::find(xyz, static_cast<int>(k)) - xyz.begin();
        if (c < 3)
          *to[c] = source.number(e.properties[k], e);
        else
          source.skip(e.properties[k], e);
      }
    set_positions(mesh_, std::move(wide), budget_);
  }

  void columns(const Element& e, const std::vector<Target>& targets) {
    const std::size_t stride = e.least_bytes();
    const std::byte* from = source_.take(stride * e.count, e);
    for (std::size_t k = 0; k < e.properties.size(); ++k) {
      const Type type = e.properties[k].type;
      if (is_vec3(e, targets, k)) {
        copy_vec3(from, stride, e.count, targets[k]);
        from += 8;
        k += 2;
      } else {
        column(from, stride, e.count, type, targets[k]);
      }
      from += ply::size_of(type);
    }
  }

  std::vector<Target> make_targets(const Element& e) {
    std::vector<Target> targets(e.properties.size());
    const auto place = [&](const auto& numbers, auto& values) {
      for (std::size_t c = 0; c < std::size(numbers); ++c) {
        if (numbers[c] < 0) continue;
        const auto k = static_cast<std::size_t>(numbers[c]);
        targets[k] = {&values[0].x + c, sizeof(values[0]) / sizeof(float)};
      }
    };
    const ply::Places<3> xyz = ply::find_positions(e);
    if (!xyz.any()) source_.fail("its vertices have no x, y and z");
    if (e.count > std::numeric_limits<std::uint32_t>::max())
      throw Error(Errc::unsupported, name_ + ": more than 2³² vertices");
    if (e.count == 0) return targets;
    budget_.resize(mesh_.positions, e.count);
    place(xyz.number, mesh_.positions);
    if (const ply::Places<3> normal = ply::find_normals(e); normal.any()) {
      budget_.resize(mesh_.normals.values, e.count);
      place(normal.number, mesh_.normals.values);
    }
    if (const ply::Places<2> uv = ply::find_texcoords(e); uv.any()) {
      budget_.resize(mesh_.texcoords.values, e.count);
      place(uv.number, mesh_.texcoords.values);
    }
    if (const ply::ColorPlaces rgba = ply::find_colors(e); rgba.any()) {
      vertex_colors_ = ply::color_types(e, rgba);
      budget_.resize(mesh_.colors.values, e.count, Vec4{1, 1, 1, 1});
      place(rgba.channel, mesh_.colors.values);
    }
    for (std::size_t k = 0; k < e.properties.size(); ++k) {
      if (targets[k].first != nullptr) continue;
      if (e.properties[k].is_list)
        unused_.push_back(e.name + "." + e.properties[k].name);
      else
        targets[k].number = add_scalars(e.properties[k].name, Per::vertex, e.count).data();
    }
    return targets;
  }

  /// Whether three float32 in this machine's byte order are contiguous, here and in their target.
  [[nodiscard]] bool is_vec3(const Element& e, const std::vector<Target>& t, std::size_t k) const {
    if (source_.swap() || k + 2 >= t.size() || t[k].first == nullptr) return false;
    for (std::size_t c = 0; c < 3; ++c)
      if (e.properties[k + c].type != Type::f32 || t[k + c].first != t[k].first + c ||
          t[k + c].stride != 3)
        return false;
    return true;
  }

  static void copy_vec3(const std::byte* from, std::size_t stride, std::size_t n, const Target& t) {
    if (stride == 12) {
      std::memcpy(t.first, from, n * 12);
      return;
    }
    float* to = t.first;
    for (std::size_t i = 0; i < n; ++i, from += stride, to += 3) std::memcpy(to, from, 12);
  }

  void column(const std::byte* from, std::size_t stride, std::size_t n, Type type,
              const Target& t) const {
    if (t.first == nullptr && t.number == nullptr) return;
    ply::with_type(type, [&](auto v) {
      using T = decltype(v);
      float* to = t.first;
      for (std::size_t i = 0; i < n; ++i, from += stride) {
        const T x = load<T>(from, source_.swap());
        if (t.number != nullptr) {
          t.number[i] = static_cast<double>(x);
          continue;
        }
        if constexpr (std::is_same_v<T, double>)
          *to = float32_of(x);
        else
          *to = static_cast<float>(x);
        to += t.stride;
      }
    });
  }

  void value(const Element& e, std::size_t k, const Target& t, std::size_t i) {
    const Property& p = e.properties[k];
    if (t.number != nullptr)
      t.number[i] = source_.number(p, e);
    else if (t.first == nullptr)
      source_.skip(p, e);
    else if (source_.ascii())
      t.first[i * t.stride] = source_.word(p);
    else
      column(source_.take(ply::size_of(p.type), e), 0, 1, p.type,
             {t.first + t.stride * i, t.stride});
  }

  // Scalars are all other properties.

  std::vector<double>& add_scalars(const std::string& name, Per per, std::size_t count) {
    const bool is_known =
        std::ranges::find(mesh_.scalars, name, &NamedScalars::name) != mesh_.scalars.end();
    NamedScalars& s = mesh_.scalars.emplace_back();
    s.name = per == Per::face && is_known ? "face." + name : name;
    s.per = per;
    budget_.resize(s.values, count, kNoNumber);
    return s.values;
  }

  void read_faces(const Element& e, bool strips) {
    faces_ += e.count;
    const int found = e.find({"vertex_indices", "vertex_index"});
    if (found < 0) {
      if (e.count != 0) say("its faces have no vertex_indices");
      skip(e);
      return;
    }
    const auto list = static_cast<std::size_t>(found);
    const Property& p = e.properties[list];
    if (!p.is_list || !ply::is_integer(p.type))
      source_.fail("vertex_indices is not a list of integers");
    const FaceTargets targets = face_targets(e, list);
    std::size_t first = 0;
    if (!source_.ascii()) {
      // Enough if all faces are triangles, but no more than the remaining bytes can hold.
      const std::size_t hold = source_.left() / ply::size_of(p.type);
      budget_.reserve(mesh_.indices, mesh_.indices.size() + std::min(hold, e.count * 3));
      if (!strips && !source_.swap() && e.properties.size() == 1 &&
          ply::size_of(p.count_type) == 1 && ply::size_of(p.type) == 4)
        first = plain_triangles(e);
    }
    std::vector<double> values(e.properties.size());
    for (std::size_t i = first; i < e.count; ++i) {
      texcoord_.clear();
      for (std::size_t k = 0; k < e.properties.size(); ++k) {
        if (k == list)
          source_.list(p, e, polygon_);
        else if (static_cast<int>(k) == targets.texcoords)
          source_.list(e.properties[k], e, texcoord_);
        else if (e.properties[k].is_list)
          source_.skip(e.properties[k], e);
        else
          values[k] = source_.number(e.properties[k], e);
      }
      end_face(targets, values, strips);
    }
  }

  FaceTargets face_targets(const Element& e, std::size_t list) {
    FaceTargets t{std::vector<int>(e.properties.size(), -1), ply::find_colors(e)};
    if (t.colors.any()) face_color_types_ = ply::color_types(e, t.colors);
    for (std::size_t k = 0; k < e.properties.size(); ++k) {
      const Property& p = e.properties[k];
      const auto number = static_cast<int>(k);
      if (k == list || std::ranges::find(t.colors.channel, number) != std::end(t.colors.channel))
        continue;
      if (p.is_list && (p.name == "texcoord" || p.name == "texcoords")) {
        t.texcoords = number;
      } else if (p.is_list) {
        unused_.push_back(e.name + "." + p.name);
      } else if (p.name == "texnumber" && pictures_.any() &&
                 e.find({"texcoord", "texcoords"}) >= 0) {
        t.picture = number;
      } else {
        // Triangles of earlier elements have no value.
        (void)add_scalars(p.name, Per::face, mesh_.indices.size() / 3);
        t.scalars[k] = static_cast<int>(mesh_.scalars.size() - 1);
      }
    }
    return t;
  }

  /// Reads faces that are exactly `uchar 3, int[3]`, for as long as they come. Returns how many.
  std::size_t plain_triangles(const Element& e) {
    const Bytes rest = source_.rest();
    const std::byte* from = rest.data();
    const std::size_t most = std::min(e.count, rest.size() / 13);
    const std::size_t old = mesh_.indices.size();
    budget_.resize(mesh_.indices, old + most * 3);
    std::uint32_t* to = mesh_.indices.data() + old;
    std::size_t n = 0;
    for (; n < most && *from == std::byte{3}; ++n, from += 13, to += 3)
      std::memcpy(to, from + 1, 12);
    mesh_.indices.resize(old + n * 3);
    (void)source_.take(n * 13, e);
    return n;
  }

  void end_face(const FaceTargets& targets, const std::vector<double>& values, bool strips) {
    corners_.clear();
    emit(strips);
    for (const std::uint32_t c : corners_) add_index(polygon_[c], mesh_.indices, "triangle", 3);
    const std::size_t triangles = mesh_.indices.size() / 3;
    for (std::size_t k = 0; k < values.size(); ++k)
      if (targets.scalars[k] >= 0)
        budget_.resize(mesh_.scalars[static_cast<std::size_t>(targets.scalars[k])].values,
                       triangles, values[k]);
    if (targets.colors.any()) {
      face_colors_.add_none(triangles - corners_.size() / 3);
      face_colors_.add(color_of(targets.colors, values), triangles);
    }
    if (targets.texcoords < 0) return;
    if (strips || texcoord_.size() != 2 * polygon_.size()) texcoord_.clear();
    pictures_.add_face(texcoord_, corners_,
                       targets.picture < 0 ? 0 : values[static_cast<std::size_t>(targets.picture)],
                       mesh_.indices.size());
  }

  static Vec4 color_of(const ply::ColorPlaces& places, const std::vector<double>& values) {
    Vec4 color{0, 0, 0, 1};
    float* const to[4] = {&color.x, &color.y, &color.z, &color.w};
    for (std::size_t c = 0; c < 4; ++c)
      if (const int k = places.channel[c]; k >= 0)
        *to[c] = float32_of(values[static_cast<std::size_t>(k)]);
    return color;
  }

  /// The corners of the triangles of `polygon_`: a face, or strips that −1 ends. Every second
  /// triangle of a strip is turned to face the same way.
  void emit(bool strips) {
    const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
      for (const std::size_t k : {a, b, c}) corners_.push_back(static_cast<std::uint32_t>(k));
    };
    if (!strips) {
      if (polygon_.size() < 3) ++small_faces_;
      faces_to_cut_.add(
          polygon_.size(), mesh_.positions, mesh_.indices.size(),
          [&](std::size_t i) { return polygon_[i]; }, triangle);
      return;
    }
    std::size_t start = 0;
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      if (polygon_[i] == -1) {
        start = i + 1;
      } else if (i >= start + 2) {
        const bool odd = (i - start) % 2 != 0;
        triangle(odd ? i - 1 : i - 2, odd ? i - 2 : i - 1, i);
      }
    }
  }

  void add_index(std::int64_t i, std::vector<std::uint32_t>& to, const char* what,
                 std::size_t each) const {
    if (i < 0 || i > std::numeric_limits<std::uint32_t>::max())
      source_.fail(std::string(what) + " " + std::to_string(to.size() / each) +
                   " refers to vertex " + std::to_string(i));
    budget_.add(to, static_cast<std::uint32_t>(i));
  }

  void check_indices(const std::vector<std::uint32_t>& indices, const char* what,
                     std::size_t each) const {
    const std::size_t bad = first_beyond(indices, mesh_.positions.size());
    if (bad == indices.size()) return;
    source_.fail(std::string(what) + " " + std::to_string(bad / each) + " refers to vertex " +
                 vertex_text(indices[bad]) + ", but the file has " +
                 std::to_string(mesh_.positions.size()));
  }

  void read_edges(const Element& e) {
    const int ends[2] = {e.find({"vertex1"}), e.find({"vertex2"})};
    if (ends[0] < 0 || ends[1] < 0 || e.has_list()) return skip(e);
    const ply::ColorPlaces colors = ply::find_colors(e);
    std::vector<double> values(e.properties.size());
    for (std::size_t i = 0; i < e.count; ++i) {
      for (std::size_t k = 0; k < values.size(); ++k)
        values[k] = source_.number(e.properties[k], e);
      for (const int k : ends) {
        const double v = values[static_cast<std::size_t>(k)];
        add_index(v >= 0 && v < 4294967296.0 ? static_cast<std::int64_t>(v) : -1, edges_, "edge",
                  2);
      }
      if (colors.any()) budget_.add(edge_colors_, color_of(colors, values));
    }
    if (colors.any()) scale(edge_colors_, ply::color_types(e, colors), {}, "edges");
  }

  /// Divides colours by their units. If these are 0, the colours decide.
  void scale(std::span<Vec4> colors, const ply::ColorTypes& types, ply::ColorUnits units,
             const char* whose) {
    if (colors.empty()) return;
    if (units.rgb == 0) {
      LargestChannels largest;
      if (ply::depend_on_largest(types)) largest.add(colors);
      units = ply::units_of(largest, types);
      if (units.rgb != static_cast<float>(types.rgb))
        say(said_unit(largest.rgb, units.rgb, std::string("the colours of ") + whose));
    }
    scale_colors(colors, units.rgb, units.alpha);
  }

  void finish_colors() {
    scale(mesh_.colors.values, vertex_colors_, header_.vertex_units, "vertices");
    scale(face_colors_.values(), face_color_types_, header_.face_units, "faces");
    face_colors_.add_none(mesh_.indices.size() / 3);
    Attribute<Vec4> face_colors = face_colors_.take();
    if (!face_colors.empty() && !mesh_.colors.empty())
      say("the colours of faces are left out: vertices have some");
    else if (!face_colors.empty())
      mesh_.colors = std::move(face_colors);
  }

  void warn(bool is_loose) {
    if (small_faces_ != 0)
      say(std::to_string(small_faces_) + " faces with fewer than 3 corners are left out");
    if (!unused_.empty()) {
      std::string list;
      for (const std::string& u : unused_) list += (list.empty() ? "" : ", ") + u;
      say("properties that are not drawn: " + list.substr(0, 300));
    }
    if (mesh_.indices.empty() && !is_loose)
      say("holds no faces (" + std::to_string(mesh_.positions.size()) + " vertices)");
  }

  static constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

  std::filesystem::path file_;
  std::string name_;
  ply::Header header_;
  ply::Source source_;
  Budget& budget_;
  Mesh mesh_;
  std::vector<std::int64_t> polygon_;
  FacesToCut faces_to_cut_{budget_};
  std::vector<double> texcoord_;        ///< of its corners
  std::vector<std::uint32_t> corners_;  ///< of its triangles
  PlyPictures pictures_;
  ply::ColorTypes vertex_colors_, face_color_types_;
  FaceColors face_colors_{budget_};
  std::vector<std::uint32_t> edges_;  ///< pairs of vertices
  std::vector<Vec4> edge_colors_;
  std::vector<std::string> unused_, warnings_;
  std::size_t faces_ = 0, small_faces_ = 0;
};

}  // namespace

Scene parse_ply(Bytes bytes, const std::filesystem::path& file, Reading& reading) {
  Scene scene = PlyReader(bytes, file, reading).read();
  const std::string name = file.stem().string();
  for (Mesh& mesh : scene.meshes) mesh.name = name;
  for (Geometry& geometry : scene.geometries) std::visit([&](auto& g) { g.name = name; }, geometry);
  return scene;
}

}  // namespace rastrum::io
