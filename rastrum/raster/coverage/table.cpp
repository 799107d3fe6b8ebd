// The rows of the coverage axis.
#include <array>

#include <rastrum/raster/coverage/coverage.hpp>
#include <rastrum/raster/coverage/grouped.hpp>

namespace rastrum::raster {

std::span<const CoverageRow> coverages() noexcept {
  static constexpr std::array kTable{
      CoverageRow{
          "grouped",
          "(bin, piece) pairs sorted in groups of triangles; a thread owns a bin and shades "
          "it in cache",
          true, 160, make_grouped},
  };
  return kTable;
}

}  // namespace rastrum::raster
