// SPDX-License-Identifier: BSD-3-Clause
// OFF (Geomview): vertices with normals (N), colours (C), texture coordinates (ST); polygons are
// cut. '#' starts a comment. Many files lack the word "OFF", glue it to the first count, or have
// colours without the C. After a face's corners may come its colour: three or four numbers, or an
// index into a list.
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/color_map.hpp>
#include <rastrum/io/colors.hpp>
#include <rastrum/io/faces_to_cut.hpp>
#include <rastrum/io/mapped_file.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/text_cursor.hpp>
#include <rastrum/io/wide_positions.hpp>

namespace rastrum::io {
namespace {

/// Replaces the list that colour indices refer to, which Geomview has and files have not.
constexpr const char* kNumberedColors = "tab20";

/// The unit of colours, which all of a file's vertices, or all its faces, decide.
class ColorUnit {
 public:
  /// `text`: the number as written.
  void add(float x, std::string_view text) {
    if (std::isfinite(x)) largest_ = std::max(largest_, x);
    if (text.find_first_of(".eE") != std::string_view::npos) whole_ = false;
  }
  /// Whole numbers are parts of 255 or 65,535, unless none is above 1.
  [[nodiscard]] float unit() const {
    return color_unit(largest_, whole_ && largest_ > 1 ? 65535 : 1);
  }
  /// A warning for a unit that is unusual in the format; empty: none.
  [[nodiscard]] std::string said() const {
    const float usual = whole_ ? 255 : 1;
    return largest_ == 0 || unit() == usual ? std::string() : said_unit(largest_, unit());
  }

 private:
  float largest_ = 0;
  bool whole_ = true;
};

class OffReader {
 public:
  OffReader(Bytes bytes, const std::string& name, Budget& budget)
      : name_(name), budget_(budget), text_(as_text(bytes), name_), in_(text_.cursor()) {}

  Scene read() {
    header();
    counts();
    const TextCursor first = in_;
    vertices();
    if (lie_far(mesh_.positions)) {
      const TextCursor behind = std::exchange(in_, first);
      std::vector<Vec3d> wide;
      budget_.resize(wide, vertex_count_);
      for (Vec3d& p : wide) {
        p = {next<double>("x"), next<double>("y"), next<double>("z")};
        while (!line_is_done()) (void)next<float>("a number");
      }
      in_ = behind;
      set_positions(mesh_, std::move(wide), budget_);
    }
    faces();
    finish_colors();
    if (left_out_ != 0)
      say("numbers behind the coordinates of " + std::to_string(left_out_) +
          " vertices are left out");
    if (small_faces_ != 0)
      say(std::to_string(small_faces_) + " faces with fewer than 3 corners are left out");
    if (mesh_.indices.empty())
      say("holds no faces (" + std::to_string(mesh_.positions.size()) + " vertices)");
    Scene scene = scene_of(std::move(mesh_));
    scene.warnings = std::move(warnings_);
    return scene;
  }

 private:
  void say(const std::string& what) {
    if (!what.empty()) warnings_.push_back(name_ + ": " + what);
  }

  /// Skips blanks and comments; with `across_lines` ends of lines, too.
  void skip(bool across_lines) {
    for (;;) {
      across_lines ? in_.skip_space() : in_.skip_blanks();
      if (in_.at_end() || in_.peek() != '#') return;
      if (!across_lines) {
        while (!in_.at_end() && in_.peek() != '\n') in_.advance(1);
        return;
      }
      in_.skip_line();
    }
  }

  [[nodiscard]] bool line_is_done() {
    skip(false);
    return in_.at_line_end();
  }

  template <class T>
  T next(const char* what) {
    skip(true);
    const T value = in_.number<T>(what);
    const char after = in_.peek();
    if (!TextCursor::is_space(after) && after != '#' && !in_.at_end())
      in_.fail(std::string("expected ") + what + " and a space");
    return value;
  }

  void header() {
    skip(true);
    const std::size_t start = in_.offset();
    TextCursor ahead = in_;
    std::string_view word = ahead.token();
    const auto has = [&](std::string_view prefix) {
      if (word.substr(0, prefix.size()) != prefix) return false;
      word.remove_prefix(prefix.size());
      in_.advance(prefix.size());
      return true;
    };
    if (word.find("OFF") == std::string_view::npos) {
      if (word.empty() || word[0] < '0' || word[0] > '9')
        throw Error(Errc::bad_format, name_ + ": is not OFF: no 'OFF' and no counts at its start");
      return;
    }
    texcoords_ = has("ST");
    colors_ = has("C");
    normals_ = has("N");
    if (has("4") || has("n"))
      throw Error(Errc::unsupported, name_ + ": its vertices are not three-dimensional");
    if (!has("OFF")) in_.fail_at(start, "expected [ST][C][N]OFF");
    if (!line_is_done() && ahead.token() == "BINARY")
      throw Error(Errc::unsupported, name_ + ": binary OFF is not read; convert it to PLY");
  }

  void counts() {
    vertex_count_ = next<std::uint32_t>("the number of vertices");
    face_count_ = next<std::uint32_t>("the number of faces");
    if (!line_is_done()) (void)next<std::int64_t>("the number of edges");
    // "0 0 0" is 6 characters, "3 0 0 0" 8; the last line may lack its end.
    const std::size_t left = in_.left() + 1;
    if (vertex_count_ > left / 6 || face_count_ > left / 2)
      in_.fail("the file is too short for " + std::to_string(vertex_count_) + " vertices and " +
               std::to_string(face_count_) + " faces");
  }

  void vertices() {
    budget_.reserve(mesh_.positions, vertex_count_);
    for (std::uint32_t i = 0; i < vertex_count_; ++i) {
      mesh_.positions.push_back(vec3("a coordinate"));
      if (normals_) budget_.add(mesh_.normals.values, vec3("a normal's component"));
      float rest[6];
      std::string_view words[6];
      int n = 0;
      for (; n < 6 && !line_is_done(); ++n) {
        const std::size_t start = in_.offset();
        rest[n] = next<float>("a number");
        words[n] = in_.text().substr(start, in_.offset() - start);
      }
      finish_vertex(i, rest, words, n);
      while (!line_is_done()) (void)next<float>("a number");
    }
  }

  void finish_vertex(std::uint32_t i, float* rest, const std::string_view* words, int n) {
    const int uv = texcoords_ ? 2 : 0;
    if (texcoords_) {
      if (n < 2) in_.fail("the vertex has no texture coordinate");
      budget_.add(mesh_.texcoords.values, {rest[n - 2], 1 - rest[n - 1]});
    }
    const int c = n - uv;
    if (colors_ || (i == 0 && (c == 3 || c == 4))) {
      if (c != 3 && c != 4) in_.fail("the vertex has no colour");
      colors_ = true;
      budget_.add(mesh_.colors.values, color(rest, words, c, vertex_unit_));
    } else if (c != 0) {
      ++left_out_;
    }
  }

  /// Mark colours without an alpha, and colours that are an index into a list. Alphas of files are
  /// finite.
  static constexpr float kNoAlpha = std::numeric_limits<float>::infinity();
  static constexpr float kNumbered = -kNoAlpha;

  static Vec4 color(float* numbers, const std::string_view* words, int n, ColorUnit& unit) {
    for (int k = 0; k < n; ++k) {
      if (!std::isfinite(numbers[k])) numbers[k] = 0;
      unit.add(numbers[k], words[k]);
    }
    return {numbers[0], numbers[1], numbers[2], n == 4 ? numbers[3] : kNoAlpha};
  }
  static void finish(std::vector<Vec4>& colors, float unit) {
    const std::vector<Vec4> listed = color_map(kNumberedColors).colors;
    const float scale = 1 / unit;
    for (Vec4& c : colors)
      if (c.w == kNumbered)
        c = listed[static_cast<std::size_t>(c.x) % listed.size()];
      else
        c = {c.x * scale, c.y * scale, c.z * scale, c.w == kNoAlpha ? 1 : c.w * scale};
  }

  Vec3 vec3(const char* what) { return {next<float>(what), next<float>(what), next<float>(what)}; }

  std::uint32_t corner() {
    const auto i = next<std::int64_t>("a vertex index");
    if (i < 0 || i >= vertex_count_)
      in_.fail("the face refers to vertex " + std::to_string(i) + ", but the file has " +
               std::to_string(vertex_count_));
    return static_cast<std::uint32_t>(i);
  }

  void faces() {
    for (std::uint32_t f = 0; f < face_count_; ++f) {
      const auto n = next<std::uint32_t>("the number of a face's corners");
      face_.clear();
      for (std::uint32_t k = 0; k < n; ++k) budget_.add(face_, corner());
      if (n < 3) ++small_faces_;
      faces_to_cut_.add(
          n, mesh_.positions, mesh_.indices.size(), [&](std::size_t i) { return face_[i]; },
          [&](std::size_t a, std::size_t b, std::size_t c) {
            for (const std::size_t k : {a, b, c}) budget_.add(mesh_.indices, face_[k]);
          });
      face_color();
      in_.skip_line();
    }
  }

  void face_color() {
    const std::size_t triangles = mesh_.indices.size() / 3;
    float numbers[5];
    std::string_view words[5];
    int n = 0;
    for (; n < 5 && !line_is_done(); ++n) {
      const std::size_t start = in_.offset();
      const auto x = in_.optional_word<float>();
      numbers[n] = x.value_or(-1);
      words[n] = in_.text().substr(start, in_.offset() - start);
      if (!x) n = 5;  // no colour
    }
    if (n == 3 || n == 4) {
      face_colors_.add(color(numbers, words, n, face_unit_), triangles);
    } else if (n == 1 && numbers[0] >= 0 && numbers[0] < 65536) {
      ++numbered_;
      face_colors_.add({numbers[0], 0, 0, kNumbered}, triangles);
    } else {
      if (n != 0) ++strange_colors_;
      face_colors_.add_none(triangles);
    }
  }

  void finish_colors() {
    finish(mesh_.colors.values, vertex_unit_.unit());
    say(vertex_unit_.said());
    if (strange_colors_ != 0)
      say("the colours of " + std::to_string(strange_colors_) +
          " faces are left out: they are neither 3 or 4 numbers nor one");
    if (face_colors_.values().empty()) return;
    if (!mesh_.colors.empty()) return say("the colours of faces are left out: vertices have some");
    if (numbered_ != 0)
      say("the colours of " + std::to_string(numbered_) +
          " faces are indices into a list that the file does not have; they are taken from " +
          kNumberedColors);
    say(face_unit_.said());
    finish(face_colors_.values(), face_unit_.unit());
    mesh_.colors = face_colors_.take();
  }

  std::string name_;
  Budget& budget_;
  TextFile text_;
  TextCursor in_;
  Mesh mesh_;
  ColorUnit vertex_unit_, face_unit_;
  FaceColors face_colors_{budget_};
  std::vector<std::string> warnings_;
  std::vector<std::uint32_t> face_;
  FacesToCut faces_to_cut_{budget_};
  bool texcoords_ = false, colors_ = false, normals_ = false;
  std::uint32_t vertex_count_ = 0, face_count_ = 0;
  std::size_t small_faces_ = 0, numbered_ = 0, strange_colors_ = 0, left_out_ = 0;
};

}  // namespace

Scene parse_off(Bytes bytes, const std::filesystem::path& file, Reading& reading) {
  Scene scene = OffReader(bytes, file.string(), reading.budget).read();
  scene.meshes[0].name = file.stem().string();
  return scene;
}

}  // namespace rastrum::io
