// SPDX-License-Identifier: BSD-3-Clause
// A frame of the façade on a device. The host's arrays are copied over. Then, for each band of
// rows, a SurfaceDrawer draws keys, and the device (band_images.cuh) or the host's threads
// (host_band.cuh) resolve them. This file joins the floors of pieces and of layers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
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
#include <rastrum/raster/context/request.hpp>
#include <rastrum/raster/context/stopwatch.hpp>
#include <rastrum/raster/cuda/resolve.cuh>
#include <rastrum/raster/cuda/samples.cuh>
#include <rastrum/raster/cuda/shading.cuh>
#include <rastrum/raster/cuda/surface_drawer.cuh>
#include <rastrum/raster/cuda/tested.cuh>
#include <rastrum/raster/cuda/upload.cuh>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/draws/numbering.hpp>
#include <rastrum/raster/frame/driver.hpp>
#include <rastrum/raster/resolve/resolve.hpp>
#include <rastrum/raster/shade/shader.hpp>
#include <rastrum/render/cuda/band_images.cuh>
#include <rastrum/render/cuda/host_band.cuh>
#include <rastrum/render/cuda/layers.cuh>
#include <rastrum/render/cuda/rasterizer.hpp>

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
        counts_(parallel::pinned_buffer(exec_, 0)),
        arrays_(exec_, threads_),
        textures_(exec_),
        host_(memory, threads) {}

  [[nodiscard]] std::string why_not(const FrameRequest& request) const override {
    if (has_tests(request) && request.test.own() != nullptr)
      return "a caller's fragment test (discard) is code of the CPU";
    if (!request.needs_layers()) return {};
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

  /// begin_frame fills it in this order.
  struct Frame {
    Frame(FrameRequest& r, Exec& exec, KeptArrays<Exec>& kept)
        : request(r), uploads(exec, kept, r.device.in_place) {}

    FrameRequest& request;
    Stopwatch watch;
    FrameStats stats;
    Totals totals;
    bool resolves = false;          ///< on the device
    bool has_layers = false;        ///< something is blended
    bool in_colors = false;         ///< layers need a colour; so does each of several samples
    bool shades_fragments = false;  ///< the drawer sets colours
    std::uint64_t textures_before = 0, arrays_before = 0;
    parallel::cuda_system::DeviceTally asked = parallel::cuda_system::device_tally();
    Uploads<Exec> uploads;
    std::vector<cuda_detail::HostVertices> made;
    std::vector<DeviceDraw> draws;
    std::optional<DeviceShading<Exec>> look;
    SamplePattern samples;
    DeviceSplit split;
    std::optional<DeviceScene<Exec>> scene;
    FrameGeometry geometry;  ///< for the host's shading
    std::optional<parallel::ScratchPool<ShaderScratch>> shaders;
    transparency::SceneLayers layers;
    std::uint64_t bands = 0, listed = 0;
  };

  /// In the order of the device's array.
  struct BandCounts {
    BandSums sums{};
    decltype(transparency::LayerQueueCounts::of) layers{};
  };

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
          sums(parallel::make_buffer<std::uint64_t>(exec, sizeof(BandCounts) / 8)),
          left_room(parallel::make_buffer<Piece>(
              exec, static_cast<std::size_t>(frame.split.left_pieces))),
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
    parallel::DeviceBuffer<Vec4> colors;         ///< at the places of the keys
    parallel::DeviceBuffer<std::uint64_t> sums;  ///< BandCounts
    parallel::DeviceBuffer<Piece> left_room;     ///< empty: pieces are not queued
    DeviceSurface surface;

    [[nodiscard]] LeftPieces left() {
      return {parallel::view_of(left_room), sums.data() + kLeftSum};
    }
    [[nodiscard]] std::uint64_t* covered() { return sums.data() + kCoveredSum; }
    [[nodiscard]] std::uint64_t* held() { return sums.data() + kHeldSum; }
  };

  [[nodiscard]] FrameStats render(FrameRequest& request, const StopToken* stop) override {
    return parallel::on_device_of(exec_, [&] { return draw_frame(request, stop); });
  }

  [[nodiscard]] FrameStats draw_frame(FrameRequest& request, const StopToken* stop) {
    const StopScope scope(stop);
    Frame frame(request, exec_, arrays_);
    frame.totals = request.device.in_place
                       ? number_draws(request.draws, request.pass.first_id, request.names)
                       : raster::begin_frame(request);
    try {
      begin_frame(frame);
      for (int y = 0; y < request.height; y += frame.split.band_rows)
        draw_band(frame,
                  {0, y, request.width, std::min(y + frame.split.band_rows, request.height)});
    } catch (const Error& error) {
      settle();
      // The host finds the index that was out of range.
      if (error.code() == Errc::invalid_argument && !request.device.in_place)
        check_indices(request.draws, request.names);
      throw;
    } catch (...) {
      settle();  // while the frame's own arrays are there
      throw;
    }
    end_frame(frame);
    // The driver reserves local memory when a kernel that needs more is first launched.
    if (free_bytes_ != 0 && !has_drawn_)
      free_bytes_ = parallel::driver_status().free_bytes + exec_.memory()->held();
    has_drawn_ = true;
    return std::move(frame.stats);
  }

  void settle() noexcept {
    exec_.settle();
    arrays_.forget();
  }
  /// The limit of scratch in bytes, without copies of arrays: as asked for, or three quarters of
  /// what is free. 0: none.
  [[nodiscard]] std::uint64_t limit() const {
    if (memory_limit_ != 0) return memory_limit_;
    return free_bytes_ == 0
               ? 0
               : (free_bytes_ - std::min(free_bytes_, exec_.memory()->in_use())) / 4 * 3;
  }
  /// Bytes that a pixel of a band takes besides its key.
  [[nodiscard]] std::uint64_t pixel_bytes(const Frame& f) const {
    const Targets& targets = f.request.targets;
    const auto planes = static_cast<std::uint64_t>(f.samples.count);
    return (planes - 1) * sizeof(std::uint64_t) + (f.in_colors ? planes * sizeof(Vec4) + 1 : 0) +
           kind_.pixel_bytes + (targets.overdraw.empty() ? 0 : sizeof(std::uint32_t)) +
           (f.resolves ? sizeof(std::uint32_t) : 0) +
           (f.resolves && !f.request.device.in_place ? DeviceTargets::bytes_of(targets) : 0);
  }

  void begin_frame(Frame& f) {
    FrameRequest& request = f.request;
    if (request.device.after)
      parallel::cuda_system::wait_for(exec_.stream(), request.device.after->handle);
    drawer_->begin_frame();
    f.arrays_before = arrays_.copies();
    f.draws = upload(f.uploads, request, threads_, f.made);
    f.watch.lap(f.stats, "upload");
    f.resolves = can_resolve(request);
    f.textures_before = textures_.copies();
    f.look.emplace(exec_, f.uploads, textures_, request);
    if (request.device.in_place && !f.resolves)
      throw Error(Errc::unsupported,
                  "arrays in the device's memory (in_place): this shader needs them in the host's");
    f.has_layers = blends(request.draws, request.transparency);
    f.samples = SamplePattern::of(request.samples);
    f.in_colors = f.has_layers || f.samples.count > 1;
    f.shades_fragments = kind_.shades && f.resolves && wants_colors(request.targets);
    f.split = DeviceSplit::of(limit(), request.width, request.height, f.totals.primitives,
                              f.totals.vertices, pixel_bytes(f), left_primitives(f));
    f.scene.emplace(exec_, f.draws, request.width, request.height, request.pass.first_id,
                    f.split.project_first);
    f.watch.lap(f.stats, "project");
    f.geometry = {request.width, request.height, Viewport::of(request.width, request.height),
                  request.draws, nullptr,        request.isa};
    f.shaders.emplace([&request] {
      ShaderScratch scratch;
      scratch.begin(scratch_bytes(request.shading));
      return scratch;
    });
  }

  [[nodiscard]] static std::uint32_t skipped(const Frame& f) {
    return (f.has_layers ? kTranslucent : 0) | (f.look->has_test() ? kMayDrop : 0);
  }
  /// How many primitives may leave such pieces. 0: the drawer queues none.
  [[nodiscard]] std::uint64_t left_primitives(const Frame& f) const {
    if (!kind_.leaves_pieces) return 0;
    std::uint64_t n = 0;
    for (const Draw& draw : f.request.draws)
      if ((draw.any_flags() & skipped(f)) != 0) n += draw.primitive_count;
    return n;
  }

  void begin_band(Frame& f, Band& band) {
    if (f.request.pass.load)
      host_.load(exec_, f.request, band.view, band.keys);
    else
      parallel::clear(exec_, band.keys);
    parallel::clear(exec_, band.overdraw);
    parallel::clear(exec_, band.sums);
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
    drawer_->draw(exec_, *f.scene, band.surface, f.split, skipped(f), band.left(), colors,
                  band.sums.data());
    if (band.left_room.size() == 0 || !finish_band(f, band, test, true)) {
      // Without a queue, or if it was too small, pieces are made again, in lists that fit into
      // memory.
      if (band.left_room.size() > 0) {
        ++f.listed;
        band.left_room = {};
        if (memory_limit_ != 0) exec_.memory()->trim();
      }
      finish_band(f, band, test, false);
    }
    if (band.overdraw.size() > 0) host_.store_overdraw(exec_, request.targets, view, band.overdraw);
    f.watch.lap(f.stats, "shade");
  }

  /// The work after the drawer: tested pieces, colours, layers and targets. `by_queues`: pieces
  /// left by the drawer lie in the band's queue, and the only wait is for the picture. Returns
  /// false, with none of these drawn, if the queue was too small.
  bool finish_band(Frame& f, Band& band, const TestOnDevice& test, bool by_queues) {
    const std::uint32_t layers = f.has_layers ? kTranslucent : 0;
    if (f.look->has_test()) {
      if (by_queues)
        draw_tested(exec_, band.surface, band.left(), layers, test, band.sums.data());
      else
        f.stats.fragments += draw_tested(exec_, *f.scene, band.surface, f.split, layers, test);
    }
    f.watch.lap(f.stats, "rasterize");
    if (!f.resolves) {
      const BandCounts counts = wait_for(band);
      if (by_queues && counts.sums[kHeldSum] != 0) return false;
      f.stats.pixels_covered +=
          host_.resolve(exec_, f.request, f.geometry, band.view, band.keys, *f.shaders);
      end_band(f, counts.sums);
      return true;
    }
    bool done = true;
    f.look->with(f.scene->geometry(), test, [&](const auto& shade, const auto& keeps) {
      done = resolve_band(f, band, shade, keeps, by_queues);
    });
    return done;
  }

  [[nodiscard]] BandCounts wait_for(const Band& band) {
    static_assert(sizeof(BandCounts) % sizeof(std::uint64_t) == 0);
    BandCounts counts;
    counts_.resize(sizeof counts);
    parallel::cuda_system::copy(exec_.stream(), counts_.data(), band.sums.data(), sizeof counts);
    exec_.wait();
    std::memcpy(&counts, counts_.data(), sizeof counts);
    check_valid(counts.sums[kInvalidSum]);
    return counts;
  }
  void end_band(Frame& f, const BandSums& sums) {
    drawer_->end_band(sums);
    f.stats.fragments += sums[kFragmentsSum];
    f.stats.pixels_covered += sums[kCoveredSum];
    // Each band sets up all primitives, so the first band's counts are the frame's.
    if (f.bands++ > 0) return;
    FrameStats::Triangles& t = f.stats.triangles;
    t.dropped = sums[kDroppedSum];
    t.culled = sums[kCulledSum];
    t.clipped = sums[kClippedSum];
  }

  /// Makes the colours of a band, its layers and samples, and its targets. Returns as finish_band.
  template <class Shade, class Keeps>
  bool resolve_band(Frame& f, Band& band, const Shade& shade, const Keeps& keeps, bool by_queues) {
    BandCounts counts;
    const auto finish = [&](const auto& shader, const std::uint64_t* held) {
      band.images.resolve(f.request, shader, band.surface, band.covered(), held);
      counts = wait_for(band);
      const bool done = held == nullptr || counts.sums[kHeldSum] == 0;
      if (done) band.images.deliver(threads_);
      return done;
    };
    const auto end = [&](bool done) {
      if (done) end_band(f, counts.sums);
      return done;
    };
    if (!f.in_colors && !f.shades_fragments)
      return end(finish(shade, by_queues ? band.held() : nullptr));
    const std::span<Vec4> colors = parallel::view_of(band.colors);
    const ColorsOfSurface drawn{band.surface, band.colors.data()};
    const auto finish_colors = [&](const std::uint64_t* held) {
      if (f.samples.count > 1) mean_of_samples(exec_, band.surface, colors, held);
      finish(drawn, held);
      return transparency::LayerQueueCounts{counts.layers, counts.sums[kLeftSum]};
    };
    const auto blend = [&](const auto& shader) {
      if (!f.has_layers || !by_queues) {
        if (f.has_layers)
          f.layers.blend(exec_, *f.scene, band.surface, colors, f.request.transparency, shader,
                         keeps, f.split.batch, limit() / 8);
        finish_colors(nullptr);
        return true;
      }
      return f.layers.blend_left(exec_, queues_of(f, band, shader), band.surface, colors,
                                 f.request.transparency, shader, keeps, limit() / 8, finish_colors);
    };
    bool done = true;
    if (f.samples.count == 1) {
      // Tested pieces are drawn after the others, without colours.
      if (f.shades_fragments ? f.look->has_test() : f.has_layers)
        parallel::tabulate(exec_, band.colors,
                           cuda_detail::ColorOfElement<Shade>{band.surface.keys, shade});
      done = blend(shade);
    } else if constexpr (std::is_same_v<Shade, LitOnDevice>) {
      const ShadedOnce<Shade> once{f.scene->geometry(), f.samples, shade};
      shade_samples(exec_, band.surface, colors, once);
      done = blend(once);
    }
    if (f.samples.count > 1 || f.has_layers)
      f.watch.lap(f.stats, f.samples.count > 1 ? "samples" : "layers");
    return end(done);
  }

  /// Queues of a band's layers, with room for a quarter more records than in the last frame, or for
  /// a guess.
  template <class Shade>
  [[nodiscard]] transparency::LeftLayers queues_of(const Frame& f, Band& band,
                                                   const Shade& shade) const {
    constexpr std::uint64_t kRecordBytes = 2 * sizeof(Block) + sizeof(std::uint32_t);
    const std::uint64_t blocks = block_count(band.view), pieces = f.split.left_pieces;
    std::uint64_t records =
        layer_records_ == 0 ? 2 * pieces + 8 * blocks : layer_records_ + layer_records_ / 4;
    records = std::max<std::uint64_t>(records, 1024);
    bool stores = false;
    if constexpr (transparency::cuda::kHasRecords<Shade>) {
      // If pieces are so small that many have no pixel, storing records writes more than fragments
      // read.
      stores = shade.wants_records() && pieces <= 32 * blocks;
      if (f.split.left_bytes != 0)
        stores = stores && pieces <= f.split.left_bytes / sizeof(typename Shade::Record);
    }
    if (f.split.left_bytes != 0) records = std::min(records, f.split.left_bytes / kRecordBytes);
    return {band.left(), static_cast<std::size_t>(records), stores, band.sums.data() + kBandSums,
            band.held()};
  }

  /// As FragmentColors::shade. It must not outlive the arrays of `shade`.
  template <class Shade>
  [[nodiscard]] auto shade_fragments(const SurfaceView& keys, const Shade& shade) {
    return [this, keys, shade](std::span<const std::uint32_t> element,
                               std::span<const std::uint64_t> key, std::span<Vec4> colors) {
      parallel::tabulate(exec_, colors, ColorOfFragment<Shade>{keys, element, key, shade});
    };
  }

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
                      {"bands listed", f.listed},
                      {"arrays copied", arrays_.copies() - f.arrays_before},
                      {"textures copied", textures_.copies() - f.textures_before},
                      {"launches", asked.launches},
                      {"device algorithms", asked.algorithms},
                      {"device waits", asked.waits},
                      {"device copies", asked.copies},
                      {"bytes copied", asked.copied_bytes},
                      {"blocks allocated", asked.blocks}};
    drawer_->end_frame(stats);
    if (!f.has_layers) return;
    f.layers.count(stats);
    layer_records_ = f.layers.most_records();
  }

  std::unique_ptr<SurfaceDrawer> drawer_;
  SurfaceDrawer::Kind kind_;
  std::uint64_t memory_limit_;
  /// The device's free memory and what this object holds, read again after the first frame; 0:
  /// unknown.
  std::uint64_t free_bytes_ = parallel::driver_status().free_bytes;
  bool has_drawn_ = false;
  std::uint64_t layer_records_ = 0;  ///< the most of a band, in the last frame with layers
  parallel::Threads& threads_;
  Exec exec_;
  parallel::Buffer<std::byte> counts_;  ///< BandCounts, pinned
  KeptArrays<Exec> arrays_;
  DeviceTextures<Exec> textures_;
  HostBand host_;
};

}  // namespace rastrum::raster
