// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/number_text.hpp>

namespace rastrum::io {
namespace {

/// At most this many lines per kind: a file may have 10⁵ meshes.
constexpr std::size_t kMostLines = 40;

/// As printf's %g and %.Ng, whatever the locale.
template <class... Numbers>
std::string format(std::string_view pattern, Numbers... numbers) {
  std::string text;
  for (const double x : {static_cast<double>(numbers)...}) {
    const std::size_t at = pattern.find('%'), end = pattern.find('g', at);
    text += pattern.substr(0, at);
    text += number_text(x, pattern[at + 1] == '.' ? pattern[at + 2] - '0' : 6);
    pattern.remove_prefix(end + 1);
  }
  return text.append(pattern);
}

/// 1234567 as 1,234,567.
std::string grouped(std::uint64_t n) {
  std::string s = std::to_string(n);
  for (std::size_t i = s.size(); i > 3; i -= 3) s.insert(i - 3, 1, ',');
  return s;
}

std::string counted(std::uint64_t n, const char* what) {
  return grouped(n) + ' ' + what +
         (n == 1                                                  ? ""
          : what[std::char_traits<char>::length(what) - 1] == 'h' ? "es"
                                                                  : "s");
}

std::string named(const std::string& name) {
  return name.empty() ? "(no name)" : name.substr(0, 60);
}

/// The corners of a box, in six digits, or more if it is far from 0 for its size.
std::string box_text(Vec3d a, Vec3d b) {
  double size = 0, away = 0;
  for (const auto& [low, high] : {std::pair(a.x, b.x), {a.y, b.y}, {a.z, b.z}}) {
    size = std::max(size, high - low);
    away = std::max({away, std::abs(low), std::abs(high)});
  }
  int digits = 6;
  for (; digits < 15 && size > 0 && away > 10 * size; away /= 10) ++digits;
  const auto corner = [&](Vec3d p) {
    return '(' + number_text(p.x, digits) + ", " + number_text(p.y, digits) + ", " +
           number_text(p.z, digits) + ')';
  };
  return corner(a) + " to " + corner(b);
}

struct Faults {
  std::uint64_t not_finite = 0, no_area = 0;
};

Faults faults(const Mesh& mesh) {
  Faults f;
  const MeshView v = mesh.view();
  check_indices(v);
  for (std::size_t t = 0; t < v.triangle_count(); ++t) {
    Vec3d p[3];
    bool finite = true;
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = v.positions.wide(v.vertex(3 * t + c));
      finite = finite && is_finite(v.positions[v.vertex(3 * t + c)]);
    }
    if (!finite) {
      ++f.not_finite;
      continue;
    }
    // In float64, where the differences and products of usual meshes do not vanish.
    const Vec3d a = p[1] - p[0], b = p[2] - p[0];
    if (a.y * b.z == a.z * b.y && a.z * b.x == a.x * b.z && a.x * b.y == a.y * b.x) ++f.no_area;
  }
  return f;
}

/// Calls line(i) for each of `count` things. more(n) names the n that are too many.
template <class Line, class More>
void describe_each(std::size_t count, std::string& text, const Line& line, const More& more) {
  for (std::size_t i = 0; i < std::min(count, kMostLines); ++i) line(i);
  if (count > kMostLines) text += "  … and " + more(count - kMostLines) + '\n';
}
auto more_of(const char* what) {
  return [what](std::size_t n) { return counted(n, what) + " more"; };
}

void describe_meshes(const Scene& scene, std::string& text) {
  std::vector<std::uint64_t> uses(scene.meshes.size());
  for (const Instance& i : scene.instances)
    if (!i.geometry) ++uses[i.mesh];
  const auto line = [&](std::size_t i) {
    const Mesh& m = scene.meshes[i];
    text += "  mesh " + std::to_string(i) + " " + named(m.name) + ": " +
            counted(m.triangle_count(), "triangle") + ", " + grouped(m.positions.size()) +
            (m.positions.size() == 1 ? " vertex" : " vertices");
    if (uses[i] != 1) text += ", " + counted(uses[i], "instance");
    if (!m.normals.empty()) text += ", normals";
    if (!m.texcoords.empty()) text += ", texture coordinates";
    if (!m.colors.empty()) text += ", colours";
    text += '\n';
  };
  describe_each(scene.meshes.size(), text, line, more_of("mesh"));
}

struct Line {
  std::size_t number;
  std::string operator()(const Points& p) const {
    return begin("points", p.name) + counted(p.positions.size(), "point") +
           has(p.normals.size(), "normals") + has(p.colors.size(), "colours");
  }
  std::string operator()(const Lines& l) const { return line("lines", l, "segment"); }
  std::string operator()(const Spheres& s) const { return line("spheres", s, "sphere"); }
  std::string operator()(const Cylinders& c) const { return line("cylinders", c, "cylinder"); }
  std::string operator()(const Tubes& t) const { return line("tubes", t, "segment"); }
  std::string operator()(const Discs& d) const { return line("discs", d, "disc"); }
  template <class Geometry>
  [[nodiscard]] std::string line(const char* kind, const Geometry& g, const char* one) const {
    return begin(kind, g.name) + counted(g.view().size(), one) + has(g.colors.size(), "colours");
  }
  [[nodiscard]] std::string begin(const char* kind, const std::string& name) const {
    return std::string("  ") + kind + " " + std::to_string(number) + " " + named(name) + ": ";
  }
  static std::string has(std::size_t values, const char* what) {
    return values == 0 ? std::string() : std::string(", ") + what;
  }
};

void describe_geometries(const Scene& scene, std::string& text) {
  describe_each(
      scene.geometries.size(), text,
      [&](std::size_t i) { text += std::visit(Line{i}, scene.geometries[i]) + '\n'; },
      [](std::size_t n) { return std::to_string(n) + " more geometries"; });
}

void describe_scalars(const Scene& scene, std::string& text) {
  const std::vector<ScalarSummary> all = scalar_summaries(scene);
  const auto line = [&](std::size_t i) {
    const ScalarSummary& s = all[i];
    text += "  scalars " + named(s.name) + ": " + counted(s.values, "value") +
            format(", %.6g to %.6g", s.range.low, s.range.high);
    if (s.nan != 0) text += ", " + grouped(s.nan) + " not finite";
    text += '\n';
  };
  describe_each(all.size(), text, line,
                [](std::size_t n) { return std::to_string(n) + " more scalars"; });
}

void describe_materials(const Scene& scene, std::string& text) {
  static constexpr const char* kModes[] = {"opaque", "mask", "blend"};
  const auto material = [&](std::size_t i) {
    const Material& m = scene.materials[i];
    check_enum(m.alpha_mode, AlphaMode::blend,
               "material " + std::to_string(i) + ": its alpha mode");
    text += "  material " + std::to_string(i) + " " + named(m.name) + ": " +
            format("base colour (%.3g, %.3g, %.3g, %.3g), metallic %.3g, roughness %.3g, ",
                   static_cast<double>(m.base_color.x), static_cast<double>(m.base_color.y),
                   static_cast<double>(m.base_color.z), static_cast<double>(m.base_color.w),
                   static_cast<double>(m.metallic), static_cast<double>(m.roughness)) +
            kModes[static_cast<std::size_t>(m.alpha_mode)];
    if (m.unlit) text += ", unlit";
    if (m.double_sided) text += ", double-sided";
    if (m.base_color_texture != kNoTexture)
      text += ", base colour from texture " + std::to_string(m.base_color_texture);
    text += '\n';
  };
  const auto texture = [&](std::size_t i) {
    const Texture& t = scene.textures[i];
    text += "  texture " + std::to_string(i) + " " + named(t.name) + ": " +
            std::to_string(t.image.width()) + "x" + std::to_string(t.image.height()) + '\n';
  };
  describe_each(scene.materials.size(), text, material, more_of("material"));
  describe_each(scene.textures.size(), text, texture, more_of("texture"));
}

void describe_cameras(const Scene& scene, std::string& text) {
  for (std::size_t i = 0; i < std::min(scene.cameras.size(), kMostLines); ++i) {
    const Camera& c = scene.cameras[i];
    text += "  camera " + std::to_string(i) + ": eye " +
            format("(%g, %g, %g), target (%g, %g, %g), ", c.eye.x, c.eye.y, c.eye.z, c.target.x,
                   c.target.y, c.target.z) +
            (c.orthographic
                 ? format("orthographic, height %g", static_cast<double>(c.orthographic_height))
                 : format("field of view %g°",
                          static_cast<double>(c.fov_rad) * 180 / std::numbers::pi)) +
            '\n';
  }
}

void describe_lights(const Scene& scene, std::string& text) {
  constexpr const char* kKinds[] = {"ambient", "hemisphere", "directional", "point", "spot"};
  for (std::size_t i = 0; i < std::min(scene.lights.size(), kMostLines); ++i) {
    const Light& l = scene.lights[i];
    text += "  light " + std::to_string(i) + ": " + kKinds[l.kind.index()] +
            format(", intensity %g, colour (%g, %g, %g)\n", static_cast<double>(l.intensity),
                   static_cast<double>(l.color.x), static_cast<double>(l.color.y),
                   static_cast<double>(l.color.z));
  }
}

void describe_animations(const Scene& scene, std::string& text) {
  for (const Motion& motion : scene.motions)
    for (std::size_t i = 0; i < std::min(motion.animations.size(), kMostLines); ++i)
      text += "  animation " + std::to_string(i) + " " + named(motion.animations[i].name) + ": " +
              format("%g s", motion.animations[i].duration_s) + '\n';
}

}  // namespace

std::string describe(const Scene& scene) {
  const FloatScope floats;
  const SceneBinding binding(scene);  // checks that instances have meshes or geometries
  std::vector<Faults> by_mesh;
  for (const Mesh& m : scene.meshes) by_mesh.push_back(faults(m));
  Faults all;
  std::uint64_t points = 0, segments = 0, surfaces = 0;
  for (const Instance& i : scene.instances) {
    if (i.geometry) {
      const Geometry& g = scene.geometries[*i.geometry];
      const GeometryView shape = view(g);
      const std::uint64_t count = primitive_count(shape);
      (std::holds_alternative<Points>(g)  ? points
       : std::holds_alternative<Lines>(g) ? segments
                                          : surfaces) += count;
      continue;
    }
    all.not_finite += by_mesh[i.mesh].not_finite;
    all.no_area += by_mesh[i.mesh].no_area;
  }
  std::string text = counted(scene.triangle_count(), "triangle") +
                     (points != 0 ? ", " + counted(points, "point") : "") +
                     (segments != 0 ? ", " + counted(segments, "line segment") : "") +
                     (surfaces != 0 ? ", " + counted(surfaces, "exact surface") : "") + " in " +
                     counted(scene.instances.size(), "instance") + " of " +
                     counted(scene.meshes.size(), "mesh") + ", " +
                     counted(scene.materials.size(), "material") + ", " +
                     counted(scene.textures.size(), "texture") + ", " +
                     counted(scene.cameras.size(), "camera") + '\n';
  const Bounds b = bounds(binding.view());
  if (b.vertices_in_use == 0)
    text += "  bounds: none\n";
  else
    text += "  bounds: " + box_text(b.min, b.max) + ", " + grouped(b.vertices_in_use) +
            " vertices in use\n";
  if (all.not_finite != 0)
    text +=
        "  dropped: " + counted(all.not_finite, "triangle") + " with a vertex that is not finite\n";
  if (all.no_area != 0) text += "  without area: " + counted(all.no_area, "triangle") + '\n';
  describe_meshes(scene, text);
  describe_geometries(scene, text);
  describe_scalars(scene, text);
  describe_materials(scene, text);
  describe_cameras(scene, text);
  describe_lights(scene, text);
  describe_animations(scene, text);
  for (const std::string& w : scene.warnings) text += "  warning: " + w + '\n';
  return text;
}

}  // namespace rastrum::io
