// Height maps from files: a grid of heights and how many of its units make one cell of the map.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include <rastrum/core/image.hpp>

namespace rastrum::io {

/// Row 0 is at the top (north), columns go east.
struct HeightGrid {
  Image<float> heights{};  ///< as the file has them, voids NaN
  /// Units of `heights` that are as long as one cell is wide. Multiplying by 1 / units_per_cell
  /// gives the terrain its true proportions (DEM, GeoTIFF), or 16-bit values the range of 8-bit
  /// ones (257), which is that of the classic maps.
  double units_per_cell = 1;
  /// Whether the file says how long a cell is (DEM, GeoTIFF), or is of 8 bits, where a unit has
  /// been a cell since Voxel Space; else `units_per_cell` is a guess.
  bool scale_known = false;
};

/// The size of a raw file, which does not say it; 0: square.
struct RawSize {
  int width = 0, height = 0;
};

/// Reads heights from, by extension in any case:
///   .png            8 or 16-bit grey (colour only where red = green = blue), 0 to 255 or 65,535
///   .raw .bin .r16  uint16, little-endian, no header, `raw` wide and high
///   .npy            shape (H, W): float32/64, int or uint of 8, 16 or 32 bits, any byte order
///   .dem            USGS DEM, the ASCII format of 1024-byte records
///   .tif .tiff      GeoTIFF, where the library was built with GDAL
/// Up to 32,768 × 32,768. Throws Error{not_found | bad_format | unsupported | io | out_of_memory}
/// that names the file and the place in it. Cost: one pass over the file.
[[nodiscard]] HeightGrid read_heights(const std::filesystem::path& file, RawSize raw = {});

/// The readers behind it, over bytes in memory; `name` appears in errors.
[[nodiscard]] HeightGrid decode_height_png(std::span<const std::byte> bytes,
                                           const std::string& name);
[[nodiscard]] HeightGrid decode_height_raw(std::span<const std::byte> bytes,
                                           const std::string& name, RawSize size = {});
[[nodiscard]] HeightGrid decode_height_npy(std::span<const std::byte> bytes,
                                           const std::string& name);
[[nodiscard]] HeightGrid decode_height_dem(std::span<const std::byte> bytes,
                                           const std::string& name);
/// GDAL opens files itself.
[[nodiscard]] HeightGrid read_height_gdal(const std::filesystem::path& file);

}  // namespace rastrum::io
