// SPDX-License-Identifier: BSD-3-Clause
// Takes PNG files apart and puts them together.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>

#include "tests/io/files.hpp"

namespace rastrum::test {

inline std::string png_chunk(const std::string& type, const std::string& data) {
  const std::string summed = type + data;
  const uLong sum =
      crc32(0, reinterpret_cast<const Bytef*>(summed.data()), static_cast<uInt>(summed.size()));
  return raw(static_cast<std::uint32_t>(data.size()), true) + summed +
         raw(static_cast<std::uint32_t>(sum), true);
}

struct PngParts {
  std::string head;    ///< up to the first IDAT
  std::string stream;  ///< of all IDATs
};
inline PngParts parts_of_png(const std::string& file) {
  PngParts png;
  for (std::size_t at = 8, size = 0; at + 12 <= file.size(); at += size + 12) {
    size = 0;
    for (std::size_t i = 0; i < 4; ++i)
      size = size << 8U | static_cast<unsigned char>(file[at + i]);
    if (file.compare(at + 4, 4, "IDAT") != 0) continue;
    if (png.head.empty()) png.head = file.substr(0, at);
    png.stream += file.substr(at + 8, size);
  }
  return png;
}

}  // namespace rastrum::test
