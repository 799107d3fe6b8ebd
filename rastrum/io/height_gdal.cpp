// GeoTIFF through GDAL: the first band, its value for "no data" a void. Without the library at
// build time the function says what to install.
#include <rastrum/io/height_map.hpp>

#ifdef RASTRUM_HAS_GDAL
#include <gdal.h>
#include <ogr_srs_api.h>

#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include <rastrum/io/mapped_file.hpp>
#endif

namespace rastrum::io {
#ifdef RASTRUM_HAS_GDAL
namespace {

/// GDAL would print on stderr; what it says goes into our error instead.
struct Quiet {
  Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~Quiet() { CPLPopErrorHandler(); }
};

/// Metres along a row of pixels; 1 where the file does not say.
double cell_metres(GDALDatasetH data) {
  double t[6];
  if (GDALGetGeoTransform(data, t) != CE_None) return 1;
  const double step = std::hypot(t[1], t[4]);
  if (!std::isfinite(step) || !(step > 0)) return 1;
  constexpr double kMetresPerDegree = 111320;
  const OGRSpatialReferenceH where = GDALGetSpatialRef(data);
  if (where != nullptr && OSRIsGeographic(where) != 0) return step * kMetresPerDegree;
  const double unit = where != nullptr ? OSRGetLinearUnits(where, nullptr) : 1;
  return unit > 0 ? step * unit : step;
}

}  // namespace

HeightGrid read_height_gdal(const std::filesystem::path& file) {
  static std::once_flag registered;
  std::call_once(registered, GDALAllRegister);
  { const MappedFile exists(file); }  // our own words for a file that cannot be read
  const Quiet quiet;
  const auto fail = [&](const char* what) {
    throw Error(Errc::bad_format, file.string() + ": " + what + ": " + CPLGetLastErrorMsg());
  };
  const char* const drivers[] = {"GTiff", nullptr};
  const std::unique_ptr<void, void (*)(void*)> data(
      GDALOpenEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, nullptr, nullptr),
      [](void* d) { GDALClose(d); });
  if (!data) fail("is no sound GeoTIFF");
  const int width = GDALGetRasterXSize(data.get()), height = GDALGetRasterYSize(data.get());
  if (GDALGetRasterCount(data.get()) < 1) fail("holds no band of heights");
  if (width > kMaxImageSize || height > kMaxImageSize)
    throw Error(Errc::unsupported, file.string() + ": its size " + std::to_string(width) + "x" +
                                       std::to_string(height) + " is above 32768x32768");
  const GDALRasterBandH band = GDALGetRasterBand(data.get(), 1);
  HeightGrid grid{Image<float>(width, height), cell_metres(data.get())};
  if (GDALRasterIO(band, GF_Read, 0, 0, width, height, grid.heights.pixels().data(), width, height,
                   GDT_Float32, 0, 0) != CE_None)
    fail("its heights cannot be read");
  int has_void = 0;
  const auto no_data = static_cast<float>(GDALGetRasterNoDataValue(band, &has_void));
  if (has_void != 0)
    for (float& h : grid.heights.pixels())
      if (h == no_data) h = std::numeric_limits<float>::quiet_NaN();
  return grid;
}

#else

HeightGrid read_height_gdal(const std::filesystem::path& file) {
  throw Error(Errc::unsupported, file.string() +
                                     ": GeoTIFF needs GDAL, which was not there when rastrum was "
                                     "built (Debian: libgdal-dev)");
}

#endif
}  // namespace rastrum::io
