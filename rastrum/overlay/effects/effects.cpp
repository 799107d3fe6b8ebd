// SPDX-License-Identifier: BSD-3-Clause
// Eye-dome lighting, silhouettes, and the loops over rows that call the kernels. Pixels do not
// depend on each other, so threads change nothing.
#include <rastrum/effects.hpp>

#include <algorithm>
#include <cmath>
#include <mutex>

#include <rastrum/core/angle.hpp>
#include <rastrum/core/no_memory.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/core/view_rows.hpp>
#include <rastrum/overlay/effects/darken.hpp>
#include <rastrum/overlay/effects/edges.hpp>
#include <rastrum/overlay/effects/lens.hpp>
#include <rastrum/overlay/effects/occlusion.hpp>
#include <rastrum/parallel/device.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/parallel/turn.hpp>

namespace rastrum {

struct Effects::Impl {
  std::mutex one_at_a_time;
  parallel::Threads threads;
  Isa isa;
  std::vector<float> scratch;
  parallel::ScratchPool<std::vector<float>> rows;  ///< one per thread

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
  /// use(y, x, n, factors): the share of light that the n pixels from (x, y) keep. Null: they show
  /// no surface and keep all.
  template <class Use>
  void occlusion(const Surface& surface, const Camera& camera, const AmbientOcclusion& options,
                 const Use& use) {
    const int width = surface.view_depth.width, height = surface.view_depth.height;
    // Lanes gather by 32-bit indices from the first row.
    const std::ptrdiff_t stride = surface.view_depth.stride;
    if (stride * height > INT32_MAX || stride * height < INT32_MIN)
      reject("effects: Surface::view_depth has more than 2^31 numbers from first to last");
    const overlay::OcclusionFrame frame = overlay::occlusion_frame(surface, camera, options);
    const auto kernel = overlay::occlusion_kernel(isa);
    const auto blur = overlay::blur_kernel(isa);
    const ImageView<float> across = image(width, height);
    // The samples of a tile, 100 px around it, stay in a second-level cache, for wide pictures,
    // too.
    constexpr int kTileWidth = 128, kTileHeight = 32;
    const auto columns = static_cast<std::size_t>((width + kTileWidth - 1) / kTileWidth);
    const auto bands = static_cast<std::size_t>((height + kTileHeight - 1) / kTileHeight);
    std::vector<std::uint8_t> seen(bands * columns, 0);
    /// Calls body(first row, end row, flags) for each band. A flag: the tile shows a surface.
    const auto for_each_band = [&](const auto& body) {
      parallel::for_each_index(threads, bands, [&](std::size_t band) {
        const int y0 = static_cast<int>(band) * kTileHeight;
        body(y0, std::min(y0 + kTileHeight, height), seen.data() + band * columns);
      });
    };
    const auto for_each_tile = [&](const auto& body) {
      for (std::size_t i = 0; i < columns; ++i) {
        const int x = static_cast<int>(i) * kTileWidth;
        body(i, x, std::min(kTileWidth, width - x));
      }
    };
    const auto rows_of_thread = [&] {
      std::vector<float>& own = rows.local();
      own.resize(static_cast<std::size_t>(kTileHeight) * static_cast<std::size_t>(width));
      return ImageView<float>{own.data(), width, kTileHeight};
    };
    for_each_band([&](int y0, int y1, std::uint8_t* of_tiles) {
      const ImageView<float> band = rows_of_thread();
      for_each_tile([&](std::size_t i, int x, int n) {
        for (int y = y0; y < y1; ++y)
          if (kernel(frame, y, x, x + n, band.row(y - y0))) of_tiles[i] = 1;
      });
      // Empty tiles need no `across`: the next blur gives them no weight.
      for (int y = y0; y < y1; ++y)
        for_each_tile([&](std::size_t i, int x, int n) {
          if (of_tiles[i] != 0)
            blur(frame, band.row(y - y0), y, {false, 1}, x, x + n, across.row(y));
        });
    });
    for_each_band([&](int y0, int y1, const std::uint8_t* of_tiles) {
      float* const factors = rows_of_thread().row(0);
      for (int y = y0; y < y1; ++y)
        for_each_tile([&](std::size_t i, int x, int n) {
          if (of_tiles[i] == 0) return use(y, x, n, nullptr);
          blur(frame, across.row(y), y, {true, across.stride}, x, x + n, factors);
          use(y, x, n, factors + x);
        });
    });
  }

  [[nodiscard]] auto darkening(ImageView<Rgba8> color8, ImageView<Vec4> color, Vec3 ink) const {
    return [=, ink8 = ink * 255.0F, kernel = overlay::darken_kernel(isa)](int y, int x, int n,
                                                                          const float* factors) {
      if (factors == nullptr) return;
      if (!color8.empty()) kernel(factors, ink8, n, color8.row(y) + x);
      if (color.empty()) return;
      Vec4* const row = color.row(y) + x;
      for (int i = 0; i < n; ++i) {
        const float f = factors[i], left = 1 - f;
        if (f == 1) continue;
        Vec4& c = row[i];
        c = {c.x * f + ink.x * c.w * left, c.y * f + ink.y * c.w * left,
             c.z * f + ink.z * c.w * left, c.w};
      }
    };
  }
};

namespace {

void check(const Surface& surface) {
  const int width = surface.view_depth.width, height = surface.view_depth.height;
  if (surface.view_depth.empty() || width < 1 || height < 1)
    reject("effects: Surface::view_depth is empty");
  check_stride(surface.view_depth, "Surface::view_depth");
  check_size(surface.normals, width, height, "Surface::normals");
  check_size(surface.ids, width, height, "Surface::ids");
}

void check(const Surface& surface, ImageView<float> factor) {
  check(surface);
  if (factor.empty()) reject("effects: the factors' image is empty");
  check_size(factor, surface.view_depth.width, surface.view_depth.height, "the factors' image");
  check_apart(surface.view_depth, "Surface::view_depth", factor, "the factors' image");
}

bool is_there(float depth) {
  return depth < overlay::kFarthest;
}

/// Compares depths: by their ratio in perspective, else in picture heights.
struct Steps {
  bool perspective;
  float per_height;

  Steps(const Camera& camera, int width, int height) {
    const overlay::Lens lens = overlay::lens_of(camera, width, height);
    perspective = lens.perspective;
    per_height = static_cast<float>(1 / (std::fabs(lens.vy) * height));
  }
  /// 2 (d − e) / (d + e) is log(d / e) up to terms of third order.
  [[nodiscard]] float behind(float d, float e) const {
    return perspective ? 2 * (d - e) / (d + e) : (d - e) * per_height;
  }
  /// How far the middle lies in front of the line between its neighbours; 0 on a plane. In
  /// perspective 1/d is linear in the picture, else d.
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
    : impl_("Effects", in_memory([&] { return std::make_unique<Impl>(threads, isa); })) {}
Effects::~Effects() = default;
Effects::Effects(Effects&&) noexcept = default;
Effects& Effects::operator=(Effects&&) noexcept = default;

void Effects::ambient_occlusion(const Surface& surface, const Camera& camera,
                                const AmbientOcclusion& options, ImageView<float> factor) {
  parallel::in_turn(impl_->one_at_a_time, {}, [&] {
    check(surface, factor);
    impl_->occlusion(surface, camera, options, [&](int y, int x, int n, const float* factors) {
      if (factors != nullptr)
        std::copy_n(factors, n, factor.row(y) + x);
      else
        std::fill_n(factor.row(y) + x, n, 1.0F);
    });
  });
}

void Effects::occlude(const Surface& surface, const Camera& camera, const AmbientOcclusion& options,
                      ImageView<Rgba8> color8, ImageView<Vec4> color, Vec3 ink) {
  parallel::in_turn(impl_->one_at_a_time, {}, [&] {
    check(surface);
    const int width = surface.view_depth.width, height = surface.view_depth.height;
    check_size(color8, width, height, "effects: color8");
    check_size(color, width, height, "effects: color");
    impl_->occlusion(surface, camera, options, impl_->darkening(color8, color, ink));
  });
}

void Effects::eye_dome(const Surface& surface, const Camera& camera, const EyeDome& options,
                       ImageView<float> factor) {
  parallel::in_turn(impl_->one_at_a_time, {}, [&] {
    check(surface, factor);
    if (!(options.strength >= 0 && options.strength <= 100))
      reject("EyeDome::strength must lie in [0, 100], got ", options.strength);
    if (options.radius_px < 1 || options.radius_px > 64)
      reject("EyeDome::radius_px must lie in 1 to 64, got ", options.radius_px);
    const auto depth = surface.view_depth;
    const Steps steps(camera, depth.width, depth.height);
    // Eight neighbours on a circle, as in the paper's first ring. 100: steps are fractions of the
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
  });
}

void Effects::silhouettes(const Surface& surface, const Camera& camera, const Silhouettes& options,
                          ImageView<float> factor) {
  parallel::in_turn(impl_->one_at_a_time, {}, [&] {
    check(surface, factor);
    if (!(options.depth >= 0 && std::isfinite(options.depth)))
      reject("Silhouettes::depth must be >= 0 and finite, got ", options.depth);
    if (!(options.angle_degrees >= 0 && options.angle_degrees <= 180))
      reject("Silhouettes::angle_degrees must lie in [0, 180], got ", options.angle_degrees);
    if (options.width_px < 1 || options.width_px > 16)
      reject("Silhouettes::width_px must lie in 1 to 16, got ", options.width_px);
    const auto depth = surface.view_depth;
    const Steps steps(camera, depth.width, depth.height);
    const bool by_depth = options.depth > 0,
               by_normal = !surface.normals.empty() && options.angle_degrees < 180,
               by_id = !surface.ids.empty() && options.instances;
    const auto threshold = static_cast<float>(options.depth),
               cosine = static_cast<float>(sin_cos_degrees(options.angle_degrees).cos);
    const auto has_normal = [](Vec3 n) { return n.x != 0 || n.y != 0 || n.z != 0; };
    // Is there an edge between (x, y) and (x + dx, y + dy)? The nearer pixel gets it; where
    // surfaces meet at one depth, the left or upper one, so that lines are not twice as wide.
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
  });
}

void Effects::edges(ImageView<const std::int64_t> ids, const SceneEdges& edges,
                    const Camera& camera, double width_px, ImageView<float> factor) {
  parallel::in_turn(impl_->one_at_a_time, {}, [&] {
    if (ids.empty() || factor.empty()) reject("effects: the ids or the factors' image is empty");
    check_stride(ids, "effects: ids");
    check_size(factor, ids.width, ids.height, "the factors' image");
    overlay::check_edge_width(width_px);
    const Mat4d to_clip = world_to_clip(camera, ids.width, ids.height);
    // Refuses bad ids first, because threads may not throw.
    std::int64_t last = -1;
    for (int y = 0; y < ids.height; ++y)
      last = std::max(last, *std::max_element(ids.row(y), ids.row(y) + ids.width));
    if (last >= 0) static_cast<void>(edges.find(last));
    impl_->for_each_row(ids.height, [&](int y) {
      overlay::TriangleSides sides(edges, to_clip, ids.width, ids.height, width_px);
      for (int x = 0; x < ids.width; ++x) factor(x, y) = sides.factor(ids(x, y), x, y);
    });
  });
}

void Effects::darken(ImageView<Rgba8> color8, ImageView<Vec4> color, ImageView<const float> factor,
                     Vec3 ink) {
  parallel::in_turn(impl_->one_at_a_time, {}, [&] {
    check_size(color8, factor.width, factor.height, "effects: color8");
    check_size(color, factor.width, factor.height, "effects: color");
    check_stride(factor, "effects: the factors' image");
    const auto darken = impl_->darkening(color8, color, ink);
    impl_->for_each_row(factor.height, [&](int y) { darken(y, 0, factor.width, factor.row(y)); });
  });
}

}  // namespace rastrum
