// The door of height_map.hpp, and the format that is nothing but its values.
#include <rastrum/io.hpp>

#include <cmath>
#include <new>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/io/mapped_file.hpp>

namespace rastrum::io {
namespace {

std::string lower(std::string s) {
  for (char& c : s)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return s;
}

HeightGrid decode(const std::string& extension, std::span<const std::byte> bytes,
                  const std::string& name, RawSize raw) {
  if (extension == ".png") return decode_height_png(bytes, name);
  if (extension == ".npy") return decode_height_npy(bytes, name);
  if (extension == ".dem") return decode_height_dem(bytes, name);
  if (extension == ".raw" || extension == ".bin" || extension == ".r16")
    return decode_height_raw(bytes, name, raw);
  throw Error(Errc::unsupported, name +
                                     ": is no kind of height map that is read here (.png, .raw, "
                                     ".bin, .r16, .npy, .dem, .tif, .tiff)");
}

}  // namespace

HeightGrid decode_height_raw(std::span<const std::byte> bytes, const std::string& name,
                             RawSize size) {
  const FloatScope floats;
  const std::size_t values = bytes.size() / 2;
  if (size.width == 0) {
    const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(values)));
    if (bytes.size() % 2 != 0 || side == 0 || side * side != values)
      throw Error(Errc::bad_format,
                  name + ": its " + std::to_string(bytes.size()) +
                      " bytes are no square of 16-bit heights; give its size (--height-size WxH)");
    if (side > static_cast<std::size_t>(kMaxImageSize))
      throw Error(Errc::unsupported, name + ": is wider than 32768");
    size = {static_cast<int>(side), static_cast<int>(side)};
  }
  HeightGrid grid;
  if (size.width < 1 || size.height < 1 || size.width > kMaxImageSize ||
      size.height > kMaxImageSize ||
      static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 2 !=
          bytes.size())
    throw Error(Errc::bad_format, name + ": has " + std::to_string(bytes.size()) + " bytes, but " +
                                      std::to_string(size.width) + "x" +
                                      std::to_string(size.height) + " heights of 16 bits take " +
                                      std::to_string(std::int64_t{2} * size.width * size.height));
  grid.heights = Image<float>(size.width, size.height);
  grid.units_per_cell = 257;
  for (std::size_t i = 0; i < values; ++i)
    grid.heights.pixels()[i] = static_cast<float>(std::to_integer<unsigned>(bytes[2 * i]) |
                                                  std::to_integer<unsigned>(bytes[2 * i + 1]) << 8);
  return grid;
}

HeightGrid read_heights(const std::filesystem::path& file, RawSize raw) {
  const FloatScope floats;
  const std::string extension = lower(file.extension().string());
  try {
    if (extension == ".tif" || extension == ".tiff") return read_height_gdal(file);
    const MappedFile mapped(file);
    return decode(extension, mapped.bytes(), file.string(), raw);
  } catch (const std::bad_alloc&) {
    throw Error(Errc::out_of_memory, file.string() + ": there is not enough memory to read it");
  }
}

}  // namespace rastrum::io
