// SPDX-License-Identifier: BSD-3-Clause
// The entry points for height maps, and the raw format.
#include <rastrum/io.hpp>

#include <cmath>
#include <filesystem>
#include <new>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/lower.hpp>
#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>

namespace rastrum::io {
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
    size.width = size.height = static_cast<int>(side);
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
  const std::size_t first = size.big_endian ? 1 : 0;  // where the low byte lies
  for (std::size_t i = 0; i < values; ++i)
    grid.heights.pixels()[i] =
        static_cast<float>(std::to_integer<unsigned>(bytes[2 * i + first]) |
                           std::to_integer<unsigned>(bytes[2 * i + 1 - first]) << 8);
  return grid;
}

bool ends_at_edge(PathView file) {
  const std::string extension = lower(std::filesystem::path(file.text()).extension().string());
  return extension == ".dem" || extension == ".tif" || extension == ".tiff";
}

namespace {

/// Returns f(). If memory runs out, the error names `name`.
template <class F>
HeightGrid read_in_memory(const std::string& name, const F& f) {
  try {
    return f();
  } catch (const std::bad_alloc&) {
    throw Error(Errc::out_of_memory, name + ": there is not enough memory to read it");
  }
}

HeightGrid decode(std::span<const std::byte> bytes, std::string_view format,
                  const std::string& name, RawSize raw, const ReadOptions& options) {
  if (format.starts_with('.')) format.remove_prefix(1);
  const std::string kind = lower(std::string(format));
  if (kind == "png") return decode_height_png(bytes, name, options);
  if (kind == "npy") return decode_height_npy(bytes, name);
  if (kind == "dem") return decode_height_dem(bytes, name, options);
  if (kind == "raw" || kind == "bin" || kind == "r16") return decode_height_raw(bytes, name, raw);
  throw Error(Errc::unsupported, name +
                                     ": is no kind of height map that is read here (.png, .raw, "
                                     ".bin, .r16, .npy, .dem; as a file .tif, .tiff)");
}

}  // namespace

HeightGrid decode_heights(std::span<const std::byte> bytes, std::string_view format,
                          const std::string& name, RawSize raw, const ReadOptions& options) {
  const FloatScope floats;
  return read_in_memory(name, [&] { return decode(bytes, format, name, raw, options); });
}

HeightGrid read_heights(PathView name, RawSize raw, const ReadOptions& options) {
  const FloatScope floats;
  const std::filesystem::path file(name.text());
  const std::string extension = lower(file.extension().string());
  return read_in_memory(file.string(), [&] {
    if (extension == ".tif" || extension == ".tiff") return read_height_gdal(file, options);
    return read_mapped(file, [&](std::span<const std::byte> bytes) {
      return decode(bytes, extension, file.string(), raw, options);
    });
  });
}

}  // namespace rastrum::io
