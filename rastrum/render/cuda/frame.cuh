// A frame of the façade on a device. It begins with the host's arrays copied over; then, band by
// band of rows, a SurfaceDrawer draws keys, and they are resolved: there (band_images.cuh), or by
// the host's threads (host_band.cuh). Above the floors of pieces and of layers, which it puts
// together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/cuda/driver.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/parallel/scratch.hpp>
#include <rastrum/raster/cuda/resolve.cuh>
#include <rastrum/raster/cuda/samples.cuh>
#include <rastrum/raster/cuda/shading.cuh>
#include <rastrum/raster/cuda/surface_drawer.cuh>
#include <rastrum/raster/cuda/tested.cuh>
#include <rastrum/raster/cuda/upload.cuh>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/frame/driver.hpp>
#include <rastrum/raster/frame/request.hpp>
#include <rastrum/raster/frame/stopwatch.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/render/cuda/band_images.cuh>
#include <rastrum/render/cuda/host_band.cuh>
#include <rastrum/render/cuda/layers.cuh>
#include <rastrum/render/cuda/rasterizer.hpp>
#include <rastrum/render/drawer.hpp>

namespace rastrum::raster {

class DeviceRasterizer final : public CudaRasterizer {
 public:
  DeviceRasterizer(std::unique_ptr<SurfaceDrawer> drawer, std::uint64_t memory_limit,
                   MemoryAccount& memory, parallel::Threads& threads)
      : drawer_(std::move(drawer)),
        kind_(drawer_->kind()),
        memory_limit_(memory_limit),
        threads_(threads),
        exec_(&memory),
        textures_(exec_),
        host_(memory, threads) {}

  [[nodiscard]] std::string why_no_test(const FrameRequest& request) const override {
    return has_tests(request) && request.test.own() != nullptr
               ? "a caller's fragment test (discard) is code of the CPU"
               : std::string();
  }
  [[nodiscard]] std::string why_no_layers(const FrameRequest& request) const override {
    if (std::string why(transparency::SceneLayers::why_not(request)); !why.empty()) return why;
    if (!kind_.has_samples && request.samples > 1)
      return "of the device's rasterizers by-size has several samples a pixel";
    if (request.samples > 1 && uses_materials(request))
      return "several samples a pixel of materials, masks and tests are the CPU's";
    if (!request.targets.overdraw.empty() && blends(request.draws, request.transparency))
      return "overdraw of translucent surfaces is the CPU's";
    return can_resolve(request) ? std::string()
                                : "translucent fragments, and those of several samples, are "
                                  "shaded where they are, and the device has no form of this "
                                  "shader or target";
  }

 private:
  using Exec = parallel::Cuda;

  /// What a frame is made of, filled by begin_frame in this order.
  struct Frame {
    Frame(FrameRequest& r, Exec& exec) : request(r), uploads(exec, r.in_place) {}

    FrameRequest& request;
    Stopwatch watch;
    FrameStats stats;
    Totals totals;
    bool resolves = false;          ///< on the device
    bool has_layers = false;        ///< something is blended
    bool in_colors = false;         ///< layers need a colour; so does each of several samples
    bool shades_fragments = false;  ///< the drawer sets colours
    std::uint64_t textures_before = 0;
    parallel::cuda_system::DeviceTally asked = parallel::cuda_system::device_tally();
    Uploads<Exec> uploads;
    std::vector<cuda_detail::HostVertices> made;
    std::vector<DeviceDraw> draws;
    std::optional<DeviceShading<Exec>> look;
    SamplePattern samples;
    DevicePlan plan;
    std::optional<DeviceScene<Exec>> scene;
    FrameGeometry geometry;  ///< for the host
    std::optional<parallel::ScratchPool<ShaderScratch>> shaders;
    transparency::SceneLayers layers;
    std::uint64_t bands = 0;
  };

  /// A band that is being drawn, on the device.
  struct Band {
    Band(Exec& exec, const Frame& frame, Rect rows)
        : view(rows),
          elements(block_count(rows) * 64),
          keys(parallel::make_buffer<std::uint64_t>(
              exec, static_cast<std::size_t>(frame.samples.count) * elements)),
          overdraw(parallel::make_buffer<std::uint32_t>(
              exec, frame.request.targets.overdraw.empty() ? 0 : elements)),
          images(exec, frame.request, rows, frame.resolves),
          colors(parallel::make_buffer<Vec4>(
              exec, frame.in_colors || frame.shades_fragments ? keys.size() : 0)),
          sums(parallel::make_buffer<std::uint64_t>(exec, kBandSums)),
          surface{view,
                  {0, view.y0 / kBlockSize, block_columns(view), keys.data(), nullptr},
                  overdraw.data(),
                  elements,
                  frame.samples} {}

    Rect view;
    std::size_t elements;  ///< of a plane
    HostBand::Keys keys;   ///< a plane for each sample
    HostBand::Counts overdraw;
    BandImages images;
    parallel::DeviceBuffer<Vec4> colors;         ///< in the places of the keys
    parallel::DeviceBuffer<std::uint64_t> sums;  ///< BandSums
    DeviceSurface surface;
  };

  [[nodiscard]] FrameStats render(FrameRequest& request, const std::stop_token* stop) override {
    return parallel::on_device_of(exec_, [&] { return draw_frame(request, stop); });
  }

  [[nodiscard]] FrameStats draw_frame(FrameRequest& request, const std::stop_token* stop) {
    const parallel::StopScope scope(stop);
    Frame frame(request, exec_);
    frame.totals = raster::begin_frame(request);
    try {
      begin_frame(frame);
      for (int y = 0; y < request.height; y += frame.plan.band_rows)
        draw_band(frame, {0, y, request.width, std::min(y + frame.plan.band_rows, request.height)});
    } catch (const Error& error) {
      exec_.settle();
      // Which index was out of range is for the host to find.
      if (error.code() == Errc::invalid_argument && !request.in_place)
        check_indices(request.draws, request.names);
      throw;
    } catch (...) {
      exec_.settle();  // while the frame's own arrays are there
      throw;
    }
    end_frame(frame);
    // The driver sets local memory aside at the first launch of each kernel that wants more.
    if (free_bytes_ != 0 && !has_drawn_)
      free_bytes_ = parallel::driver_status().free_bytes + exec_.memory()->held();
    has_drawn_ = true;
    return std::move(frame.stats);
  }

  /// Bytes of scratch beside what is copied: what was asked for, or what is there. 0: any.
  [[nodiscard]] std::uint64_t limit() const {
    if (memory_limit_ != 0) return memory_limit_;
    return free_bytes_ == 0
               ? 0
               : (free_bytes_ - std::min(free_bytes_, exec_.memory()->in_use())) / 4 * 3;
  }
  /// Bytes of a band's pixel beside its key.
  [[nodiscard]] std::uint64_t pixel_bytes(const Frame& f) const {
    const Targets& targets = f.request.targets;
    const auto planes = static_cast<std::uint64_t>(f.samples.count);
    return (planes - 1) * sizeof(std::uint64_t) + (f.in_colors ? planes * sizeof(Vec4) + 1 : 0) +
           kind_.pixel_bytes + (targets.overdraw.empty() ? 0 : sizeof(std::uint32_t)) +
           (f.resolves ? sizeof(std::uint32_t) : 0) +
           (f.resolves && !f.request.in_place ? DeviceTargets::bytes_of(targets) : 0);
  }

  /// Arrays over, and all that the bands have in common.
  void begin_frame(Frame& f) {
    FrameRequest& request = f.request;
    if (request.after) parallel::cuda_system::wait_for(exec_.stream(), request.after->handle);
    drawer_->begin_frame();
    f.draws = upload(f.uploads, request, threads_, f.made);
    f.watch.lap(f.stats, "upload");
    f.resolves = can_resolve(request);
    f.textures_before = textures_.copies();
    f.look.emplace(exec_, f.uploads, textures_, request);
    if (request.in_place && !f.resolves)
      throw Error(Errc::unsupported,
                  "arrays in the device's memory (in_place): this shader needs them in the host's");
    f.has_layers = blends(request.draws, request.transparency);
    f.samples = SamplePattern::of(request.samples);
    f.in_colors = f.has_layers || f.samples.count > 1;
    f.shades_fragments = kind_.shades && f.resolves && wants_colors(request.targets);
    f.plan = DevicePlan::of(limit(), request.width, request.height, f.totals.primitives,
                            f.totals.vertices, pixel_bytes(f));
    f.scene.emplace(exec_, f.draws, request.width, request.height, request.targets.first_id,
                    f.plan.project_first);
    f.watch.lap(f.stats, "project");
    f.geometry = {request.width, request.height, Viewport::of(request.width, request.height),
                  request.draws, nullptr,        request.isa};
    f.shaders.emplace([&request] {
      ShaderScratch scratch;
      scratch.begin(request.shading.scratch_bytes());
      return scratch;
    });
  }

  /// Nothing, or the keys of the passes before.
  void begin_band(Frame& f, Band& band) {
    if (f.request.targets.load)
      host_.load(exec_, f.request.targets, band.view, band.keys);
    else
      parallel::tabulate(exec_, band.keys, parallel::range_detail::SameValue<std::uint64_t>{0});
    parallel::tabulate(exec_, band.overdraw, parallel::range_detail::SameValue<std::uint32_t>{0});
    parallel::tabulate(exec_, band.sums, parallel::range_detail::SameValue<std::uint64_t>{0});
  }

  void draw_band(Frame& f, Rect view) {
    FrameRequest& request = f.request;
    Band band(exec_, f, view);
    begin_band(f, band);
    const TestOnDevice test =
        f.look->test(f.scene->geometry(), band.images.depth_behind(request), view.y0);
    FragmentColors colors;
    if (f.shades_fragments)
      f.look->with(f.scene->geometry(), test, [&](const auto& shade, const auto&) {
        colors = {shade_fragments(band.surface.keys, shade), parallel::view_of(band.colors)};
      });
    const std::uint32_t skip = f.has_layers ? kTranslucent : 0;
    drawer_->draw(exec_, *f.scene, band.surface, f.plan, request.tuning,
                  skip | (f.look->has_test() ? kMayDrop : 0), colors, band.sums.data());
    if (f.look->has_test())
      f.stats.fragments += draw_tested(exec_, *f.scene, band.surface, f.plan, skip, test);
    f.watch.lap(f.stats, "rasterize");
    if (band.overdraw.size() > 0) host_.store_overdraw(exec_, request.targets, view, band.overdraw);
    if (f.resolves)
      f.look->with(f.scene->geometry(), test, [&](const auto& shade, const auto& keeps) {
        resolve_band(f, band, shade, keeps);
      });
    else
      f.stats.pixels_covered +=
          host_.resolve(exec_, request, f.geometry, view, band.keys, *f.shaders);
    end_band(f, band);
    f.watch.lap(f.stats, "shade");
  }

  /// Waits for the band, which is the frame's one wait where nothing is blended or tested.
  void end_band(Frame& f, const Band& band) {
    BandSums sums{};
    parallel::cuda_system::copy(exec_.stream(), sums.data(), band.sums.data(), sizeof sums);
    exec_.wait();
    check_valid(sums[kInvalidSum]);
    drawer_->end_band(sums);
    f.stats.fragments += sums[kFragmentsSum];
    f.stats.pixels_covered += sums[kCoveredSum];
    // Each band sets all primitives up.
    if (f.bands++ > 0) return;
    FrameStats::Triangles& t = f.stats.triangles;
    t.dropped = sums[kDroppedSum];
    t.culled = sums[kCulledSum];
    t.clipped = sums[kClippedSum];
  }

  /// The colours of a band, its layers and samples, and its targets.
  template <class Shade, class Keeps>
  void resolve_band(Frame& f, Band& band, const Shade& shade, const Keeps& keeps) {
    std::uint64_t* const covered = band.sums.data() + kCoveredSum;
    if (!f.in_colors && !f.shades_fragments)
      return band.images.resolve(f.request, shade, band.surface, covered);
    const std::span<Vec4> colors = parallel::view_of(band.colors);
    const auto blend = [&](const auto& shader) {
      f.layers.blend(exec_, *f.scene, band.surface, colors, f.request.transparency, shader, keeps,
                     f.plan.batch, limit() / 8);
    };
    if (f.samples.count == 1) {
      // Tested pieces are drawn after the others, without colours.
      if (f.shades_fragments ? f.look->has_test() : f.has_layers)
        parallel::tabulate(exec_, band.colors,
                           cuda_detail::ColorOfElement<Shade>{band.surface.keys, shade});
      if (f.has_layers) {
        blend(shade);
        f.watch.lap(f.stats, "layers");
      }
    } else if constexpr (std::is_same_v<Shade, LitOnDevice>) {
      const ShadedOnce<Shade> once{f.scene->geometry(), f.samples, shade};
      shade_samples(exec_, band.surface, colors, once);
      if (f.has_layers) blend(once);
      mean_of_samples(exec_, band.surface, colors);
      f.watch.lap(f.stats, "samples");
    }
    band.images.resolve(f.request, ColorsOfSurface{band.surface, band.colors.data()}, band.surface,
                        covered);
  }

  /// FragmentColors::shade; must not outlive the arrays of `shade`.
  template <class Shade>
  [[nodiscard]] auto shade_fragments(const SurfaceView& keys, const Shade& shade) {
    return [this, keys, shade](std::span<const std::uint32_t> element,
                               std::span<const std::uint64_t> key, std::span<Vec4> colors) {
      parallel::tabulate(exec_, colors, ColorOfFragment<Shade>{keys, element, key, shade});
    };
  }

  /// What the statistics say of it.
  void end_frame(Frame& f) {
    FrameStats& stats = f.stats;
    raster::end_frame(f.totals, stats);
    stats.rasterizer = kind_.rasterizer;
    stats.visibility = kind_.visibility;
    stats.isa = choose_isa(f.request.isa);
    stats.device = Device::cuda;
    stats.why = std::string(kind_.why).append(f.resolves ? "; shaded on the device"
                                                         : "; shaded by the host's threads");
    const parallel::cuda_system::DeviceTally asked =
        parallel::cuda_system::device_tally() - f.asked;
    stats.counters = {{"bands", f.bands},
                      {"textures copied", textures_.copies() - f.textures_before},
                      {"launches", asked.launches},
                      {"device algorithms", asked.algorithms},
                      {"device waits", asked.waits},
                      {"device copies", asked.copies},
                      {"bytes copied", asked.copied_bytes},
                      {"blocks allocated", asked.blocks}};
    drawer_->end_frame(stats);
    if (f.has_layers) f.layers.count(stats);
  }

  std::unique_ptr<SurfaceDrawer> drawer_;
  SurfaceDrawer::Kind kind_;
  std::uint64_t memory_limit_;
  /// Of the device, without what this has taken; asked again after the first frame. 0: not known.
  std::uint64_t free_bytes_ = parallel::driver_status().free_bytes;
  bool has_drawn_ = false;
  parallel::Threads& threads_;
  Exec exec_;
  DeviceTextures<Exec> textures_;
  HostBand host_;
};

}  // namespace rastrum::raster
