// The rows of the coverage axis.
#include <array>

#include <rastrum/raster/coverage/binned.hpp>
#include <rastrum/raster/coverage/coverage.hpp>
#include <rastrum/raster/coverage/grouped.hpp>
#include <rastrum/raster/coverage/pineda.hpp>
#include <rastrum/raster/coverage/scanline.hpp>

namespace rastrum::raster {

std::span<const CoverageRow> coverages() noexcept {
  static constexpr std::array kTable{
      CoverageRow{
          "grouped",
          "(bin, piece) pairs sorted in groups of triangles; a thread owns a bin and shades "
          "it in cache",
          true, false, 160, make_grouped},
      CoverageRow{"scanline", "triangles expanded to rows, rows to columns, at once into the frame",
                  false, true, 116, make_scanline},
      CoverageRow{"pineda",
                  "bins and tiles by edge functions and masks, small triangles apart, at once into "
                  "the frame",
                  false, true, 120, make_pineda},
      CoverageRow{
          "binned",
          "batches of 32 triangles; large ones go through a queue of bins, whose tiles are dealt "
          "out in equal shares or whose bins belong to workers (paper 2)",
          false, true, 128, make_binned},
  };
  return kTable;
}

}  // namespace rastrum::raster
