// SPDX-License-Identifier: BSD-3-Clause
// USGS DEM ("Standards for Digital Elevation Models", part 2, appendix 2-A), the ASCII format: an A
// record with units and resolution, then a B record for each profile, from south to north, in
// blocks of 1,024 bytes (B records use 1,020). GDAL reads it, too, but is large; this reader serves
// every machine.
//
// Profiles of a UTM map begin and end at different northings, because its sides are not parallel to
// the grid. Cells that no profile reaches are voids, and so are the format's two values for them. C
// records (accuracy) are not read.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>
#include <rastrum/io/text_cursor.hpp>

namespace rastrum::io {
namespace {

constexpr std::size_t kBlock = 1024, kElevation = 6, kBlockUsed = 1020, kProfileHeader = 144;
constexpr double kMetresPerFoot = 0.3048;

struct Profile {
  double x = 0, y = 0, datum = 0;  ///< ground units, ground units, units of elevation
  std::size_t block = 0;           ///< where it begins
  std::size_t count = 0;
};

class DemReader {
 public:
  DemReader(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options)
      : text_(as_text(bytes)), name_(name), budget_(name, bytes.size(), options) {
    // Some files end each block with a line end.
    while (kBlock + line_end_ < text_.size() && line_end_ < 2 &&
           (text_[kBlock + line_end_] == '\r' || text_[kBlock + line_end_] == '\n'))
      ++line_end_;
  }

  [[nodiscard]] HeightGrid read() {
    if (text_.size() < kBlock)
      throw Error(Errc::bad_format,
                  name_ + ": is no USGS DEM: it ends inside its first record of 1024 bytes");
    const long ground = integer(0, 528, "the unit of ground coordinates");
    const long elevation = integer(0, 534, "the unit of elevation");
    step_x_ = resolution(816, "the resolution along x");
    step_y_ = resolution(828, "the resolution along y");
    const double step_z = resolution(840, "the resolution of elevation");
    if (elevation != 1 && elevation != 2) fail(0, 534, "the unit of elevation is neither 1 nor 2");
    if (ground < 0 || ground > 3) fail(0, 528, "the unit of ground coordinates is not 0 to 3");
    const long columns = integer(0, 858, "the number of profiles");
    if (columns < 1 || columns > kMaxImageSize)
      fail(0, 858, "the number of profiles is outside 1 to 32768");
    read_profiles(static_cast<std::size_t>(columns));
    HeightGrid grid = fill(step_z);
    const double metres = elevation == 1 ? kMetresPerFoot : 1;
    const double cell = step_y_ * (ground == 1   ? kMetresPerFoot
                                   : ground == 3 ? 30.87      // an arc second of latitude
                                   : ground == 0 ? 6378137.0  // radians
                                                 : 1.0);
    grid.units_per_cell = cell / metres;
    grid.scale_known = true;
    return grid;
  }

 private:
  [[noreturn]] void fail(std::size_t block, std::size_t column, const std::string& what) const {
    throw Error(Errc::bad_format, name_ + ": record " + std::to_string(block + 1) + ", byte " +
                                      std::to_string(column + 1) + ": " + what);
  }
  /// The text of a field, trimmed.
  [[nodiscard]] std::string_view field(std::size_t block, std::size_t column, std::size_t width,
                                       const char* what) const {
    const std::size_t at = block * (kBlock + line_end_) + column;
    if (at + width > text_.size()) fail(block, column, std::string("the file ends before ") + what);
    std::string_view s = text_.substr(at, width);
    const std::size_t first = s.find_first_not_of(' ');
    if (first == std::string_view::npos) fail(block, column, std::string(what) + " is missing");
    s.remove_prefix(first);
    s.remove_suffix(s.size() - 1 - s.find_last_not_of(' '));
    return s;
  }
  [[nodiscard]] long integer(std::size_t block, std::size_t column, const char* what) const {
    const std::string_view s = field(block, column, kElevation, what);
    long value = 0;
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
    if (error != std::errc{} || end != s.data() + s.size())
      fail(block, column, std::string(what) + " is no whole number: " + quoted(s));
    return value;
  }
  /// The exponent of Fortran's real numbers may begin with a D.
  [[nodiscard]] double real(std::size_t block, std::size_t column, std::size_t width,
                            const char* what) const {
    std::string s(field(block, column, width, what));
    std::replace(s.begin(), s.end(), 'D', 'E');
    const char* const begin = s.data() + (s[0] == '+' ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(begin, s.data() + s.size(), value);
    if (error != std::errc{} || end != s.data() + s.size() || !std::isfinite(value))
      fail(block, column, std::string(what) + " is no number: " + io::quoted(s));
    return value;
  }
  [[nodiscard]] double resolution(std::size_t column, const char* what) const {
    const double value = real(0, column, 12, what);
    if (!(value > 0)) fail(0, column, std::string(what) + " is not above 0");
    return value;
  }

  void read_profiles(std::size_t columns) {
    std::size_t block = 1;
    for (std::size_t i = 0; i < columns; ++i) {
      Profile p;
      p.block = block;
      const long count = integer(block, 12, "the number of elevations of a profile");
      if (count < 1 || count > kMaxImageSize)
        fail(block, 12, "the number of elevations of a profile is outside 1 to 32768");
      p.count = static_cast<std::size_t>(count);
      p.x = real(block, 24, 24, "the first ground coordinate of a profile");
      p.y = real(block, 48, 24, "the second ground coordinate of a profile");
      p.datum = real(block, 72, 24, "the datum of a profile");
      profiles_.push_back(p);
      constexpr std::size_t kFirst = (kBlockUsed - kProfileHeader) / kElevation;
      constexpr std::size_t kLater = kBlockUsed / kElevation;
      block += 1 + (p.count > kFirst ? (p.count - kFirst + kLater - 1) / kLater : 0);
    }
  }
  static std::pair<std::size_t, std::size_t> place(const Profile& p, std::size_t k) {
    const std::size_t at = kProfileHeader + k * kElevation;
    return {p.block + at / kBlockUsed, at % kBlockUsed};
  }

  HeightGrid fill(double step_z) {
    double min_x = profiles_[0].x, max_x = min_x, min_y = profiles_[0].y, max_y = min_y;
    for (const Profile& p : profiles_) {
      min_x = std::min(min_x, p.x);
      max_x = std::max(max_x, p.x);
      min_y = std::min(min_y, p.y);
      max_y = std::max(max_y, p.y + static_cast<double>(p.count - 1) * step_y_);
    }
    const double width = std::round((max_x - min_x) / step_x_) + 1;
    const double height = std::round((max_y - min_y) / step_y_) + 1;
    if (!(width <= kMaxImageSize && height <= kMaxImageSize))
      throw Error(Errc::bad_format, name_ +
                                        ": its profiles lie farther apart than 32768 steps of its "
                                        "resolution");
    // A damaged coordinate must not ask for a huge map; sound ones are mostly filled.
    if (width * height > 64.0 * static_cast<double>(text_.size()))
      throw Error(Errc::bad_format, name_ + ": its profiles are strewn over a map of " +
                                        std::to_string(static_cast<int>(width)) + "x" +
                                        std::to_string(static_cast<int>(height)) +
                                        " heights, which they do not fill");
    HeightGrid grid{budget_.image<float>(static_cast<int>(width), static_cast<int>(height)), 1};
    std::ranges::fill(grid.heights.pixels(), std::numeric_limits<float>::quiet_NaN());
    for (const Profile& p : profiles_) {
      const int x = static_cast<int>(std::round((p.x - min_x) / step_x_));
      const int south = static_cast<int>(std::round((p.y - min_y) / step_y_));
      for (std::size_t k = 0; k < p.count; ++k) {
        const auto [block, column] = place(p, k);
        const long value = integer(block, column, "an elevation");
        const int y = grid.heights.height() - 1 - south - static_cast<int>(k);
        if (y < 0) fail(block, column, "the profile is longer than the map");
        if (value > -32766)
          grid.heights(x, y) = static_cast<float>(static_cast<double>(value) * step_z + p.datum);
      }
    }
    return grid;
  }

  std::string_view text_;
  const std::string& name_;
  Budget budget_;
  std::size_t line_end_ = 0;
  double step_x_ = 1, step_y_ = 1;
  std::vector<Profile> profiles_;
};

}  // namespace

HeightGrid decode_height_dem(std::span<const std::byte> bytes, const std::string& name,
                             const ReadOptions& options) {
  const FloatScope floats;
  return DemReader(bytes, name, options).read();
}

}  // namespace rastrum::io
