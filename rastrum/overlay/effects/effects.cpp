// Eye-dome lighting, silhouettes and what calls the kernels, row by row. A pixel's result depends
// on no other's, so threads and their rows change nothing.
#include <rastrum/effects.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/core/angle.hpp>
#include <rastrum/error.hpp>
#include <rastrum/overlay/effects/darken.hpp>
#include <rastrum/overlay/effects/edges.hpp>
#include <rastrum/overlay/effects/lens.hpp>
#include <rastrum/overlay/effects/occlusion.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/parallel/exec.hpp>

namespace rastrum {

struct Effects::Impl {
  parallel::Threads threads;
  Isa isa;
  std::vector<float> scratch;

  Impl(int count, std::optional<Isa> wanted) : threads(count), isa(choose_isa(wanted)) {}

  template <class Row>
  void for_each_row(int height, Row&& row) {
    parallel::for_each_index(
        threads, static_cast<std::size_t>(height), [&](std::size_t y) { row(static_cast<int>(y)); },
        8);
  }
  ImageView<float> image(int width, int height) {
    scratch.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return {scratch.data(), width, height};
  }
};

namespace {

void check(const Surface& surface, ImageView<float> factor) {
  const int width = surface.view_depth.width, height = surface.view_depth.height;
  if (surface.view_depth.empty() || width < 1 || height < 1)
    throw Error(Errc::invalid_argument, "effects: Surface::view_depth is empty");
  if (factor.empty()) throw Error(Errc::invalid_argument, "effects: the factors' image is empty");
  check_stride(surface.view_depth, "Surface::view_depth");
  check_size(surface.normals, width, height, "Surface::normals");
  check_size(surface.ids, width, height, "Surface::ids");
  check_size(factor, width, height, "the factors' image");
}

bool is_there(float depth) {
  return depth < overlay::kFarthest;
}

/// How a camera's depths are compared: by their ratio in perspective, else by the picture's height.
struct Steps {
  bool perspective;
  float per_height;

  Steps(const Camera& camera, int width, int height) {
    const overlay::Lens lens = overlay::lens_of(camera, width, height);
    perspective = lens.perspective;
    per_height = static_cast<float>(1 / (std::fabs(lens.vy) * height));
  }
  /// 2 (d − e) / (d + e): log(d / e) up to the third order, and no logarithm.
  [[nodiscard]] float behind(float d, float e) const {
    return perspective ? 2 * (d - e) / (d + e) : (d - e) * per_height;
  }
  /// How far the middle lies in front of the line between its neighbours, 0 on a plane: 1/d is
  /// linear in the picture in perspective, d in an orthographic one.
  [[nodiscard]] float in_front(float before, float d, float after) const {
    return perspective ? (1 - d / before) + (1 - d / after)
                       : ((before - d) + (after - d)) * per_height;
  }
};

}  // namespace

std::vector<Material> materials_of_surface(const SceneView& scene) {
  const auto blends = [](const Material& m) {
    return m.alpha_mode == AlphaMode::blend && m.base_color_texture >= 0;
  };
  if (std::none_of(scene.materials.begin(), scene.materials.end(), blends)) return {};
  std::vector<Material> materials(scene.materials.begin(), scene.materials.end());
  for (Material& m : materials) {
    if (!blends(m)) continue;
    m.alpha_mode = AlphaMode::mask;
    m.alpha_cutoff = 0.5F;
  }
  return materials;
}

Effects::Effects(int threads, std::optional<Isa> isa)
    : impl_(std::make_unique<Impl>(threads, isa)) {}
Effects::~Effects() = default;
Effects::Effects(Effects&&) noexcept = default;
Effects& Effects::operator=(Effects&&) noexcept = default;

void Effects::ambient_occlusion(const Surface& surface, const Camera& camera,
                                const AmbientOcclusion& options, ImageView<float> factor) {
  check(surface, factor);
  const int width = factor.width, height = factor.height;
  // Lanes gather by 32-bit numbers from the first row on.
  const std::ptrdiff_t stride = surface.view_depth.stride;
  if (stride * height > INT32_MAX || stride * height < INT32_MIN)
    throw Error(Errc::invalid_argument,
                "effects: Surface::view_depth has more than 2^31 numbers from first to last");
  const overlay::OcclusionFrame frame = overlay::occlusion_frame(surface, camera, options);
  const auto kernel = overlay::occlusion_kernel(impl_->isa);
  const auto blur = overlay::blur_kernel(impl_->isa);
  const ImageView<float> across = impl_->image(width, height);
  // Tiles whose samples, 100 px around, stay in a second-level cache also of wide pictures.
  constexpr int kTileWidth = 128, kTileHeight = 32;
  const int bands = (height + kTileHeight - 1) / kTileHeight;
  parallel::for_each_index(impl_->threads, static_cast<std::size_t>(bands), [&](std::size_t band) {
    const int y0 = static_cast<int>(band) * kTileHeight, y1 = std::min(y0 + kTileHeight, height);
    for (int x = 0; x < width; x += kTileWidth)
      for (int y = y0; y < y1; ++y)
        kernel(frame, y, x, std::min(x + kTileWidth, width), factor.row(y));
    for (int y = y0; y < y1; ++y)
      blur(frame, factor.row(y), y, {false, 1}, 0, width, across.row(y));
  });
  impl_->for_each_row(height, [&](int y) {
    blur(frame, across.row(y), y, {true, across.stride}, 0, width, factor.row(y));
  });
}

void Effects::eye_dome(const Surface& surface, const Camera& camera, const EyeDome& options,
                       ImageView<float> factor) {
  check(surface, factor);
  if (!(options.strength >= 0 && options.strength <= 100))
    throw Error(Errc::invalid_argument,
                "EyeDome::strength must lie in [0, 100], got " + std::to_string(options.strength));
  if (options.radius_px < 1 || options.radius_px > 64)
    throw Error(Errc::invalid_argument,
                "EyeDome::radius_px must lie in 1 to 64, got " + std::to_string(options.radius_px));
  const auto depth = surface.view_depth;
  const Steps steps(camera, depth.width, depth.height);
  // Eight neighbours on a circle, as in the paper's first ring; 100: steps are fractions of the
  // distance.
  const int r = options.radius_px, s = std::max(1, (r * 181 + 128) / 256);
  const int around[8][2] = {{r, 0}, {s, s}, {0, r}, {-s, s}, {-r, 0}, {-s, -s}, {0, -r}, {s, -s}};
  const auto strength = static_cast<float>(100 * options.strength / 8);
  impl_->for_each_row(depth.height, [&](int y) {
    for (int x = 0; x < depth.width; ++x) {
      const float d = depth(x, y);
      factor(x, y) = 1;
      if (!is_there(d)) continue;
      float sum = 0;
      for (const auto& [dx, dy] : around) {
        const int qx = x + dx, qy = y + dy;
        if (qx < 0 || qx >= depth.width || qy < 0 || qy >= depth.height) continue;
        const float e = depth(qx, qy);
        if (e < d) sum = sum + steps.behind(d, e);
      }
      // exp(−t) as (1 − t/16)¹⁶, 0 from 16 on.
      float left = std::max(1.0F - strength * sum * 0.0625F, 0.0F);
      for (int i = 0; i < 4; ++i) left = left * left;
      factor(x, y) = left;
    }
  });
}

void Effects::silhouettes(const Surface& surface, const Camera& camera, const Silhouettes& options,
                          ImageView<float> factor) {
  check(surface, factor);
  if (!(options.depth >= 0 && std::isfinite(options.depth)))
    throw Error(Errc::invalid_argument,
                "Silhouettes::depth must be >= 0 and finite, got " + std::to_string(options.depth));
  if (!(options.angle_degrees >= 0 && options.angle_degrees <= 180))
    throw Error(Errc::invalid_argument, "Silhouettes::angle_degrees must lie in [0, 180], got " +
                                            std::to_string(options.angle_degrees));
  if (options.width_px < 1 || options.width_px > 16)
    throw Error(Errc::invalid_argument, "Silhouettes::width_px must lie in 1 to 16, got " +
                                            std::to_string(options.width_px));
  const auto depth = surface.view_depth;
  const Steps steps(camera, depth.width, depth.height);
  const bool by_depth = options.depth > 0,
             by_normal = !surface.normals.empty() && options.angle_degrees < 180,
             by_id = !surface.ids.empty() && options.instances;
  const auto threshold = static_cast<float>(options.depth),
             cosine = static_cast<float>(sin_cos_degrees(options.angle_degrees).cos);
  const auto has_normal = [](Vec3 n) { return n.x != 0 || n.y != 0 || n.z != 0; };
  // Is there an edge of (x, y) towards (x + dx, y + dy)? A step is the nearer one's; where two
  // surfaces meet at one depth, it is of the left and upper one, so that lines are not twice as
  // wide.
  const auto is_edge = [&](int x, int y, int dx, int dy) {
    const int qx = x + dx, qy = y + dy;
    if (qx < 0 || qx >= depth.width || qy < 0 || qy >= depth.height) return false;
    const float d = depth(x, y), e = depth(qx, qy);
    if (!is_there(e)) return true;
    if (by_depth && d < e) {
      const int bx = x - dx, by = y - dy;
      const bool has_before = bx >= 0 && bx < depth.width && by >= 0 && by < depth.height;
      const float before = has_before && is_there(depth(bx, by)) ? depth(bx, by) : d;
      if (steps.in_front(before, d, e) > threshold) return true;
    }
    if (dx + dy < 0) return false;
    if (by_id && surface.ids(x, y) != surface.ids(qx, qy)) return true;
    if (!by_normal) return false;
    const Vec3 a = surface.normals(x, y), b = surface.normals(qx, qy);
    return has_normal(a) && has_normal(b) && dot(a, b) < cosine;
  };
  impl_->for_each_row(depth.height, [&](int y) {
    for (int x = 0; x < depth.width; ++x) {
      bool edge = false;
      if (is_there(depth(x, y)))
        for (int k = 1; k <= options.width_px && !edge; ++k)
          edge = is_edge(x, y, k, 0) || is_edge(x, y, 0, k) || is_edge(x, y, -k, 0) ||
                 is_edge(x, y, 0, -k);
      factor(x, y) = edge ? 0.0F : 1.0F;
    }
  });
}

void Effects::edges(ImageView<const std::int64_t> ids, const SceneEdges& edges,
                    const Camera& camera, double width_px, ImageView<float> factor) {
  if (ids.empty() || factor.empty())
    throw Error(Errc::invalid_argument, "effects: the ids or the factors' image is empty");
  check_stride(ids, "effects: ids");
  check_size(factor, ids.width, ids.height, "the factors' image");
  if (!(width_px > 0 && width_px <= 64))
    throw Error(Errc::invalid_argument,
                "the width of edges must lie in (0, 64] px, got " + std::to_string(width_px));
  const Mat4d to_clip = world_to_clip(camera, ids.width, ids.height);
  // Before threads work, which may not throw.
  std::int64_t last = -1;
  for (int y = 0; y < ids.height; ++y)
    last = std::max(last, *std::max_element(ids.row(y), ids.row(y) + ids.width));
  if (last >= 0) static_cast<void>(edges.find(last));
  impl_->for_each_row(ids.height, [&](int y) {
    overlay::TriangleSides sides;
    for (int x = 0; x < ids.width; ++x) {
      const std::int64_t id = ids(x, y);
      if (id != sides.id()) sides.find(edges, to_clip, ids.width, ids.height, id);
      factor(x, y) = sides.factor(x + 0.5, y + 0.5, width_px / 2);
    }
  });
}

void Effects::darken(ImageView<Rgba8> color8, ImageView<Vec4> color, ImageView<const float> factor,
                     Vec3 ink) {
  check_size(color8, factor.width, factor.height, "effects: color8");
  check_size(color, factor.width, factor.height, "effects: color");
  check_stride(factor, "effects: the factors' image");
  const Vec3 ink8 = ink * 255.0F;
  const auto kernel = overlay::darken_kernel(impl_->isa);
  impl_->for_each_row(factor.height, [&](int y) {
    if (!color8.empty()) kernel(factor.row(y), ink8, factor.width, color8.row(y));
    if (color.empty()) return;
    for (int x = 0; x < factor.width; ++x) {
      const float f = factor(x, y), left = 1 - f;
      if (f == 1) continue;
      Vec4& c = color(x, y);
      c = {c.x * f + ink.x * c.w * left, c.y * f + ink.y * c.w * left, c.z * f + ink.z * c.w * left,
           c.w};
    }
  });
}

}  // namespace rastrum
