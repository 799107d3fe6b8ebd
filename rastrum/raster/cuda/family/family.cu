// The coverages of the family on a device, instantiated, and the driver; visibilities.cu has the
// rest, so that two cores can compile. Tests compile these files as C++, for the CPU.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <rastrum/core/error.hpp>
#include <rastrum/raster/cuda/family/binned.cuh>
#include <rastrum/raster/cuda/family/family.cuh>
#include <rastrum/raster/cuda/family/hybrid.cuh>
#include <rastrum/raster/cuda/family/pineda.cuh>
#include <rastrum/raster/cuda/family/scanline.cuh>
#include <rastrum/raster/cuda/family/tiled.cuh>

namespace rastrum::raster::family {

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

template <class Exec>
Point<Exec> point_of(std::string_view coverage, std::string_view visibility) {
  return {row_of(kCoverages<Exec>, coverage), row_of(visibilities_on_device<Exec>(), visibility)};
}

struct IsDrawnIn {
  Rect view;
  std::uint32_t skip;
  RASTRUM_HD bool operator()(const Piece& piece) const {
    return (piece.flags & skip) == 0 && !piece_bounds(piece, view).empty();
  }
};

template <class Exec>
DeviceCounts draw_surface(Exec& exec, const DeviceScene<Exec>& scene, const DeviceSurface& surface,
                          const DevicePlan& plan, const Point<Exec>& point, const Tuning& tuning,
                          std::uint32_t skip, const Shading& shading, Counters& counters) {
  using parallel::view_of;
  FamilyFrame<Exec> frame(exec, surface, tuning, shading, plan.turn_bytes);
  const auto visibility = point.visibility->make(frame);
  frame.visibility = visibility.get();
  const IsDrawnIn keep{surface.view, skip};
  DeviceCounts counts;
  const std::uint64_t end = scene.first_id() + scene.primitives();
  for (std::uint64_t first = scene.first_id(); first < end; first += plan.batch) {
    parallel::throw_if_stopped();
    ++counts.batches;
    const Assembly assembly{scene.geometry(), first};
    const auto n = static_cast<std::size_t>(std::min(plan.batch, end - first));
    auto outcomes = parallel::make_buffer<Outcome>(exec, n);
    parallel::tabulate(exec, outcomes, raster::cuda_detail::CountPieces<IsDrawnIn>{assembly, keep});
    const Outcomes sum = parallel::reduce(exec, outcomes, Outcomes{}, AddOutcomes{});
    check_valid(sum);
    counts.sum = AddOutcomes{}(counts.sum, sum);
    if (sum.pieces == 0) continue;
    const auto drawn =
        parallel::filter(exec, parallel::counting<std::uint32_t>(n),
                         raster::cuda_detail::HasPieces{view_of(std::as_const(outcomes))});
    each_turn(drawn.size(), static_cast<std::size_t>(plan.written),
              [&](std::size_t from, std::size_t to) {
                const std::span<const std::uint32_t> which =
                    view_of(drawn).subspan(from, to - from);
                const auto pieces =
                    write_pieces(exec, assembly, which,
                                 parallel::permuted(view_of(std::as_const(outcomes)), which), keep);
                point.coverage->draw(frame, view_of(pieces));
              });
  }
  visibility->finish(frame);
  counts.fragments = frame.fragments;
  for (const auto& [name, value] : frame.counters) add_counter(counters, name, value);
  return counts;
}

template Point<parallel::Cuda> point_of<parallel::Cuda>(std::string_view, std::string_view);
template DeviceCounts draw_surface<parallel::Cuda>(parallel::Cuda&,
                                                   const DeviceScene<parallel::Cuda>&,
                                                   const DeviceSurface&, const DevicePlan&,
                                                   const Point<parallel::Cuda>&, const Tuning&,
                                                   std::uint32_t, const Shading&, Counters&);

}  // namespace rastrum::raster::family
