// SPDX-License-Identifier: BSD-3-Clause
// GeoTIFF through GDAL: the first band in its units, with its scale and offset, north up. Cells of
// the value "no data", outside the mask or with alpha 0 are voids. The library is loaded when first
// used: linked, its hundred libraries would add 50 ms to every start of the program (3 ms without).
// Without it an error says what to install.
#include <rastrum/io/parse.hpp>

#ifdef RASTRUM_GDAL_LIBRARY
#include <dlfcn.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/io/reading.hpp>
#endif

namespace rastrum::io {
#ifdef RASTRUM_GDAL_LIBRARY
namespace {

class Gdal {
 public:
  static const Gdal& get(const std::string& name) {
    static const Gdal gdal(name);
    return gdal;
  }

 private:
  struct Symbol {
    void* address;
    template <class F>
    operator F*() const {  // NOLINT(google-explicit-constructor)
      return reinterpret_cast<F*>(address);
    }
  };

  explicit Gdal(const std::string& name) : name_(name) { register_all(); }
  [[nodiscard]] void* open_library() const {
    void* const library = ::dlopen(RASTRUM_GDAL_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr)
      throw Error(Errc::unsupported, name_ + ": GeoTIFF needs " RASTRUM_GDAL_LIBRARY
                                             ", which this machine lacks (Debian: libgdal-dev)");
    return library;
  }
  [[nodiscard]] Symbol find(const char* name) const {
    void* const address = ::dlsym(library_, name);
    if (address == nullptr)
      throw Error(Errc::unsupported,
                  name_ + ": " RASTRUM_GDAL_LIBRARY " here is of another version (no " + name +
                      "); build rastrum against it");
    return {address};
  }

  std::string name_;
  void* library_ = open_library();

 public:
  decltype(GDALAllRegister)* register_all = find("GDALAllRegister");
  decltype(GDALOpenEx)* open = find("GDALOpenEx");
  decltype(GDALClose)* close = find("GDALClose");
  decltype(GDALGetRasterXSize)* x_size = find("GDALGetRasterXSize");
  decltype(GDALGetRasterYSize)* y_size = find("GDALGetRasterYSize");
  decltype(GDALGetRasterCount)* count = find("GDALGetRasterCount");
  decltype(GDALGetRasterBand)* band = find("GDALGetRasterBand");
  decltype(GDALRasterIO)* raster_io = find("GDALRasterIO");
  decltype(GDALGetRasterNoDataValue)* no_data = find("GDALGetRasterNoDataValue");
  decltype(GDALGetRasterScale)* scale = find("GDALGetRasterScale");
  decltype(GDALGetRasterOffset)* offset = find("GDALGetRasterOffset");
  decltype(GDALGetMaskFlags)* mask_flags = find("GDALGetMaskFlags");
  decltype(GDALGetMaskBand)* mask_band = find("GDALGetMaskBand");
  decltype(GDALGetGeoTransform)* geo_transform = find("GDALGetGeoTransform");
  decltype(GDALGetSpatialRef)* spatial_ref = find("GDALGetSpatialRef");
  decltype(OSRIsGeographic)* is_geographic = find("OSRIsGeographic");
  decltype(OSRGetLinearUnits)* linear_units = find("OSRGetLinearUnits");
  decltype(CPLPushErrorHandler)* push_handler = find("CPLPushErrorHandler");
  decltype(CPLPopErrorHandler)* pop_handler = find("CPLPopErrorHandler");
  decltype(CPLQuietErrorHandler)* quiet_handler = find("CPLQuietErrorHandler");
  decltype(CPLGetLastErrorMsg)* last_error = find("CPLGetLastErrorMsg");
};

/// Keeps GDAL's messages from stderr. They go into our errors.
class Quiet {
 public:
  explicit Quiet(const Gdal& gdal) : gdal_(gdal) { gdal.push_handler(gdal.quiet_handler); }
  ~Quiet() { gdal_.pop_handler(); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  const Gdal& gdal_;
};

bool is_south_up(const Gdal& gdal, GDALDatasetH data) {
  double t[6];
  return gdal.geo_transform(data, t) == CE_None && t[5] > 0;
}

/// Metres along a row of pixels; none if the file does not say.
std::optional<double> cell_metres(const Gdal& gdal, GDALDatasetH data) {
  double t[6];
  if (gdal.geo_transform(data, t) != CE_None) return std::nullopt;
  const double step = std::sqrt(t[1] * t[1] + t[4] * t[4]);
  if (!std::isfinite(step) || !(step > 0)) return std::nullopt;
  constexpr double kMetresPerDegree = 111320;
  const OGRSpatialReferenceH where = gdal.spatial_ref(data);
  if (where != nullptr && gdal.is_geographic(where) != 0) return step * kMetresPerDegree;
  const double unit = where != nullptr ? gdal.linear_units(where, nullptr) : 1;
  return unit > 0 ? step * unit : step;
}

}  // namespace

HeightGrid read_height_gdal(const std::filesystem::path& file, const ReadOptions& options) {
  const FloatScope floats;
  const std::size_t bytes = MappedFile(file).bytes().size();  // for our own error messages
  const Gdal& gdal = Gdal::get(file.string());
  const Quiet quiet(gdal);
  const auto fail = [&](const char* what) {
    throw Error(Errc::bad_format, file.string() + ": " + what + ": " + gdal.last_error());
  };
  const char* const drivers[] = {"GTiff", nullptr};
  const std::unique_ptr<void, decltype(GDALClose)*> data(
      gdal.open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, nullptr, nullptr),
      gdal.close);
  if (!data) fail("is not a valid GeoTIFF");
  const int width = gdal.x_size(data.get()), height = gdal.y_size(data.get());
  if (gdal.count(data.get()) < 1) fail("holds no band of heights");
  if (width > kMaxImageSize || height > kMaxImageSize)
    throw Error(Errc::unsupported, file.string() + ": its size " + std::to_string(width) + "x" +
                                       std::to_string(height) + " is above 32768x32768");
  const GDALRasterBandH band = gdal.band(data.get(), 1);
  const std::optional<double> metres = cell_metres(gdal, data.get());
  constexpr std::size_t kWithMask = sizeof(float) + sizeof(std::uint8_t);
  Budget budget(file.string(), bytes, options);
  HeightGrid grid{budget.image<float>(width, height, kWithMask), metres.value_or(1),
                  metres.has_value()};
  if (gdal.raster_io(band, GF_Read, 0, 0, width, height, grid.heights.pixels().data(), width,
                     height, GDT_Float32, 0, 0) != CE_None)
    fail("its heights cannot be read");
  int has_void = 0;
  const double no_data = gdal.no_data(band, &has_void);
  if (has_void != 0)
    for (float& h : grid.heights.pixels())
      // GDAL compares so: this value is float64, the heights are float32.
      if (std::abs(static_cast<double>(h) - no_data) <= std::abs(no_data) * 1e-7)
        h = std::numeric_limits<float>::quiet_NaN();
  if ((gdal.mask_flags(band) & (GMF_ALL_VALID | GMF_NODATA)) == 0) {
    Image<std::uint8_t> seen(width, height);
    if (gdal.raster_io(gdal.mask_band(band), GF_Read, 0, 0, width, height, seen.pixels().data(),
                       width, height, GDT_Byte, 0, 0) != CE_None)
      fail("its mask cannot be read");
    for (std::size_t i = 0; i < seen.pixels().size(); ++i)
      if (seen.pixels()[i] == 0) grid.heights.pixels()[i] = std::numeric_limits<float>::quiet_NaN();
  }
  const double scale = gdal.scale(band, nullptr), offset = gdal.offset(band, nullptr);
  if (scale != 1 || offset != 0)
    for (float& h : grid.heights.pixels())
      h = static_cast<float>(static_cast<double>(h) * scale + offset);
  if (is_south_up(gdal, data.get()))
    for (int y = 0; y < height / 2; ++y)
      std::swap_ranges(&grid.heights(0, y), &grid.heights(0, y) + width,
                       &grid.heights(0, height - 1 - y));
  return grid;
}

#else

HeightGrid read_height_gdal(const std::filesystem::path& file, const ReadOptions&) {
  throw Error(
      Errc::unsupported,
      file.string() +
          ": GeoTIFF needs GDAL, but this rastrum was built without it (Debian: libgdal-dev)");
}

#endif
}  // namespace rastrum::io
