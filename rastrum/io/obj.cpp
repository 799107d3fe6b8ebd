// SPDX-License-Identifier: BSD-3-Clause
// Wavefront OBJ, strictly: a bad number or an index that does not exist is an error with file and
// line. mtl.cpp reads materials. A file is one mesh, so that triangles keep the file's order over
// groups, objects and materials; points and lines follow.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <future>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include <rastrum/io/beside.hpp>
#include <rastrum/io/colors.hpp>
#include <rastrum/io/faces_to_cut.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>
#include <rastrum/io/text_cursor.hpp>
#include <rastrum/io/wide_positions.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::io {
namespace {

constexpr std::uint32_t kMissing = std::numeric_limits<std::uint32_t>::max();
/// The colour of vertices without one where others have one.
constexpr Vec4 kWhite{1, 1, 1, 1};

/// The largest index that faces used of one array, and where. Faces may precede their vertices, so
/// the line is named at the end.
struct Use {
  std::uint32_t largest = 0;
  std::size_t offset = 0;
  bool any = false;
  void note(std::uint32_t index, std::size_t at) {
    if (any && index <= largest) return;
    largest = index;
    offset = at;
    any = true;
  }
};

struct Corner {
  std::uint32_t position, texcoord, normal;
};

class ObjReader {
 public:
  ObjReader(Bytes bytes, const std::filesystem::path& file, Reading& reading)
      : file_(file),
        name_(file.string()),
        files_(reading),
        budget_(reading.budget),
        text_(as_text(bytes), name_),
        in_(text_.cursor()) {}

  Scene read() {
    while (!in_.at_end()) statement();
    if (lie_far(mesh_.positions)) read_wide_positions();
    finish_libraries();
    if (!has_materials_.empty()) finish_materials();
    check_positions();
    faces_to_cut_.finish(mesh_.positions, {&mesh_.indices, &texcoord_indices_, &normal_indices_});
    finish_colors();
    finish_texcoords();
    finish_normals();
    warn_about_the_rest();
    std::vector<Geometry> loose = points_and_lines();
    mesh_.name = file_.stem().string();
    if (loose.empty() || !mesh_.indices.empty()) add_mesh(scene_, std::move(mesh_));
    for (Geometry& geometry : loose) add_geometry(scene_, std::move(geometry));
    return std::move(scene_);
  }

 private:
  /// Reads a line. A backslash at its end joins the next.
  void statement() {
    in_.skip_space();
    if (in_.at_end()) return;
    start_ = in_.offset();
    if (in_.peek() == '#') return in_.skip_line();
    const std::string_view word = in_.token();
    if (word == "v") {
      vertex();
    } else if (word == "vn") {
      budget_.add(normals_, vec3("a normal's component"));
    } else if (word == "vt") {
      texcoord();
    } else if (word == "f" || word == "fo") {
      face();
    } else if (word == "p" || word == "l") {
      loose_element(word == "l");
    } else if (word == "usemtl") {
      use_material(rest());
      return;
    } else if (word == "mtllib") {
      read_library(rest());
      return;
    } else if (word == "o" || word == "g" || word == "s" || word == "mg") {
      // Names and smoothing change nothing that is drawn.
    } else {
      ++ignored_[std::string(word.substr(0, 24))];
    }
    in_.skip_line();
  }

  bool at_statement_end() {
    while (in_.at_line_end() == false && in_.peek() == '\\') {
      in_.advance(1);
      if (!in_.at_line_end()) in_.fail("a backslash stands in the middle of a line");
      if (in_.at_end()) return true;
      in_.advance(1);
    }
    return in_.at_line_end() || in_.peek() == '#';
  }

  std::string rest() {
    in_.skip_blanks();
    return std::string(in_.line());
  }

  template <class T = float>
  T number(const char* what) {
    if (at_statement_end()) in_.fail_at(start_, std::string("expected ") + what);
    return in_.word<T>(what);
  }

  Vec3 vec3(const char* what) { return {number(what), number(what), number(what)}; }

  /// x y z, x y z w, x y z r g b or x y z r g b a.
  void vertex() {
    budget_.add(mesh_.positions, vec3("a coordinate"));
    float extra[4];
    int n = 0;
    while (n < 4 && !at_statement_end()) extra[n++] = number("a number");
    if (n < 3) return;
    auto& colors = mesh_.colors.values;
    budget_.resize(colors, std::max(colors.size(), mesh_.positions.size() - 1), kWhite);
    budget_.add(colors, {extra[0], extra[1], extra[2], n == 4 ? extra[3] : 1.0F});
  }

  /// Reads the text again, for positions in float64.
  void read_wide_positions() {
    const TextCursor behind = std::exchange(in_, text_.cursor());
    std::vector<Vec3d> wide;
    while (wide.size() < mesh_.positions.size()) {
      in_.skip_space();
      start_ = in_.offset();
      if (in_.token() == "v") {
        budget_.add(wide, {number<double>("x"), number<double>("y"), number<double>("z")});
      }
      in_.skip_line();
    }
    in_ = behind;
    set_positions(mesh_, std::move(wide), budget_);
  }

  void texcoord() {
    const float u = number("a texture coordinate");
    const float v = at_statement_end() ? 0 : number("a texture coordinate");
    budget_.add(texcoords_, {u, 1 - v});  // ours count from the top
  }

  /// The next index. Files count from 1, or negative from the end so far.
  std::uint32_t index(const char* number, std::size_t count, const char* what, const char* whose,
                      Use& use) {
    const auto said = in_.number<std::int64_t>(number);
    const std::int64_t zero_based = said > 0 ? said - 1 : static_cast<std::int64_t>(count) + said;
    if (said == 0 || zero_based < 0 || zero_based >= kMissing)
      in_.fail_at(start_, std::string("the ") + whose + " refers to " + what + " " +
                              std::to_string(said) + ", but there are " + std::to_string(count) +
                              " so far");
    use.note(static_cast<std::uint32_t>(zero_based), start_);
    return static_cast<std::uint32_t>(zero_based);
  }
  std::uint32_t vertex_index(const char* whose, Use& use) {
    return index("a vertex index", mesh_.positions.size(), "vertex", whose, use);
  }

  /// v, v/vt, v//vn or v/vt/vn. The index after a slash may be missing.
  Corner corner() {
    Corner c{vertex_index("face", position_use_), kMissing, kMissing};
    if (in_.peek() != '/') return c;
    in_.advance(1);
    if (is_index())
      c.texcoord = index("a texture coordinate's index", texcoords_.size(), "texture coordinate",
                         "face", texcoord_use_);
    if (in_.peek() != '/') return c;
    in_.advance(1);
    if (is_index())
      c.normal = index("a normal's index", normals_.size(), "normal", "face", normal_use_);
    return c;
  }

  [[nodiscard]] bool is_index() const {
    const char c = in_.peek();
    return c == '-' || c == '+' || (c >= '0' && c <= '9');
  }

  void face() {
    face_.clear();
    while (!at_statement_end()) {
      budget_.add(face_, corner());
      if (!TextCursor::is_space(in_.peek()) && in_.peek() != '\\')
        in_.fail_at(start_, "the face has a corner that is not v, v/vt, v//vn or v/vt/vn");
    }
    if (face_.size() < 3) ++small_faces_;
    faces_to_cut_.add(
        face_.size(), mesh_.positions, mesh_.indices.size(),
        [&](std::size_t i) { return face_[i].position; },
        [&](std::size_t a, std::size_t b, std::size_t c) {
          for (const std::size_t k : {a, b, c}) {
            budget_.add(mesh_.indices, face_[k].position);
            budget_.add(texcoord_indices_, face_[k].texcoord);
            budget_.add(normal_indices_, face_[k].normal);
          }
          budget_.add(face_materials_, material_);
        });
  }

  /// `p v…`: points. `l v…` or `l v/vt…`: a polyline, whose texture coordinates are ignored.
  void loose_element(bool is_line) {
    const char* const name = is_line ? "line" : "point";
    const std::size_t begin = loose_corners_.size();
    while (!at_statement_end()) {
      budget_.add(loose_corners_, vertex_index(name, loose_use_));
      if (is_line && in_.peek() == '/') {
        in_.advance(1);
        if (is_index()) (void)in_.number<std::int64_t>("a texture coordinate's index");
      }
      if (!TextCursor::is_space(in_.peek()) && in_.peek() != '\\')
        in_.fail_at(start_, std::string("the ") + name + " has a corner that is not v" +
                                (is_line ? " or v/vt" : ""));
    }
    const std::size_t n = loose_corners_.size() - begin;
    if (n < (is_line ? 2U : 1U)) {
      loose_corners_.resize(begin);
      ++short_lines_;
      return;
    }
    budget_.add(loose_, {is_line, material_, begin, n});
  }

  /// Points and polylines of the whole file, one geometry per material in order of first use, so
  /// that thousands of lines do not become thousands of geometries.
  std::vector<Geometry> points_and_lines() {
    std::vector<Geometry> all;
    std::map<std::pair<bool, std::uint32_t>, std::size_t> numbers;
    for (const Loose& element : loose_) {
      const auto [at, is_new] =
          numbers.try_emplace({element.is_line, element.material}, all.size());
      if (is_new) {
        if (element.is_line)
          all.emplace_back(Lines{.name = file_.stem().string(), .kind = LineKind::polylines});
        else
          all.emplace_back(Points{.name = file_.stem().string()});
      }
      const auto add = [&](auto& g) {
        g.material = element.material;
        for (std::size_t i = 0; i < element.count; ++i) {
          const std::uint32_t v = loose_corners_[element.begin + i];
          budget_.add(g.positions, mesh_.positions[v]);
          if (!mesh_.wide_positions.empty()) budget_.add(g.wide_positions, mesh_.wide_positions[v]);
          if (!mesh_.colors.empty()) budget_.add(g.colors, mesh_.colors.values[v]);
        }
      };
      if (auto* const points = std::get_if<Points>(&all[at->second])) add(*points);
      if (auto* const lines = std::get_if<Lines>(&all[at->second])) {
        add(*lines);
        if (is_new) lines->offsets.push_back(0);
        budget_.add(lines->offsets, static_cast<std::uint32_t>(lines->positions.size()));
      }
    }
    return all;
  }

  void read_library(const std::string& names) {
    // Names may hold spaces, and several may share a line. The whole line is tried first.
    const auto folder = file_.parent_path();
    std::error_code ignored;
    std::vector<FoundFile> found = {find_beside(folder, names)};
    if (!std::filesystem::exists(found[0].path, ignored)) {
      found.clear();
      TextCursor words(names, name_);
      for (std::string_view w = words.token(); !w.empty(); w = words.token())
        found.push_back(find_beside(folder, w));
    }
    for (const FoundFile& f : found) {
      if (!known_libraries_.insert(f.path).second) continue;
      if (!f.as_named) note_name(renamed_libraries_, f.path.filename().string());
      libraries_.push_back(f.path);
      if (libraries_.size() == 1) begin_library();
    }
  }

  void read_materials(const std::filesystem::path& library) {
    read_mtl(library, scene_, by_name_, transforms_, files_);
  }
  /// Reads the first library, mostly the only one, and its pictures beside this text. Until
  /// finish_libraries that thread owns scene_ and by_name_.
  void begin_library() {
    if (parallel::Threads().concurrency() == 1) return;
    try {
      reading_ = std::async(std::launch::async,
                            [this, library = libraries_.front(), stop = StopScope::current()] {
                              const StopScope scope(stop);
                              read_materials(library);
                            });
    } catch (const std::system_error&) {
      // No thread was available: it is read after the text.
    }
  }
  void finish_libraries() {
    std::size_t first = 0;
    if (reading_.valid()) {
      reading_.get();
      first = 1;
    }
    for (std::size_t i = first; i < libraries_.size(); ++i) read_materials(libraries_[i]);
    if (!renamed_libraries_.empty()) say("read from beside this file: " + renamed_libraries_);
  }

  void use_material(const std::string& name) {
    if (const auto known = has_materials_.find(name); known != has_materials_.end()) {
      material_ = known->second;
      return;
    }
    // Ids of names in order of use. They become indices of Scene::materials at the end, since a
    // library may come after its use.
    material_ = static_cast<std::uint32_t>(has_materials_.size()) + 1;
    has_materials_.emplace(name, material_);
    used_names_.push_back(name);
  }

  void finish_materials() {
    std::vector<std::uint32_t> index_of(used_names_.size() + 1, kMissing);
    bool all = true;
    const bool unnamed =
        std::ranges::find(face_materials_, 0U) != face_materials_.end() ||
        std::ranges::any_of(loose_, [](const Loose& e) { return e.material == 0; });
    std::string unknown;
    for (std::size_t i = 0; i < used_names_.size(); ++i) {
      const auto it = by_name_.find(used_names_[i]);
      if (it != by_name_.end()) {
        index_of[i + 1] = it->second;
      } else {
        all = false;
        unknown += (unknown.empty() ? "" : ", ") + used_names_[i].substr(0, 60);
      }
    }
    if (!unknown.empty())
      say("no .mtl file defines " + unknown + "; drawn with the default material");
    if (scene_.materials.empty()) {  // nothing was found: the file has no materials
      for (Loose& e : loose_) e.material = 0;
      return;
    }
    if (!all || unnamed) {
      const auto fallback = static_cast<std::uint32_t>(scene_.materials.size());
      Material m;
      m.name = "default";
      m.metallic = 0;
      scene_.materials.push_back(m);
      std::replace(index_of.begin(), index_of.end(), kMissing, fallback);
    }
    for (std::uint32_t& m : face_materials_) m = index_of[m];
    for (Loose& e : loose_) e.material = index_of[e.material];
    set_materials(mesh_, std::move(face_materials_));
  }

  void check_positions() {
    for (const auto& [use, whose] :
         {std::pair(&position_use_, "face"), std::pair(&loose_use_, "point or line")})
      if (use->any && use->largest >= mesh_.positions.size())
        in_.fail_at(use->offset, std::string("the ") + whose + " refers to vertex " +
                                     std::to_string(std::uint64_t{use->largest} + 1) +
                                     ", but the file has " +
                                     std::to_string(mesh_.positions.size()));
  }

  void finish_colors() {
    auto& colors = mesh_.colors.values;
    if (colors.empty()) return;
    budget_.resize(colors, mesh_.positions.size(), kWhite);
    std::size_t bad = 0;
    for (Vec4& c : colors)
      for (float* x : {&c.x, &c.y, &c.z, &c.w})
        if (!std::isfinite(*x)) {
          *x = 1;
          ++bad;
        }
    if (bad != 0)
      say(std::to_string(bad) + " components of vertex colours are not finite; taken as 1");
    LargestChannels largest;
    largest.add(colors);
    const float unit = color_unit(largest.rgb, 1);
    if (unit == 1) return;
    scale_colors(colors, unit, color_unit(largest.alpha, 1));
    say(said_unit(largest.rgb, unit));
  }

  /// Drops an unreadable attribute of the whole mesh: a picture without it is right, one with
  /// arbitrary values is not.
  template <class T>
  bool usable(const Use& use, std::vector<std::uint32_t>& indices, const std::vector<T>& values,
              const char* what) {
    if (!use.any) return false;
    if (use.largest < values.size()) return true;
    scene_.warnings.push_back(
        name_ + ":" + std::to_string(in_.line_of(use.offset)) + ": the face refers to " + what +
        " " + std::to_string(std::uint64_t{use.largest} + 1) + ", but the file has " +
        std::to_string(values.size()) + "; it is drawn without any");
    indices.clear();
    return false;
  }

  void finish_texcoords() {
    if (!usable(texcoord_use_, texcoord_indices_, texcoords_, "texture coordinate")) return;
    const auto absent = std::count(texcoord_indices_.begin(), texcoord_indices_.end(), kMissing);
    if (absent != 0) {
      const auto zero = static_cast<std::uint32_t>(texcoords_.size());
      texcoords_.push_back({0, 0});
      std::replace(texcoord_indices_.begin(), texcoord_indices_.end(), kMissing, zero);
      say(std::to_string(absent) + " corners have no texture coordinate; taken as (0, 0)");
    }
    transform_texcoords();
    store(mesh_.texcoords, std::move(texcoords_), std::move(texcoord_indices_));
  }

  /// Gives separate coordinates to corners whose material transforms its textures.
  void transform_texcoords() {
    if (std::ranges::all_of(transforms_, [](const auto& t) { return t == TextureTransform{}; }))
      return;
    transforms_.resize(scene_.materials.size());
    std::unordered_map<std::uint64_t, std::uint32_t> moved;  // by material and coordinate
    for (std::size_t c = 0; c < texcoord_indices_.size(); ++c) {
      const std::uint32_t material =
          mesh_.face_materials.empty() ? mesh_.material : mesh_.face_materials[c / 3];
      const TextureTransform& t = transforms_[material];
      if (t == TextureTransform{}) continue;
      std::uint32_t& index = texcoord_indices_[c];
      const auto [at, is_new] = moved.try_emplace(std::uint64_t{material} << 32 | index,
                                                  static_cast<std::uint32_t>(texcoords_.size()));
      if (is_new) {
        const Vec2 uv{texcoords_[index].x, 1 - texcoords_[index].y};
        budget_.add(texcoords_,
                    {uv.x * t.scale.x + t.offset.x, 1 - (uv.y * t.scale.y + t.offset.y)});
      }
      index = at->second;
    }
  }

  void finish_normals() {
    if (!usable(normal_use_, normal_indices_, normals_, "normal")) return;
    std::size_t filled = 0;
    for (std::size_t t = 0; t < mesh_.indices.size(); t += 3) {
      std::uint32_t* const corner = &normal_indices_[t];
      if (corner[0] != kMissing && corner[1] != kMissing && corner[2] != kMissing) continue;
      const ArrayView<Vec3> positions = mesh_.view().positions;
      const auto edge = [&](std::size_t c) {
        const std::uint32_t from = mesh_.indices[t], to = mesh_.indices[t + c];
        return positions.is_wide() ? static_cast<Vec3>(positions.wide(to) - positions.wide(from))
                                   : positions[to] - positions[from];
      };
      const auto flat = static_cast<std::uint32_t>(normals_.size());
      budget_.add(normals_, normalize(cross(edge(1), edge(2))));
      for (int i = 0; i < 3; ++i)
        if (corner[i] == kMissing) corner[i] = flat;
      ++filled;
    }
    if (filled != 0)
      say(std::to_string(filled) + " triangles have no normals, others do; these get their face's");
    store(mesh_.normals, std::move(normals_), std::move(normal_indices_));
  }

  /// Corners that number an attribute as they number positions share those indices.
  template <class T>
  void store(Attribute<T>& attribute, std::vector<T> values, std::vector<std::uint32_t> indices) {
    attribute.values = std::move(values);
    if (indices != mesh_.indices || attribute.values.size() < mesh_.positions.size())
      attribute.indices = std::move(indices);
    else
      attribute.values.resize(mesh_.positions.size());
  }

  void say(const std::string& what) { scene_.warnings.push_back(name_ + ": " + what); }

  void warn_about_the_rest() {
    if (small_faces_ != 0)
      say(std::to_string(small_faces_) + " faces with fewer than 3 corners are left out");
    if (short_lines_ != 0)
      say(std::to_string(short_lines_) + " points and lines with too few vertices are left out");
    std::string kinds;
    int listed = 0;
    for (const auto& [kind, count] : ignored_) {
      if (++listed > 8) {
        kinds += ", …";
        break;
      }
      kinds += (kinds.empty() ? "" : ", ") + std::to_string(count) + " × " + printable(kind);
    }
    if (!kinds.empty()) say("statements that are not drawn: " + kinds);
    if (mesh_.indices.empty() && loose_.empty())
      say("holds no faces (" + std::to_string(mesh_.positions.size()) + " vertices)");
  }

  std::filesystem::path file_;
  std::string name_;
  Reading& files_;
  Budget& budget_;
  TextFile text_;
  TextCursor in_;
  std::size_t start_ = 0;  ///< offset of the statement being read
  Scene scene_;
  Mesh mesh_;
  std::vector<Vec2> texcoords_;
  std::vector<Vec3> normals_;
  std::vector<std::uint32_t> texcoord_indices_, normal_indices_;
  /// Points of one statement, or a polyline: corners [begin, begin + count) of loose_corners_.
  struct Loose {
    bool is_line;
    std::uint32_t material;
    std::size_t begin, count;
  };
  std::vector<Corner> face_;
  FacesToCut faces_to_cut_{budget_};
  std::vector<Loose> loose_;
  std::vector<std::uint32_t> loose_corners_;
  Use position_use_, texcoord_use_, normal_use_, loose_use_;
  std::vector<std::filesystem::path> libraries_;
  std::set<std::filesystem::path> known_libraries_;
  std::string renamed_libraries_;
  std::vector<std::string> used_names_;
  std::vector<TextureTransform> transforms_;                      ///< of materials
  std::unordered_map<std::string, std::uint32_t> by_name_;        ///< what .mtl files define
  std::unordered_map<std::string, std::uint32_t> has_materials_;  ///< what usemtl names
  std::vector<std::uint32_t> face_materials_;
  std::uint32_t material_ = 0;  ///< 0: no usemtl yet
  std::map<std::string, std::size_t> ignored_;
  std::size_t small_faces_ = 0, short_lines_ = 0;
  std::future<void> reading_;  ///< last: its destructor waits, before the others are gone
};

}  // namespace

Scene parse_obj(Bytes bytes, const std::filesystem::path& file, Reading& reading) {
  return ObjReader(bytes, file, reading).read();
}

}  // namespace rastrum::io
