// SPDX-License-Identifier: BSD-3-Clause
// The coverages of the family on a device, and the drawer of a band by a row of both axes.
// visibilities.cu has the other axis, so that two cores can compile. Tests compile these files as
// C++ for the CPU.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <papers/axes/cuda_rows.hpp>
#include <papers/paper1/hybrid.cuh>
#include <papers/paper1/pineda.cuh>
#include <papers/paper1/scanline.cuh>
#include <papers/paper1/tiled.cuh>
#include <papers/paper2/binned.cuh>
#include <papers/table/family.cuh>
#include <rastrum/error.hpp>
#include <rastrum/parallel/cuda/library.hpp>
#include <rastrum/render/cuda/make.cuh>
#include <rastrum/stop.hpp>

namespace rastrum::family {
namespace {

template <class Exec>
inline constexpr std::array kCoverages{
    CoverageOnDevice<Exec>{"scanline", draw_scanline<Exec>},
    CoverageOnDevice<Exec>{"pineda", draw_pineda<Exec>},
    CoverageOnDevice<Exec>{"tiled", draw_tiled<Exec>},
    CoverageOnDevice<Exec>{"hybrid", draw_hybrid<Exec>},
    CoverageOnDevice<Exec>{"binned", draw_binned<Exec>},
};
template <class Rows>
[[nodiscard]] auto row_of(const Rows& rows, std::string_view name) {
  const auto found = std::ranges::find(rows, name, &Rows::value_type::name);
  if (found == rows.end())
    throw Error(Errc::invalid_argument, std::string("a device has no '").append(name).append("'"));
  return &*found;
}

struct IsDrawnIn {
  Rect view;
  std::uint32_t skip;
  RASTRUM_HD bool operator()(const Piece& piece) const {
    return (piece.flags & skip) == 0 && !piece_bounds(piece, view).empty();
  }
};

struct AddSums {
  const std::uint64_t* from;
  std::uint64_t* to;
  RASTRUM_HD void operator()(std::size_t k) const { to[k] += from[k]; }
};

/// Draws by a point of the table. Counters: "batches of primitives", and the rows' own.
class RowOnDevice final : public SurfaceDrawer {
 public:
  using Exec = parallel::Cuda;

  /// Throws Error{invalid_argument} if a device has no row of that name.
  RowOnDevice(std::string_view coverage, std::string_view visibility, const Tuning& tuning)
      : tuning_(tuning),
        coverage_(*row_of(std::span(kCoverages<Exec>), coverage)),
        visibility_(*row_of(visibilities_on_device<Exec>(), visibility)) {}

  [[nodiscard]] Kind kind() const override {
    return {.rasterizer = coverage_.name,
            .visibility = visibility_.name,
            .why = "as asked for",
            .pixel_bytes = visibility_.pixel_bytes,
            .shades = visibility_.shades};
  }

  void draw(Exec& exec, const DeviceScene<Exec>& scene, const DeviceSurface& surface,
            const DeviceSplit& split, std::uint32_t skip, const LeftPieces& /*left*/,
            const FragmentColors& colors, std::uint64_t* sums) override {
    using parallel::view_of;
    FamilyFrame<Exec> frame(exec, surface, tuning_, colors, split.turn_bytes);
    const auto visibility = visibility_.make(frame);
    frame.visibility = visibility.get();
    const IsDrawnIn keep{surface.view, skip};
    Outcomes all;
    const std::uint64_t end = scene.first_id() + scene.primitives();
    for (std::uint64_t first = scene.first_id(); first < end; first += split.batch) {
      throw_if_stopped();
      ++batches_;
      const Assembly assembly{scene.geometry(), first};
      const auto n = static_cast<std::size_t>(std::min(split.batch, end - first));
      auto outcomes = parallel::make_buffer<Outcome>(exec, n);
      parallel::tabulate(exec, outcomes, cuda_detail::CountPieces<IsDrawnIn>{assembly, keep});
      const Outcomes sum = parallel::reduce(exec, outcomes, Outcomes{}, AddOutcomes{});
      check_valid(sum.invalid);
      all = AddOutcomes{}(all, sum);
      if (sum.pieces == 0) continue;
      const auto drawn = parallel::filter(exec, parallel::counting<std::uint32_t>(n),
                                          cuda_detail::HasPieces{view_of(std::as_const(outcomes))});
      each_turn(drawn.size(), static_cast<std::size_t>(split.written),
                [&](std::size_t from, std::size_t to) {
                  const std::span<const std::uint32_t> which =
                      view_of(drawn).subspan(from, to - from);
                  const auto pieces = write_pieces(
                      exec, assembly, which,
                      parallel::permuted(view_of(std::as_const(outcomes)), which), keep);
                  coverage_.draw(frame, view_of(pieces));
                });
    }
    visibility->finish(frame);
    const BandSums counted{all.dropped, all.culled, all.clipped, 0, frame.fragments};
    const auto on_device = parallel::upload(exec, counted);
    parallel::for_each_index(exec, kBandSums, AddSums{on_device.data(), sums});
    for (const auto& [name, value] : frame.counters) add_counter(counters_, name, value);
  }

  void begin_frame() override {
    batches_ = 0;
    counters_.clear();
  }
  void end_frame(FrameStats& stats) const override {
    stats.counters.emplace_back("batches of primitives", batches_);
    for (const auto& [name, value] : counters_) stats.counters.emplace_back(name, value);
  }

 private:
  const Tuning tuning_;
  const CoverageOnDevice<Exec>& coverage_;
  const VisibilityOnDevice<Exec>& visibility_;
  std::uint64_t batches_ = 0;
  Counters counters_;
};

std::unique_ptr<SurfaceDrawer> make_by_size(const Tuning& tuning) {
  raster::DeviceSizes sizes;
  if (tuning.small_px > 0) sizes.small_px = static_cast<std::uint64_t>(tuning.small_px);
  if (tuning.large_px > 0) sizes.large_px = static_cast<std::uint64_t>(tuning.large_px);
  return raster::make_by_size(sizes);
}

std::unique_ptr<CudaRasterizer> make_rasterizer(std::string_view coverage,
                                                std::string_view visibility, const Tuning& tuning,
                                                std::uint64_t memory_limit, MemoryAccount& memory,
                                                parallel::Threads& threads) {
  return make_device_rasterizer(coverage.empty()
                                    ? make_by_size(tuning)
                                    : std::make_unique<RowOnDevice>(coverage, visibility, tuning),
                                memory_limit, memory, threads);
}

constexpr CudaRows kCudaRows{make_rasterizer, make_cuda_terrain_renderer};
const parallel::AddedTable kAdded(kCudaRowsName, &kCudaRows);

}  // namespace

}  // namespace rastrum::family
