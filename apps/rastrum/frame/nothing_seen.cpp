// SPDX-License-Identifier: BSD-3-Clause
// The statistics count what was culled, not why. So the triangles are tested again one by one, with
// the camera's planes. That takes no more than the frame did, and only happens if it was empty.
#include "nothing_seen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <rastrum/raster/rules/clip.hpp>

namespace rastrum::cli {
namespace {

using raster::Vec4d;

enum Fate : std::size_t {
  not_finite,
  no_area,
  behind,
  before_near,
  outside,
  culled,
  single_sided,
  edge_on,
  thin,
  small,
  between,
  cut_away,
  kFates,
};

struct Phrases {
  const char *one, *all;  ///< as in "one lies", "all lie"
  const char* remedy;
};
constexpr Phrases kPhrases[kFates] = {
    {"has a NaN or infinite vertex", "have a NaN or infinite vertex", "the file is damaged"},
    {"has no area", "have no area", "`rastrum info` tells what a file holds"},
    {"lies behind the camera", "lie behind the camera",
     "--fit instead of --eye, --target and --camera shows all of it"},
    {"lies in front of the near plane", "lie in front of the near plane",
     "leave out --near, or give a smaller one"},
    {"lies outside of the view", "lie outside of the view",
     "--fit instead of --eye, --target and --camera shows all of it"},
    {"faces the side that --cull leaves out", "face the side that --cull leaves out",
     "--cull none shows them"},
    {"shows the back of a single-sided material", "show the back of a single-sided material",
     "--shader phong shows them, or an --eye on the other side"},
    {"is seen edge-on", "are seen edge-on", ""},
    {"is thinner than a pixel", "are thinner than a pixel",
     "bring --eye nearer, or give a larger --size, or --samples 16"},
    {"is smaller than a pixel", "are smaller than a pixel",
     "bring --eye nearer, use --fit, or give a larger --size"},
    {"falls between the pixels' centres", "fall between the pixels' centres",
     "give a larger --size, or --samples 16"},
    {"lies behind a --clip-plane", "lie behind a --clip-plane",
     "the plane X,Y,Z,D keeps where X x + Y y + Z z + D >= 0: change all signs for the other side"},
};

Vec3d twice_area(const Vec3 (&p)[3]) {
  return cross(Vec3d(p[1]) - Vec3d(p[0]), Vec3d(p[2]) - Vec3d(p[0]));
}

/// The least height divided by the longest side: at most 0.87, if equilateral.
double slenderness(const Vec3 (&p)[3]) {
  double longest = 0;
  for (int i = 0; i < 3; ++i)
    longest = std::max(longest, length(Vec3d(p[(i + 1) % 3]) - Vec3d(p[i])));
  return length(twice_area(p)) / (longest * longest);
}

/// Triangles of one instance, seen by one camera.
struct Eye {
  Mat4d object_to_clip;
  double width, height;
  bool is_perspective;
  Cull cull;           ///< --cull in terms of the screen (cull_on_screen)
  Cull material_cull;  ///< for a single-sided material

  [[nodiscard]] Fate fate(const Vec3 (&p)[3]) const {
    Vec4d c[3];
    for (int i = 0; i < 3; ++i) {
      c[i] = raster::transform_point(object_to_clip, Vec3d(p[i]));
      if (!std::isfinite(c[i].x + c[i].y + c[i].z + c[i].w)) return not_finite;
    }
    if (twice_area(p) == Vec3d{}) return no_area;
    const auto all = [&](auto&& is) { return is(c[0]) && is(c[1]) && is(c[2]); };
    if (is_perspective && all([](const Vec4d& v) { return v.w <= 0; })) return behind;
    if (all([](const Vec4d& v) { return v.x < -v.w; }) ||
        all([](const Vec4d& v) { return v.x > v.w; }) ||
        all([](const Vec4d& v) { return v.y < -v.w; }) ||
        all([](const Vec4d& v) { return v.y > v.w; }))
      return outside;
    if (all([](const Vec4d& v) { return v.z > v.w; })) return before_near;
    const double facing = raster::orientation(c);
    const auto leaves_out = [&](Cull side) {
      return (side == Cull::back && facing < 0) || (side == Cull::front && facing > 0);
    };
    if (cull != Cull::none ? leaves_out(cull) : leaves_out(material_cull))
      return cull != Cull::none ? culled : single_sided;
    // Cut by the near plane, and the rest is not in the view.
    if (!all([](const Vec4d& v) { return v.w > 0 && v.z <= v.w; })) return outside;
    return fate_on_screen(c, slenderness(p));
  }

 private:
  [[nodiscard]] Fate fate_on_screen(const Vec4d (&c)[3], double slenderness) const {
    double x[3], y[3];
    for (int i = 0; i < 3; ++i) {
      x[i] = (c[i].x / c[i].w + 1) / 2 * width;
      y[i] = (1 - c[i].y / c[i].w) / 2 * height;
    }
    const auto [left, right] = std::minmax({x[0], x[1], x[2]});
    const auto [top, bottom] = std::minmax({y[0], y[1], y[2]});
    const double wide = right - left, high = bottom - top;
    if (right < 0 || left > width || bottom < 0 || top > height) return outside;
    if (wide < 1 && high < 1) return small;
    // Narrower than a hundredth of a pixel everywhere, so no picture size would show it. If it were
    // narrower than a pixel even from its front, its shape is the reason, else the view.
    constexpr double kEdge = 0.01;
    const double twice_area =
        std::abs((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]));
    if (twice_area >= kEdge * std::max(wide, high)) return between;
    return slenderness * std::max(wide, high) < 1 ? thin : edge_on;
  }
};

bool is_cut_away(const FrameOptions& options, const Mat4d& to_world, const Vec3 (&corners)[3]) {
  return std::ranges::any_of(options.clip_planes, [&](const ClipPlane& plane) {
    return std::ranges::all_of(corners, [&](Vec3 p) {
      const Vec4d world = raster::transform_point(to_world, Vec3d(p));
      return plane.normal.x * world.x + plane.normal.y * world.y + plane.normal.z * world.z +
                 plane.offset <
             0;
    });
  });
}

std::array<std::uint64_t, kFates> census(const FrameOptions& options, const SceneView& scene,
                                         const Camera& camera) {
  std::array<std::uint64_t, kFates> counts{};
  const Mat4d world_to_view = world_to_clip(camera, options.width, options.height);
  const Shader shader = shader_for(options.shader, scene);
  for (const InstanceView& instance : scene.instances) {
    if (instance.mesh() == nullptr) continue;
    const MeshView& mesh = *instance.mesh();
    const Eye eye{world_to_view * instance.object_to_world,
                  static_cast<double>(options.width),
                  static_cast<double>(options.height),
                  !camera.orthographic,
                  cull_on_screen(instance, options.cull),
                  cull_on_screen(instance, material_cull(instance, scene.materials, shader))};
    constexpr std::size_t kSome = 1 << 16;  // many, because a large polygon is cut again each time
    std::vector<std::uint32_t> vertices(3 * std::min(kSome, mesh.triangle_count()));
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      if (t % kSome == 0)
        mesh.read_triangles(t, std::min(kSome, mesh.triangle_count() - t), vertices.data());
      const std::uint32_t* const v = vertices.data() + t % kSome * 3;
      const Vec3 corners[3] = {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
      const bool away = is_cut_away(options, instance.object_to_world, corners);
      ++counts[away ? cut_away : eye.fate({corners[0], corners[1], corners[2]})];
    }
  }
  return counts;
}

/// A place from which an edge-on surface is visible.
std::string look_from_elsewhere(const SceneView& scene) {
  const Bounds box = bounds(scene);
  const Vec3d centre = (box.min + box.max) * 0.5;
  const double r = length(box.max - box.min);
  char text[120];
  std::snprintf(text, sizeof text, "look from elsewhere, as with --eye %.4g,%.4g,%.4g",
                centre.x + 0.4 * r, centre.y + 0.6 * r, centre.z + 0.8 * r);
  return text;
}

}  // namespace

bool is_empty(const FrameStats& frame, const FrameOptions& options) {
  return frame.pixels_covered == 0 || (options.opacity == 0 && options.shader != Shader::depth);
}

Emptiness why_empty(const FrameStats& frame, const FrameOptions& options, const SceneView& scene,
                    const Camera& camera) {
  if (frame.triangles.input == 0)
    return {"there are no triangles to draw", "`rastrum info` tells what a file holds"};
  if (frame.pixels_covered != 0)
    return {"--opacity 0 makes all of it transparent", "give a larger one"};
  if (frame.fragments != 0 && !options.clip_planes.empty())
    return {"what is in view lies behind a --clip-plane", kPhrases[cut_away].remedy};
  if (frame.fragments != 0)
    return {"the alpha of its materials (MASK) cuts all of it out",
            "the file's alphaCutoff and textures decide that; --heatmap shows where it is"};

  const std::array<std::uint64_t, kFates> counts = census(options, scene, camera);
  std::vector<Fate> order;
  for (std::size_t f = 0; f < kFates; ++f)
    if (counts[f] != 0) order.push_back(static_cast<Fate>(f));
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](Fate f) { return counts[f]; });
  if (order.empty())  // points, lines and exact surfaces are not tested
    return {"nothing of it lies in the view and faces the camera", "--fit shows all"};
  const std::uint64_t input = frame.triangles.input;
  Emptiness why;
  if (order.size() == 1 && input == 1)
    why.reason = std::string("the one triangle ") + kPhrases[order[0]].one;
  else if (order.size() == 1)
    why.reason = "all " + std::to_string(input) + " triangles " + kPhrases[order[0]].all;
  else
    why.reason = "of " + std::to_string(input) + " triangles";
  for (std::size_t i = 0; order.size() > 1 && i < order.size(); ++i)
    why.reason += (i == 0 ? " " : ", ") + std::to_string(counts[order[i]]) + " " +
                  (counts[order[i]] == 1 ? kPhrases[order[i]].one : kPhrases[order[i]].all);
  why.remedy = order[0] == edge_on ? look_from_elsewhere(scene) : kPhrases[order[0]].remedy;
  return why;
}

}  // namespace rastrum::cli
