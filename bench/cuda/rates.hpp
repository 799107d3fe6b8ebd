// SPDX-License-Identifier: BSD-3-Clause
// A device's figures beside the times in the tables: items a second, and the time over the floor
// (the bytes that a frame must read and write, over the measured bandwidth).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <bench/machine.hpp>
#include <bench/tables/document.hpp>
#include <bench/tables/options.hpp>

namespace rastrum::bench {

/// Measures the device's memory by a copy, best of several. Half of the bytes are read and half
/// written; floors treat both alike. `gflops` is infinite, since arithmetic is not measured.
[[nodiscard]] MachineLimits measure_device(const TableOptions& options);
/// The GPU, its bandwidth and the bus's, in words.
[[nodiscard]] std::string device_note(const TableOptions& options, const MachineLimits& device);

/// Positions and indices are read once, RGBA8 is written once. `vertices` 0: half the number of
/// triangles, as in closed meshes.
[[nodiscard]] double floor_ms(std::uint64_t triangles, std::uint64_t pixels,
                              const MachineLimits& device, std::uint64_t vertices = 0);

/// A grid of 10⁶ items a second and times over the floor. Cells without a measurement stay empty.
class Rates {
 public:
  Rates(std::string name, std::string first_column, std::string items = "triangles")
      : name_(std::move(name)), first_column_(std::move(first_column)), items_(std::move(items)) {}

  /// ms 0: not measured.
  void add(const std::string& row, const std::string& column, std::uint64_t items, double ms,
           double floor_ms);
  void add_to(Document& document) const;

 private:
  struct Figure {
    std::string row, column;
    std::uint64_t items;
    double ms, floor_ms;
  };
  std::string name_, first_column_, items_;
  std::vector<Figure> figures_;
};

}  // namespace rastrum::bench
