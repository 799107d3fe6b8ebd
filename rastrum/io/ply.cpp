// PLY: ASCII and binary of both endians, faces (polygons are cut) and triangle strips; without
// faces its vertices are points. Binary
// elements without lists are read property by property as strided columns; the common layouts
// (`float x y z` side by side; faces of `uchar int[3]` alone) go through copies of 12 bytes, so
// that a mapped file loads at about memory speed. Counts are checked against the bytes that are
// there before anything is allocated.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/io/faces_to_cut.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/ply_header.hpp>
#include <rastrum/io/text_cursor.hpp>

namespace rastrum::io {
namespace {

using ply::Element;
using ply::Format;
using ply::Property;
using ply::Type;

template <class T>
T load(const std::byte* p, bool swap) {
  std::array<std::byte, sizeof(T)> b;
  std::memcpy(b.data(), p, sizeof(T));
  if (swap) std::reverse(b.begin(), b.end());
  return std::bit_cast<T>(b);
}

/// Calls f with a value of the C++ type that `type` names.
template <class F>
auto with_type(Type type, F&& f) {
  switch (type) {
    case Type::i8:
      return f(std::int8_t{});
    case Type::u8:
      return f(std::uint8_t{});
    case Type::i16:
      return f(std::int16_t{});
    case Type::u16:
      return f(std::uint16_t{});
    case Type::i32:
      return f(std::int32_t{});
    case Type::u32:
      return f(std::uint32_t{});
    case Type::f32:
      return f(float{});
    case Type::f64:
      break;
  }
  return f(double{});
}

float to_float(double x) {
  // A conversion that does not fit is undefined; the renderer drops infinite vertices.
  constexpr double kMax = std::numeric_limits<float>::max();
  if (x > kMax) return std::numeric_limits<float>::infinity();
  if (x < -kMax) return -std::numeric_limits<float>::infinity();
  return static_cast<float>(x);
}

/// Where a vertex property goes: component `component` of an array, scaled.
struct Target {
  float* first = nullptr;
  std::size_t stride = 0;  ///< floats
  float scale = 1;
  double* number = nullptr;  ///< one of scalars instead, one a vertex
};

class PlyReader {
 public:
  PlyReader(Bytes bytes, const std::filesystem::path& file)
      : name_(file.string()), bytes_(bytes), header_(ply::parse_header(bytes, name_)) {
    at_ = header_.size;
    swap_ = (header_.format == Format::big_endian) == (std::endian::native == std::endian::little);
  }

  Scene read() {
    TextCursor text(as_text(bytes_), name_);
    text.advance(at_);
    text_ = &text;
    for (const Element& e : header_.elements) {
      check_room(e);
      if (e.name == "vertex") {
        read_vertices(e);
      } else if (e.name == "face") {
        read_faces(e, false);
      } else if (e.name == "tristrips") {
        read_faces(e, true);
      } else {
        skip(e);
      }
    }
    check_indices();
    faces_to_cut_.finish(mesh_.positions, {&mesh_.indices});
    // Triangles of later elements have none of an earlier one's numbers.
    for (NamedScalars& s : mesh_.scalars)
      if (s.per == Per::face)
        s.values.resize(mesh_.indices.size() / 3, std::numeric_limits<double>::quiet_NaN());
    const bool is_cloud = faces_ == 0 && !mesh_.positions.empty();
    if (is_cloud && !mesh_.texcoords.empty()) unused_.emplace_back("texture coordinates");
    warn(is_cloud);
    Scene scene;
    if (is_cloud)
      add_geometry(scene, cloud());
    else
      scene = scene_of(std::move(mesh_));
    scene.warnings = std::move(warnings_);
    return scene;
  }

 private:
  [[nodiscard]] bool ascii() const { return header_.format == Format::ascii; }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(Errc::bad_format, name_ + ": " + message);
  }

  /// The least that the element can take: a character and a separator a value in ASCII.
  void check_room(const Element& e) const {
    if (e.properties.empty() || e.count == 0) return;
    const std::size_t left = ascii() ? (text_->left() + 1) / 2 : bytes_.size() - at_;
    const std::size_t each = ascii() ? e.properties.size() : e.least_bytes();
    if (e.count > left / each)
      fail("the header says " + std::to_string(e.count) + " of '" + e.name +
           "', but the file is too short for them (" +
           std::to_string(ascii() ? text_->left() : bytes_.size() - at_) + " bytes are left)");
  }

  [[nodiscard]] const std::byte* take(std::size_t n, const Element& e) {
    if (n > bytes_.size() - at_) fail("the file ends inside of '" + e.name + "'");
    const std::byte* p = bytes_.data() + at_;
    at_ += n;
    return p;
  }

  /// The vertices alone.
  Points cloud() {
    Points points;
    points.positions = std::move(mesh_.positions);
    points.normals = std::move(mesh_.normals.values);
    points.colors = std::move(mesh_.colors.values);
    points.scalars = std::move(mesh_.scalars);
    return points;
  }

  // ---- vertices

  void read_vertices(const Element& e) {
    if (!mesh_.positions.empty()) fail("there is more than one element 'vertex'");
    const std::vector<Target> targets = make_targets(e);
    if (ascii()) {
      for (std::size_t i = 0; i < e.count && !e.properties.empty(); ++i)
        for (std::size_t k = 0; k < e.properties.size(); ++k)
          ascii_value(e.properties[k], targets[k], i);
    } else if (!e.has_list()) {
      const std::size_t stride = e.least_bytes();
      const std::byte* base = take(stride * e.count, e);
      std::size_t offset = 0;
      for (std::size_t k = 0; k < e.properties.size(); ++k) {
        if (targets[k].number != nullptr) {
          numbers(base + offset, stride, e.count, e.properties[k].type, targets[k].number);
        } else if (targets[k].first != nullptr) {
          if (is_vec3(e, targets, k)) {
            copy_vec3(base + offset, stride, e.count, targets[k]);
            offset += 8;
            k += 2;
          } else {
            column(base + offset, stride, e.count, e.properties[k].type, targets[k]);
          }
        }
        offset += size_of(e.properties[k].type);
      }
    } else {
      for (std::size_t i = 0; i < e.count; ++i)
        for (std::size_t k = 0; k < e.properties.size(); ++k) {
          const Property& p = e.properties[k];
          if (p.is_list) {
            skip_list(p, e);
            continue;
          }
          Target t = targets[k];
          if (t.first != nullptr) t.first += t.stride * i;
          const std::byte* at = take(size_of(p.type), e);
          if (t.first != nullptr) column(at, 0, 1, p.type, t);
          if (t.number != nullptr) numbers(at, 0, 1, p.type, t.number + i);
        }
    }
    for (Vec2& t : mesh_.texcoords.values) t.y = 1 - t.y;  // PLY counts from the bottom
  }

  std::vector<Target> make_targets(const Element& e) {
    std::vector<Target> targets(e.properties.size());
    std::vector<bool> used(e.properties.size());
    const auto place = [&](int property, float* first, std::size_t stride, bool color) {
      const auto k = static_cast<std::size_t>(property);
      targets[k] = {first, stride, 1};
      used[k] = true;
      const Type type = e.properties[k].type;
      if (color && ply::is_integer(type))
        targets[k].scale = 1 / static_cast<float>(with_type(type, [](auto v) {
                             return static_cast<double>(std::numeric_limits<decltype(v)>::max());
                           }));
    };
    const auto scalar = [&](std::initializer_list<std::string_view> names) {
      const int k = e.find(names);
      return k >= 0 && e.properties[static_cast<std::size_t>(k)].is_list ? -1 : k;
    };
    const int xyz[3] = {scalar({"x"}), scalar({"y"}), scalar({"z"})};
    if (xyz[0] < 0 || xyz[1] < 0 || xyz[2] < 0) fail("its vertices have no x, y and z");
    if (e.count > std::numeric_limits<std::uint32_t>::max())
      throw Error(Errc::unsupported, name_ + ": more than 2³² vertices");
    if (e.count == 0) return targets;
    mesh_.positions.resize(e.count);
    for (std::size_t c = 0; c < 3; ++c) place(xyz[c], &mesh_.positions[0].x + c, 3, false);

    const int normal[3] = {scalar({"nx", "normal_x"}), scalar({"ny", "normal_y"}),
                           scalar({"nz", "normal_z"})};
    if (normal[0] >= 0 && normal[1] >= 0 && normal[2] >= 0) {
      mesh_.normals.values.resize(e.count);
      for (std::size_t c = 0; c < 3; ++c)
        place(normal[c], &mesh_.normals.values[0].x + c, 3, false);
    }
    const int uv[2] = {scalar({"s", "u", "texture_u", "texture_s"}),
                       scalar({"t", "v", "texture_v", "texture_t"})};
    if (uv[0] >= 0 && uv[1] >= 0) {
      mesh_.texcoords.values.resize(e.count);
      for (std::size_t c = 0; c < 2; ++c) place(uv[c], &mesh_.texcoords.values[0].x + c, 2, false);
    }
    const int rgba[4] = {
        scalar({"red", "diffuse_red", "r"}), scalar({"green", "diffuse_green", "g"}),
        scalar({"blue", "diffuse_blue", "b"}), scalar({"alpha", "diffuse_alpha", "a"})};
    if (rgba[0] >= 0 && rgba[1] >= 0 && rgba[2] >= 0) {
      mesh_.colors.values.resize(e.count, Vec4{1, 1, 1, 1});
      for (std::size_t c = 0; c < 4; ++c)
        if (rgba[c] >= 0) place(rgba[c], &mesh_.colors.values[0].x + c, 4, true);
    }
    for (std::size_t k = 0; k < e.properties.size(); ++k) {
      if (used[k]) continue;
      if (e.properties[k].is_list)
        unused_.push_back(e.name + "." + e.properties[k].name);
      else
        targets[k].number = add_scalars(e.properties[k].name, Per::vertex, e.count).data();
    }
    return targets;
  }

  // ---- scalars: what is nothing else

  std::vector<double>& add_scalars(const std::string& name, Per per, std::size_t count) {
    NamedScalars& s = mesh_.scalars.emplace_back();
    const auto has = [&](const std::string& n) {
      return std::count_if(mesh_.scalars.begin(), mesh_.scalars.end() - 1,
                           [&](const NamedScalars& other) { return other.name == n; }) != 0;
    };
    s.name = per == Per::face && has(name) ? "face." + name : name;
    s.per = per;
    s.values.assign(count, std::numeric_limits<double>::quiet_NaN());
    return s.values;
  }

  void numbers(const std::byte* from, std::size_t stride, std::size_t n, Type type,
               double* to) const {
    with_type(type, [&](auto v) {
      using T = decltype(v);
      for (std::size_t i = 0; i < n; ++i, from += stride)
        to[i] = static_cast<double>(load<T>(from, swap_));
    });
  }

  /// Of the properties of faces, those that are numbers: places in mesh_.scalars, −1 for others.
  std::vector<int> face_scalars(const Element& e, std::size_t list) {
    std::vector<int> places(e.properties.size(), -1);
    for (std::size_t k = 0; k < e.properties.size(); ++k) {
      if (k == list) continue;
      if (e.properties[k].is_list) {
        unused_.push_back(e.name + "." + e.properties[k].name);
        continue;
      }
      // Triangles of elements before have none.
      (void)add_scalars(e.properties[k].name, Per::face, mesh_.indices.size() / 3);
      places[k] = static_cast<int>(mesh_.scalars.size() - 1);
    }
    return places;
  }

  /// All triangles of a face have its numbers.
  void end_face(const std::vector<int>& places, const std::vector<double>& values) {
    for (std::size_t k = 0; k < places.size(); ++k)
      if (places[k] >= 0)
        mesh_.scalars[static_cast<std::size_t>(places[k])].values.resize(mesh_.indices.size() / 3,
                                                                         values[k]);
  }

  /// Three float32 of this machine's byte order side by side that go side by side.
  [[nodiscard]] bool is_vec3(const Element& e, const std::vector<Target>& t, std::size_t k) const {
    if (swap_ || k + 2 >= t.size()) return false;
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
    with_type(type, [&](auto v) {
      using T = decltype(v);
      float* to = t.first;
      for (std::size_t i = 0; i < n; ++i, from += stride, to += t.stride) {
        const T x = load<T>(from, swap_);
        if constexpr (std::is_same_v<T, double>)
          *to = to_float(x) * t.scale;
        else
          *to = static_cast<float>(x) * t.scale;
      }
    });
  }

  void ascii_value(const Property& p, const Target& t, std::size_t i) {
    if (p.is_list) {
      ascii_skip_list(p);
    } else if (t.number != nullptr) {
      t.number[i] = text_->word<double>(p.name.c_str(), true);
    } else if (t.first == nullptr) {
      ascii_skip_value();
    } else {
      t.first[i * t.stride] = text_->word<float>(p.name.c_str(), true) * t.scale;
    }
  }

  void ascii_skip_value() {
    if (text_->token().empty()) text_->fail("the file ends too early");
  }
  void ascii_skip_list(const Property& p) {
    const auto n = text_->word<std::uint32_t>(("the count of " + p.name).c_str(), true);
    for (std::uint32_t i = 0; i < n; ++i) ascii_skip_value();
  }

  // ---- faces

  void read_faces(const Element& e, bool strips) {
    faces_ += e.count;
    const int found = e.find({"vertex_indices", "vertex_index"});
    if (found < 0) {
      if (e.count != 0) warnings_.push_back(name_ + ": its faces have no vertex_indices");
      skip(e);
      return;
    }
    const auto list = static_cast<std::size_t>(found);
    const Property& p = e.properties[list];
    if (!p.is_list || !ply::is_integer(p.type)) fail("vertex_indices is not a list of integers");
    const std::vector<int> places = face_scalars(e, list);
    if (ascii()) {
      ascii_faces(e, list, strips, places);
      return;
    }
    std::vector<double> values(places.size());
    reserve_triangles(e, p);
    std::size_t first = 0;
    if (!strips && !swap_ && e.properties.size() == 1 && size_of(p.count_type) == 1 &&
        size_of(p.type) == 4)
      first = plain_triangles(e.count);
    for (std::size_t i = first; i < e.count; ++i) {
      for (std::size_t k = 0; k < e.properties.size(); ++k) {
        if (k == list) {
          binary_face(e, p, strips);
        } else if (e.properties[k].is_list) {
          skip_list(e.properties[k], e);
        } else {
          const Type type = e.properties[k].type;
          numbers(take(size_of(type), e), 0, 1, type, &values[k]);
        }
      }
      end_face(places, values);
    }
  }

  /// As if all faces were triangles, but never more than the bytes left can hold.
  void reserve_triangles(const Element& e, const Property& p) {
    const std::size_t hold = (bytes_.size() - at_) / size_of(p.type);
    mesh_.indices.reserve(mesh_.indices.size() + std::min(hold, e.count * 3));
  }

  /// Faces of exactly `uchar 3, int[3]` for as long as they come: 13 bytes to 12. Returns how many.
  std::size_t plain_triangles(std::size_t count) {
    const std::byte* from = bytes_.data() + at_;
    const std::size_t most = std::min(count, (bytes_.size() - at_) / 13);
    const std::size_t old = mesh_.indices.size();
    mesh_.indices.resize(old + most * 3);
    std::uint32_t* to = mesh_.indices.data() + old;
    std::size_t n = 0;
    for (; n < most && *from == std::byte{3}; ++n, from += 13, to += 3)
      std::memcpy(to, from + 1, 12);
    mesh_.indices.resize(old + n * 3);
    at_ += n * 13;
    return n;
  }

  /// A list's count; its values follow. Checked against the bytes left by the caller's take().
  std::size_t list_count(const Property& p, const Element& e) {
    const std::byte* at = take(size_of(p.count_type), e);
    const std::int64_t n = with_type(p.count_type, [&](auto v) {
      return static_cast<std::int64_t>(load<decltype(v)>(at, swap_));
    });
    if (n < 0) fail("a list of '" + e.name + "' has the count " + std::to_string(n));
    return static_cast<std::size_t>(n);
  }

  void skip_list(const Property& p, const Element& e) {
    const std::size_t n = list_count(p, e);
    (void)take(n * size_of(p.type), e);
  }

  void binary_face(const Element& e, const Property& p, bool strips) {
    const std::size_t n = list_count(p, e);
    const std::byte* at = take(n * size_of(p.type), e);
    polygon_.resize(n);
    with_type(p.type, [&](auto v) {
      using T = decltype(v);
      if constexpr (std::is_integral_v<T>)
        for (std::size_t i = 0; i < n; ++i)
          polygon_[i] = static_cast<std::int64_t>(load<T>(at + i * sizeof(T), swap_));
    });
    emit(strips);
  }

  void ascii_faces(const Element& e, std::size_t list, bool strips,
                   const std::vector<int>& places) {
    std::vector<double> values(places.size());
    for (std::size_t i = 0; i < e.count; ++i) {
      for (std::size_t k = 0; k < e.properties.size(); ++k) {
        const Property& p = e.properties[k];
        if (k == list) {
          const auto n = text_->word<std::uint32_t>("the count of a face", true);
          polygon_.clear();
          for (std::uint32_t j = 0; j < n; ++j)
            polygon_.push_back(text_->word<std::int64_t>("a vertex index", true));
          emit(strips);
        } else if (p.is_list) {
          ascii_skip_list(p);
        } else {
          values[k] = text_->word<double>(p.name.c_str(), true);
        }
      }
      end_face(places, values);
    }
  }

  /// The triangles of `polygon_`: of a face, or of strips that −1 ends, every second triangle
  /// turned so that all face the same way.
  void emit(bool strips) {
    if (!strips) {
      if (polygon_.size() < 3) ++small_faces_;
      faces_to_cut_.add(
          polygon_.size(), mesh_.positions, mesh_.indices.size(),
          [&](std::size_t i) { return polygon_[i]; },
          [&](std::size_t a, std::size_t b, std::size_t c) {
            triangle(polygon_[a], polygon_[b], polygon_[c]);
          });
      return;
    }
    std::size_t start = 0;
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      if (polygon_[i] == -1) {
        start = i + 1;
      } else if (i >= start + 2) {
        const bool odd = (i - start) % 2 != 0;
        triangle(polygon_[odd ? i - 1 : i - 2], polygon_[odd ? i - 2 : i - 1], polygon_[i]);
      }
    }
  }

  void triangle(std::int64_t a, std::int64_t b, std::int64_t c) {
    for (const std::int64_t i : {a, b, c}) {
      if (i < 0 || i > std::numeric_limits<std::uint32_t>::max())
        fail("triangle " + std::to_string(mesh_.indices.size() / 3) + " refers to vertex " +
             std::to_string(i));
      mesh_.indices.push_back(static_cast<std::uint32_t>(i));
    }
  }

  // ---- the rest

  void skip(const Element& e) {
    if (e.count != 0 && e.name != "face")
      warnings_.push_back(name_ + ": " + std::to_string(e.count) + " of '" + e.name +
                          "' are left out");
    if (e.properties.empty()) return;
    if (!ascii() && !e.has_list()) {
      (void)take(e.least_bytes() * e.count, e);
      return;
    }
    for (std::size_t i = 0; i < e.count; ++i)
      for (const Property& p : e.properties) {
        if (ascii()) {
          p.is_list ? ascii_skip_list(p) : ascii_skip_value();
        } else if (p.is_list) {
          skip_list(p, e);
        } else {
          (void)take(size_of(p.type), e);
        }
      }
  }

  void check_indices() const {
    std::uint32_t largest = 0;
    for (const std::uint32_t i : mesh_.indices) largest = std::max(largest, i);
    if (mesh_.indices.empty() || largest < mesh_.positions.size()) return;
    const auto bad = std::find_if(mesh_.indices.begin(), mesh_.indices.end(),
                                  [&](std::uint32_t i) { return i >= mesh_.positions.size(); });
    fail("triangle " + std::to_string((bad - mesh_.indices.begin()) / 3) + " refers to vertex " +
         std::to_string(static_cast<std::int32_t>(*bad) < 0
                            ? static_cast<std::int64_t>(static_cast<std::int32_t>(*bad))
                            : std::int64_t{*bad}) +
         ", but the file has " + std::to_string(mesh_.positions.size()));
  }

  void warn(bool is_cloud) {
    if (small_faces_ != 0)
      warnings_.push_back(name_ + ": " + std::to_string(small_faces_) +
                          " faces with fewer than 3 corners are left out");
    if (!unused_.empty()) {
      std::string list;
      for (const std::string& u : unused_) list += (list.empty() ? "" : ", ") + u;
      warnings_.push_back(name_ + ": properties that are not drawn: " + list.substr(0, 300));
    }
    if (mesh_.indices.empty() && !is_cloud)
      warnings_.push_back(name_ + ": holds no faces (" + std::to_string(mesh_.positions.size()) +
                          " vertices)");
  }

  std::string name_;
  Bytes bytes_;
  ply::Header header_;
  TextCursor* text_ = nullptr;  ///< ASCII: the place of reading
  std::size_t at_ = 0;          ///< binary: the place of reading
  bool swap_ = false;           ///< the file's byte order is not this machine's
  Mesh mesh_;
  std::vector<std::int64_t> polygon_;
  FacesToCut faces_to_cut_;
  std::vector<std::string> unused_, warnings_;
  std::size_t faces_ = 0, small_faces_ = 0;
};

}  // namespace

Scene parse_ply(Bytes bytes, const std::filesystem::path& file) {
  Scene scene = PlyReader(bytes, file).read();
  const std::string name = file.stem().string();
  for (Mesh& mesh : scene.meshes) mesh.name = name;
  for (Geometry& geometry : scene.geometries) std::visit([&](auto& g) { g.name = name; }, geometry);
  return scene;
}

}  // namespace rastrum::io
