// SPDX-License-Identifier: BSD-3-Clause
#include "rates.hpp"

#include <algorithm>
#include <limits>

#include <bench/report.hpp>

#include "device.hpp"

namespace rastrum::bench {
namespace {

/// Words of 64 bits: 256 MiB, several times the caches of any GPU.
constexpr std::size_t kWords = std::size_t{1} << 25;
constexpr int kRateRepeats = 7;

/// 10⁹ bytes a second, the best of several; the first is not counted.
template <class F>
double best_gbs(double bytes, F&& f) {
  double best = 0;
  for (int i = 0; i <= kRateRepeats; ++i) {
    const double ms = timed_ms(f);
    if (i > 0) best = std::max(best, bytes / ms / 1e6);
  }
  return best;
}

std::size_t words_of(const TableOptions& options) {
  return options.quick ? kWords / 256 : kWords;
}

}  // namespace

MachineLimits measure_device(const TableOptions& options) {
  WordInput input;
  input.words.assign(words_of(options), 1);
  DeviceWords device(input);
  MachineLimits limits;
  limits.copy_gbs = best_gbs(2.0 * sizeof(std::uint64_t) * static_cast<double>(input.words.size()),
                             [&] { device.run(Word::copy); });
  limits.read_gbs = limits.write_gbs = limits.stream_gbs = limits.copy_gbs;
  limits.gflops = limits.gflops_fma = std::numeric_limits<double>::infinity();
  return limits;
}

std::string device_note(const TableOptions& options, const MachineLimits& device) {
  std::vector<std::uint64_t> host(words_of(options), 1);
  const std::size_t bytes = host.size() * sizeof(host[0]);
  DeviceMemory memory(bytes);
  const double over =
      best_gbs(static_cast<double>(bytes), [&] { memory.write(host.data(), bytes); });
  const double back =
      best_gbs(static_cast<double>(bytes), [&] { memory.read(host.data(), bytes); });
  return options.gpu + ": its memory copies " + significant(device.copy_gbs) +
         " GB/s (read and written, measured by a word in this run); pageable memory of the host "
         "goes over at " +
         significant(over) + " GB/s and comes back at " + significant(back) +
         ". \"cuda\" copies the caller's arrays over each frame and the picture back, \"cuda, in "
         "place\" has both there. The floor is positions and indices read once and 4 bytes a pixel "
         "written once at the copy's bandwidth.";
}

double floor_ms(std::uint64_t triangles, std::uint64_t pixels, const MachineLimits& device,
                std::uint64_t vertices) {
  if (vertices == 0) vertices = triangles / 2;
  const std::uint64_t bytes = 12 * vertices + 12 * triangles + 4 * pixels;
  return static_cast<double>(bytes) / device.copy_gbs / 1e6;
}

void Rates::add(const std::string& row, const std::string& column, std::uint64_t items, double ms,
                double floor_ms) {
  figures_.push_back({row, column, items, ms, floor_ms});
}

void Rates::add_to(Document& document) const {
  Grid grid{name_ + ": 10⁶ " + items_ + " a second (and times the floor)", {first_column_}, {}};
  for (const Figure& f : figures_) {
    std::string& cell = grid.cell(f.row, f.column);
    if (f.ms <= 0) continue;
    cell = significant(static_cast<double>(f.items) / f.ms / 1e3) + " (" +
           significant(f.ms / f.floor_ms) + ")";
    document.figures.push_back({{"table", grid.caption},
                                {"row", f.row},
                                {"column", f.column},
                                {"items", f.items},
                                {"ms", f.ms},
                                {"floor_ms", f.floor_ms}});
  }
  document.grids.push_back(std::move(grid));
}

}  // namespace rastrum::bench
