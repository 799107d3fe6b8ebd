// A frame of the façade on a device: the host's arrays over, bands of keys drawn (rasterizer.cuh,
// or family/family.cuh where a point of the table is asked for), and each band resolved, there
// (resolve.cuh) or, where a target or the shader has no device form (shading.cuh), by the host's
// resolve_block on the keys that come back.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/cuda/status.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/cuda/family/family.cuh>
#include <rastrum/raster/cuda/rasterizer.cuh>
#include <rastrum/raster/cuda/rasterizer.hpp>
#include <rastrum/raster/cuda/resolve.cuh>
#include <rastrum/raster/cuda/samples.cuh>
#include <rastrum/raster/cuda/shading.cuh>
#include <rastrum/raster/cuda/tested.cuh>
#include <rastrum/raster/cuda/upload.cuh>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/frame/stopwatch.hpp>
#include <rastrum/raster/resolve/resolve.hpp>

namespace rastrum::raster {

/// `Layers` is what blends translucent pieces: transparency::SceneLayers, which stands above this
/// floor.
template <class Exec, class Layers>
class DeviceRasterizer final : public CudaRasterizer {
 public:
  /// The names of a point of the family's table; empty: by-size.
  DeviceRasterizer(std::string_view coverage, std::string_view visibility,
                   std::uint64_t memory_limit, MemoryAccount& memory, parallel::Threads& threads)
      : memory_limit_(memory_limit),
        threads_(threads),
        exec_(&memory),
        textures_(exec_),
        keys_(memory),
        overdraw_(memory) {
    if (!coverage.empty()) family_ = family::point_of<Exec>(coverage, visibility);
  }

  [[nodiscard]] std::string why_no_test(const FrameRequest& request) const override {
    return has_tests(request) && request.test.own() != nullptr
               ? "a caller's fragment test (discard) is code of the CPU"
               : std::string();
  }
  [[nodiscard]] std::string why_no_layers(const FrameRequest& request) const override {
    if (std::string why(Layers::why_not(request)); !why.empty()) return why;
    if (family_ && request.samples > 1)
      return "of the device's rasterizers by-size has several samples a pixel";
    if (request.samples > 1 && uses_materials(request))
      return "several samples a pixel of materials, masks and tests are the CPU's";
    if (!request.targets.overdraw.empty() && is_layered(request))
      return "overdraw of translucent surfaces is the CPU's";
    return can_resolve(request) ? std::string()
                                : "translucent fragments, and those of several samples, are "
                                  "shaded where they are, and the device has no form of this "
                                  "shader or target";
  }
  [[nodiscard]] FrameStats render(FrameRequest& request) override {
    Stopwatch watch;
    FrameStats stats;
    stats.rasterizer = family_ ? family_->coverage->name : "by-size";
    stats.visibility = family_ ? family_->visibility->name : "atomic";
    stats.isa = request.isa;
    stats.device = Device::cuda;
    const Totals totals = number_draws(request.draws, request.targets.first_id, request.draw_noun);
    try {
      draw_frame(request, totals, stats, watch);
    } catch (const Error& error) {
      // Which index was out of range is for the host to find.
      if (error.code() == Errc::invalid_argument && !request.in_place)
        check_indices(request.draws, request.draw_noun);
      throw;
    }
    stats.triangles.input = totals.primitives;
    stats.triangles.drawn = totals.primitives - stats.triangles.dropped - stats.triangles.culled;
    return stats;
  }

 private:
  [[nodiscard]] static bool is_layered(const FrameRequest& request) {
    return request.transparency.method != Transparency::none &&
           std::ranges::any_of(request.draws, [](const Draw& draw) {
             return (draw.any_flags() & kTranslucent) != 0;
           });
  }
  /// Bytes of scratch beside what is copied: what was asked for, or what is there. 0: any.
  [[nodiscard]] std::uint64_t limit() const {
    if (memory_limit_ != 0) return memory_limit_;
    return free_bytes_ == 0
               ? 0
               : (free_bytes_ - std::min(free_bytes_, exec_.memory()->in_use())) / 4 * 3;
  }

  void draw_frame(FrameRequest& request, const Totals& totals, FrameStats& stats,
                  Stopwatch& watch) {
    Uploads<Exec> uploads(exec_, request.in_place);
    std::vector<cuda_detail::HostVertices> made;
    const std::vector<DeviceDraw> draws = upload(uploads, request, threads_, made);
    watch.lap(stats, "upload");
    const bool counts_overdraw = !request.targets.overdraw.empty();
    const bool resolves = can_resolve(request);
    const std::uint64_t textures_before = textures_.copies();
    const DeviceShading<Exec> look(exec_, uploads, textures_, request);
    if (request.in_place && !resolves)
      throw Error(Errc::unsupported,
                  "arrays in the device's memory (in_place): this shader needs them in the host's");
    const bool layered = is_layered(request);
    Layers layers;
    const SamplePattern samples = SamplePattern::of(request.samples);
    const auto planes = static_cast<std::uint64_t>(samples.count);
    const bool shades_all =
        family_ && family_->visibility->shades && resolves && wants_colors(request.targets);
    // Layers need a colour, and what is known of its block; so does each of several samples.
    const bool in_colors = layered || planes > 1;
    const std::uint64_t pixel_bytes =
        (planes - 1) * sizeof(std::uint64_t) + (in_colors ? planes * sizeof(Vec4) + 1 : 0) +
        (family_ ? family_->visibility->pixel_bytes : 0) +
        (counts_overdraw ? sizeof(std::uint32_t) : 0) + (resolves ? sizeof(std::uint32_t) : 0) +
        (resolves && !request.in_place ? DeviceTargets::bytes_of(request.targets) : 0);
    const DevicePlan plan = DevicePlan::of(limit(), request.width, request.height,
                                           totals.primitives, totals.vertices, pixel_bytes);
    const DeviceScene<Exec> scene(exec_, draws, request.width, request.height,
                                  request.targets.first_id, plan.project_first);
    exec_.wait();
    watch.lap(stats, "project");
    if (!request.targets.errors.empty())
      for (int y = 0; y < request.height; ++y)
        std::fill_n(request.targets.errors.row(y), request.width, std::uint8_t{0});

    FrameGeometry geometry{
        request.width, request.height, Viewport::of(request.width, request.height),
        request.draws, nullptr,        request.isa};
    parallel::ScratchPool<ShaderScratch> shaders{[&request] {
      ShaderScratch scratch;
      scratch.begin(request.shading.scratch_bytes());
      return scratch;
    }};
    std::uint64_t bands = 0;
    DeviceCounts counts;
    Counters own;
    for (int y = 0; y < request.height; y += plan.band_rows, ++bands) {
      const Rect view{0, y, request.width, std::min(y + plan.band_rows, request.height)};
      const std::size_t blocks = block_count(view);
      auto keys = parallel::make_buffer<std::uint64_t>(exec_, planes * blocks * 64);
      auto overdraw =
          parallel::make_buffer<std::uint32_t>(exec_, counts_overdraw ? blocks * 64 : 0);
      DeviceSurface surface{view,
                            {0, y / kBlockSize, block_columns(view), keys.data(), nullptr},
                            overdraw.data(),
                            blocks * 64,
                            samples};
      begin(request, view, keys, overdraw);
      Images images(exec_, request, view, resolves);
      const TestOnDevice test = look.test(scene.geometry(), images.depth_behind(request), view.y0);
      auto colors = parallel::make_buffer<Vec4>(exec_, in_colors || shades_all ? keys.size() : 0);
      family::Shading shading;
      if (shades_all)
        look.with(scene.geometry(), test, [&](const auto& shade, const auto&) {
          shading = {shade_fragments(surface.keys, shade), parallel::view_of(colors)};
        });
      const std::uint32_t skip = layered ? kTranslucent : 0;
      const std::uint32_t untested = skip | (look.has_test() ? kMayDrop : 0);
      DeviceCounts band =
          family_ ? draw_surface(exec_, scene, surface, plan, *family_, request.tuning, untested,
                                 shading, own)
                  : draw_surface(exec_, scene, surface, plan,
                                 DeviceSizes::of(request.tuning, samples.count), untested);
      if (look.has_test()) band.fragments += draw_tested(exec_, scene, surface, plan, skip, test);
      if (bands == 0) counts.sum = band.sum;
      counts.fragments += band.fragments;
      counts.larger_pieces += band.larger_pieces;
      counts.tiles += band.tiles;
      counts.batches += band.batches;
      watch.lap(stats, "rasterize");
      if (counts_overdraw) store_overdraw(request, view, overdraw);
      if (resolves)
        look.with(scene.geometry(), test, [&](const auto& shade, const auto& keeps) {
          using Shade = std::remove_cvref_t<decltype(shade)>;
          if (!in_colors && !shades_all) {
            stats.pixels_covered += resolve_on_device(request, shade, surface, images);
            return;
          }
          // Tested pieces are drawn after the others, without colours.
          if (planes == 1 && (shades_all ? look.has_test() : layered))
            parallel::tabulate(exec_, colors,
                               cuda_detail::ColorOfElement<Shade>{surface.keys, shade});
          if constexpr (std::is_same_v<Shade, LitOnDevice>) {
            if (planes > 1) {
              const ShadedOnce<Shade> once{scene.geometry(), samples, shade};
              shade_samples(exec_, surface, parallel::view_of(colors), once);
              if (layered)
                layers.blend(exec_, scene, surface, parallel::view_of(colors), request.transparency,
                             once, keeps, plan.batch, limit() / 8);
              mean_of_samples(exec_, surface, parallel::view_of(colors));
              watch.lap(stats, "samples");
            }
          }
          if (planes == 1 && layered) {
            layers.blend(exec_, scene, surface, parallel::view_of(colors), request.transparency,
                         shade, keeps, plan.batch, limit() / 8);
            watch.lap(stats, "layers");
          }
          stats.pixels_covered +=
              resolve_on_device(request, ColorsOfSurface{surface, colors.data()}, surface, images);
        });
      else
        stats.pixels_covered += resolve_on_host(request, geometry, view, keys, shaders);
      watch.lap(stats, "shade");
    }
    stats.triangles.dropped = counts.sum.dropped;
    stats.triangles.culled = counts.sum.culled;
    stats.triangles.clipped = counts.sum.clipped;
    stats.fragments = counts.fragments;
    stats.why = std::string(family_ ? "as asked for"
                                    : "cuda has by-size: a thread, a warp or blocks of threads a "
                                      "triangle")
                    .append(resolves ? "; shaded on the device" : "; shaded by the host's threads");
    stats.counters = {{"bands", bands},
                      {family_ ? "batches of primitives" : "batches", counts.batches},
                      {"textures copied", textures_.copies() - textures_before}};
    if (family_) {
      for (const auto& [name, value] : own) stats.counters.emplace_back(name, value);
    } else {
      stats.counters.emplace_back("larger pieces", counts.larger_pieces);
      stats.counters.emplace_back("tile pairs", counts.tiles);
    }
    if (layered) layers.count(stats);
  }

  /// family::Shading::shade; must not outlive the arrays of `shade`.
  template <class Shade>
  [[nodiscard]] auto shade_fragments(const SurfaceView& keys, const Shade& shade) {
    return [this, keys, shade](std::span<const std::uint32_t> element,
                               std::span<const std::uint64_t> key, std::span<Vec4> colors) {
      parallel::tabulate(exec_, colors, family::ColorOfFragment<Shade>{keys, element, key, shade});
    };
  }

  using Keys = decltype(parallel::make_buffer<std::uint64_t>(std::declval<Exec&>(), 0));
  using Counts = decltype(parallel::make_buffer<std::uint32_t>(std::declval<Exec&>(), 0));

  /// Calls f(block row) by all threads.
  template <class F>
  void for_each_row(Rect view, F&& f) {
    parallel::for_each_index(threads_, static_cast<std::size_t>(block_rows(view)),
                             [&](std::size_t r) { f(view.y0 / kBlockSize + static_cast<int>(r)); });
  }
  [[nodiscard]] SurfaceView host_surface(Rect view) {
    keys_.reserve(block_count(view) * 64);
    return {0, view.y0 / kBlockSize, block_columns(view), keys_.data(), nullptr};
  }

  /// Nothing, or the keys of the passes before.
  void begin(const FrameRequest& request, Rect view, Keys& keys, Counts& overdraw) {
    if (request.targets.load) {
      load_keys(request.targets, view, host_surface(view));
      parallel::cuda_system::copy(exec_.stream(), keys.data(), keys_.data(),
                                  keys.size() * sizeof(std::uint64_t));
      exec_.wait();
    } else {
      parallel::tabulate(exec_, keys, parallel::range_detail::SameValue<std::uint64_t>{0});
    }
    parallel::tabulate(exec_, overdraw, parallel::range_detail::SameValue<std::uint32_t>{0});
  }

  void store_overdraw(const FrameRequest& request, Rect view, const Counts& overdraw) {
    overdraw_.reserve(overdraw.size());
    parallel::cuda_system::copy(exec_.stream(), overdraw_.data(), overdraw.data(),
                                overdraw.size() * sizeof(std::uint32_t));
    exec_.wait();
    const SurfaceView places{0, view.y0 / kBlockSize, block_columns(view), nullptr, nullptr};
    const Targets& targets = request.targets;
    for_each_row(view, [&](int by) {
      for (int y = by * kBlockSize; y < std::min((by + 1) * kBlockSize, view.y1); ++y)
        for (int x = 0; x < view.x1; ++x) {
          const std::uint32_t n =
              overdraw_[places.index(x / kBlockSize, by) * 64 +
                        static_cast<std::size_t>(y % kBlockSize * kBlockSize + x % kBlockSize)];
          targets.overdraw(x, y) = n + (targets.load ? targets.overdraw(x, y) : 0);
        }
    });
  }

  /// An image of a band on the device, where the caller has one; in place, the caller's.
  template <class T>
  class Band {
    using Pixels = decltype(parallel::make_buffer<T>(std::declval<Exec&>(), 0));

   public:
    Band(Exec& exec, const ImageView<T>& host, Rect view, bool in_place, bool keeps)
        : exec_(exec),
          host_(host),
          view_(view),
          in_place_(in_place),
          pixels_(parallel::make_buffer<T>(exec, host.empty() || in_place ? 0 : area_of(view))) {
      if (keeps && pixels_.size() > 0)
        each_part([&](T* there, T* here, std::size_t n) {
          parallel::cuda_system::copy(exec_.stream(), there, here, n * sizeof(T));
        });
    }
    [[nodiscard]] ImageView<T> on_device() {
      const int width = view_.x1 - view_.x0;
      if (in_place_ && !host_.empty())
        return {host_.row(view_.y0), width, view_.y1 - view_.y0, host_.stride};
      return {pixels_.data(), width, view_.y1 - view_.y0, width};
    }
    /// Does not wait.
    void store() {
      if (pixels_.size() > 0)
        each_part([&](T* there, T* here, std::size_t n) {
          parallel::cuda_system::copy(exec_.stream(), here, there, n * sizeof(T));
        });
    }

   private:
    /// Calls f(device, host, pixels). Rows that lie together are one part.
    template <class F>
    void each_part(F&& f) {
      const auto width = static_cast<std::size_t>(view_.x1 - view_.x0);
      const auto rows = static_cast<std::size_t>(view_.y1 - view_.y0);
      const std::size_t at_once = host_.stride == view_.x1 ? rows : 1;
      for (std::size_t y = 0; y < rows; y += at_once)
        f(pixels_.data() + y * width, host_.row(view_.y0 + static_cast<int>(y)), at_once * width);
    }

    Exec& exec_;
    ImageView<T> host_;
    Rect view_;
    bool in_place_;
    Pixels pixels_;
  };

  /// A band of all targets on the device; with what they hold, where they keep it.
  struct Images {
    Band<Rgba8> color8;
    Band<Vec4> color;
    Band<float> depth;
    Band<std::int64_t> ids;
    Band<std::uint64_t> keys;

    /// `resolves`: they are wanted; else but what tests read.
    Images(Exec& exec, const FrameRequest& request, Rect view, bool resolves)
        : color8(of(exec, request, request.targets.color8, view, resolves)),
          color(of(exec, request, request.targets.color, view, resolves)),
          depth(of(exec, request, request.targets.depth, view, resolves || request.targets.over)),
          ids(of(exec, request, request.targets.ids, view, resolves)),
          keys(of(exec, request, request.targets.keys, view, resolves)) {}

    [[nodiscard]] ImageView<const float> depth_behind(const FrameRequest& request) {
      if (!request.targets.over) return {};
      const ImageView<float> d = depth.on_device();
      return {d.data, d.width, d.height, d.stride};
    }

   private:
    template <class T>
    static Band<T> of(Exec& exec, const FrameRequest& request, const ImageView<T>& target,
                      Rect view, bool wanted) {
      return Band<T>(exec, wanted ? target : ImageView<T>{}, view, request.in_place,
                     request.targets.over || request.targets.load);
    }
  };

  /// All targets, on the device. Returns how many pixels hold a surface.
  template <class Shade>
  [[nodiscard]] std::uint64_t resolve_on_device(const FrameRequest& request, const Shade& shade,
                                                const DeviceSurface& surface, Images& images) {
    const DeviceTargets targets{images.color8.on_device(), images.color.on_device(),
                                images.depth.on_device(), images.ids.on_device(),
                                images.keys.on_device()};
    const std::uint64_t covered =
        resolve_surface(exec_, surface, targets, shade, ResolveRules::of(request));
    images.color8.store();
    images.color.store();
    images.depth.store();
    images.ids.store();
    images.keys.store();
    exec_.wait();
    return covered;
  }

  /// All targets, from keys that come back. Returns how many pixels hold a surface.
  [[nodiscard]] std::uint64_t resolve_on_host(const FrameRequest& request,
                                              const FrameGeometry& geometry, Rect view,
                                              const Keys& keys,
                                              parallel::ScratchPool<ShaderScratch>& shaders) {
    const SurfaceView surface = host_surface(view);
    parallel::cuda_system::copy(exec_.stream(), keys_.data(), keys.data(),
                                keys.size() * sizeof(std::uint64_t));
    exec_.wait();
    const Backdrop backdrop = backdrop_of(request);
    std::atomic<std::uint64_t> covered = 0;
    for_each_row(view, [&](int by) {
      std::uint64_t here = 0;
      for (int bx = 0; bx < surface.columns; ++bx)
        here += static_cast<std::uint64_t>(resolve_block(request, geometry, backdrop,
                                                         surface.block(bx, by), bx * kBlockSize,
                                                         by * kBlockSize, shaders.local().data()));
      covered.fetch_add(here, std::memory_order_relaxed);
    });
    return covered;
  }

  std::optional<family::Point<Exec>> family_;  ///< none: by-size
  std::uint64_t memory_limit_;
  std::uint64_t free_bytes_ = parallel::cuda_status().free_bytes;  ///< before the first frame
  parallel::Threads& threads_;
  Exec exec_;
  DeviceTextures<Exec> textures_;
  Buffer<std::uint64_t> keys_;      ///< of the host, in the device's places
  Buffer<std::uint32_t> overdraw_;  ///< alike
};

}  // namespace rastrum::raster
