// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/render/shadows.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include <rastrum/core/elementary.hpp>
#include <rastrum/render/seen_part.hpp>
#include <rastrum/scene/fit_ranks.hpp>
#include <rastrum/scene/vertices_in_use.hpp>

namespace rastrum {
namespace {

/// Texels around the needed part: a lookup moves three along the normal and reads two further.
constexpr double kBorder = 6;
/// Sizes are multiples of this, so that they seldom change.
constexpr int kGranule = 64;

Light in_world(Light light, const Camera& camera) {
  if (!light.of_camera) return light;
  light.of_camera = false;
  return placed(light, inverse(world_to_camera(camera)).value_or(Mat4d::identity()));
}

Vec3d across(Vec3 v) {
  return std::abs(v.x) < std::abs(v.y) ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
}

/// The projection of a light, with x and y on its plane at w = 1.
class Eye {
 public:
  Eye(const Light& light, const Box3d& box) : box_(box_of(box.min, box.max)) {
    Camera c;
    const auto* const spot = std::get_if<SpotLight>(&light.kind);
    const Vec3 d =
        spot != nullptr ? spot->direction : std::get<DirectionalLight>(light.kind).direction;
    c.eye = spot != nullptr ? spot->position : Vec3d{};
    c.target = c.eye + Vec3d(d);
    c.up = across(d);
    axes_ = world_to_camera(c);
    for (const Vec3d& p : box_.corners) {
      least_ = std::min(least_, ahead(p));
      most_ = std::max(most_, ahead(p));
    }
    if (spot == nullptr) return;
    reach_ = 0;
    for (const Vec3d& p : box_.corners) reach_ = std::max(reach_, length(p - c.eye));
    // A little wider than the cone.
    half_ = elementary::tan(static_cast<double>(spot->outer_rad) * 1.01 + 0.0025);
  }

  /// The window of the plane for the scene's part in `seen`; none if that is empty. `size`: most
  /// texels across. A texel's width is a power of two and texels lie on its multiples, so that a
  /// moving camera keeps them.
  struct View {
    Camera camera;
    int width = 0, height = 0;
    double texel = 0;  ///< where w is 1
  };
  [[nodiscard]] std::optional<View> view(const Hexahedron& seen, int size) const {
    const double inf = std::numeric_limits<double>::infinity();
    double low[2] = {inf, inf}, high[2] = {-inf, -inf};
    std::vector<Hexahedron> parts{box_, seen};
    if (is_spot()) parts.push_back(pyramid());
    for (const Vec3d& p : common_corners(parts)) {
      const double w = is_spot() ? ahead(p) : 1;
      for (int i = 0; i < 2; ++i) {
        low[i] = std::min(low[i], row(i, p) / w);
        high[i] = std::max(high[i], row(i, p) / w);
      }
    }
    const double widest = std::max(high[0] - low[0], high[1] - low[1]);
    if (!(widest >= 0 && widest < inf)) return std::nullopt;
    // Texels are wide enough for float64 to tell them apart.
    const double far_off = std::max({std::abs(low[0]), std::abs(low[1]), std::abs(high[0]),
                                     std::abs(high[1]), std::numeric_limits<double>::min()});
    int exponent = 0;
    (void)std::frexp(std::max(widest / (size - 2 * kBorder), far_off * 1e-12), &exponent);
    View v;
    v.texel = std::ldexp(1.0, exponent - 1);
    double first[2];
    int n[2];
    for (;; v.texel *= 2) {
      for (int i = 0; i < 2; ++i) {
        first[i] = std::floor(low[i] / v.texel) - kBorder;
        n[i] = static_cast<int>(std::ceil(high[i] / v.texel) + kBorder - first[i]);
      }
      if (std::max(n[0], n[1]) <= size) break;
    }
    for (int& count : n) count = std::min((count + kGranule - 1) / kGranule * kGranule, size);
    v.width = n[0];
    v.height = n[1];
    set_matrix(v, first);
    return v;
  }

 private:
  [[nodiscard]] bool is_spot() const { return half_ > 0; }
  [[nodiscard]] double row(int i, const Vec3d& p) const {
    return axes_.m[i][0] * p.x + axes_.m[i][1] * p.y + axes_.m[i][2] * p.z + axes_.m[i][3];
  }
  [[nodiscard]] double ahead(const Vec3d& p) const { return -row(2, p); }

  /// World to the clip space of a window of the plane. Depth is n / w for a spot, else linear.
  [[nodiscard]] Mat4d to_clip(const double (&middle)[2], const double (&half)[2],
                              double nearest) const {
    Mat4d m;
    for (int k = 0; k < 4; ++k) {
      const double w = is_spot() ? -axes_.m[2][k] : k == 3 ? 1 : 0;
      for (int i = 0; i < 2; ++i) m.m[i][k] = (axes_.m[i][k] - middle[i] * w) / half[i];
      m.m[3][k] = w;
      if (!is_spot()) m.m[2][k] = axes_.m[2][k] / (most_ - least_ + 2 * margin());
    }
    if (is_spot())
      m.m[2][3] = nearest;
    else
      m.m[2][3] += (most_ + margin()) / (most_ - least_ + 2 * margin());
    return m;
  }
  /// Keeps the scene off the near and far planes, however flat it is.
  [[nodiscard]] double margin() const {
    return 0.01 * (most_ - least_) + 1e-9 * std::max(std::abs(most_), std::abs(least_)) +
           std::numeric_limits<float>::min();
  }
  [[nodiscard]] Hexahedron pyramid() const {
    Camera c;
    c.matrix = to_clip({0, 0}, {half_, half_}, reach_ * kClosest);
    return frustum(c, reach_ * kClosest, reach_);
  }
  void set_matrix(View& v, const double (&first)[2]) const {
    const double half[2] = {v.width * v.texel / 2, v.height * v.texel / 2};
    const double middle[2] = {first[0] * v.texel + half[0], first[1] * v.texel + half[1]};
    double nearest = reach_ * kClosest;
    if (is_spot()) {
      // The nearest corner of the box in the window decides the near plane.
      v.camera.matrix = to_clip(middle, half, nearest);
      double least = reach_;
      const Hexahedron window = frustum(v.camera, nearest, reach_);
      for (const Vec3d& p : common_corners(std::vector{box_, window}))
        least = std::min(least, ahead(p));
      nearest = least > 2 * nearest ? 0.9 * least : reach_ * kInside;
    }
    v.camera.matrix = to_clip(middle, half, nearest);
  }

  /// A spot's near plane, in parts of its reach: at least kClosest outside the scene's box, and
  /// kInside inside, where triangles may pass it and a nearer one would cost digits of depth.
  static constexpr double kClosest = 1e-6, kInside = 1e-4;

  Hexahedron box_;
  Mat4d axes_;
  double least_ = std::numeric_limits<double>::infinity(), most_ = -least_;  ///< ahead()
  double reach_ = 0;  ///< of a spot: the distance of the box's farthest corner
  double half_ = 0;   ///< of a spot: half the width of its cone at w = 1
};

int size_for(const FrameOptions& frame, std::size_t pictures) {
  if (frame.shadow_size != 0) return frame.shadow_size;
  const auto across = static_cast<unsigned>(std::max(frame.width, frame.height));
  return std::clamp(static_cast<int>(std::bit_ceil(3 * across)), 256, pictures == 1 ? 2048 : 1024);
}

}  // namespace

bool has_shadow(const Light& light) {
  if (!light.casts_shadows) return false;
  constexpr float kWidest = 1.48F;  // nearly 85°
  const auto* const spot = std::get_if<SpotLight>(&light.kind);
  return spot != nullptr ? spot->outer_rad <= kWidest
                         : std::holds_alternative<DirectionalLight>(light.kind);
}

std::span<const raster::LightShadow> Shadows::draw(const SceneView& scene, const Camera& camera,
                                                   const FrameOptions& frame,
                                                   const DrawDepth& draw_depth,
                                                   ShadowRanks* ranks) {
  shadows_.clear();
  pictures_.clear();
  if (!frame.shadows || std::ranges::none_of(frame.lights, has_shadow)) return {};
  FrameOptions look;
  look.shader = Shader::flat;
  look.cull = frame.cull;
  look.transparency.method = Transparency::none;
  look.clip_planes = frame.clip_planes;
  std::optional<VerticesInUse> vertices;
  const Box3d box = extent_of(scene, ranks, vertices);
  vertices.reset();
  std::vector<Hexahedron> slices;
  if (!box.empty())
    slices =
        seen_slices(box.min, box.max, camera, frame.width, frame.height, frame.shadow_distance);
  const int size = size_for(frame, slices.size());
  pictures_.reserve(slices.size() * frame.lights.size());  // shadows point to them
  for (const Light& light : frame.lights) {
    const std::size_t first = pictures_.size();
    std::optional<Eye> eye;
    if (has_shadow(light) && !slices.empty()) eye.emplace(in_world(light, camera), box);
    for (std::size_t i = 0; eye && i < slices.size(); ++i) {
      const std::optional<Eye::View> view = eye->view(slices[i], size);
      if (!view) continue;
      look.width = view->width;
      look.height = view->height;
      ImageView<float> depth;
      own_work(ranks, [&] {
        const std::size_t picture = pictures_.size();
        if (picture == depths_.size()) depths_.emplace_back(account_);
        depths_[picture].reserve(static_cast<std::size_t>(view->width) *
                                 static_cast<std::size_t>(view->height));
        depth = {depths_[picture].data(), view->width, view->height};
        draw_depth(view->camera, look, depth);
      });
      if (ranks != nullptr) ranks->meet(depth);
      pictures_.push_back({depth, *view->camera.matrix, view->texel});
    }
    shadows_.push_back(std::span(pictures_).subspan(first));
  }
  return shadows_;
}

std::uint64_t Shadows::bytes() const {
  std::uint64_t sum = 0;
  for (const ScratchBuffer<float>& depth : depths_) sum += depth.capacity() * sizeof(float);
  return sum;
}

}  // namespace rastrum
