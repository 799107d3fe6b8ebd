// SPDX-License-Identifier: BSD-3-Clause
// The header of an NPY file (numpy.lib.format), 1.0 to 3.0: a magic, the length of a Python
// dictionary, the dictionary. Reads only what numpy.save writes: three keys, in any order.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <rastrum/io/parse.hpp>

namespace rastrum::io {

struct NpyHeader {
  std::string type;                  ///< as numpy has it: '<f4'
  bool fortran = false;              ///< the first axis is contiguous
  std::vector<std::size_t> shape{};  ///< not checked
  std::size_t data = 0;              ///< where the numbers begin
  /// Set by kKeepsFloat64 in a selection's small file: float64 stays, as the large file decides
  /// (wide_positions.hpp).
  bool keeps_float64 = false;

  /// As Python writes it.
  [[nodiscard]] std::string shape_text() const;
};

inline constexpr const char* kKeepsFloat64 = "'keeps_float64': True";

/// Throws Error{bad_format}, and Error{unsupported} for records, that name the file.
[[nodiscard]] NpyHeader parse_npy_header(Bytes bytes, const std::string& name);

/// A header as of numpy; numbers begin at a multiple of 64 bytes. `type` with its order.
[[nodiscard]] std::string npy_header_text(const std::string& type, const std::string& shape);

struct NpyTriangles {
  NpyHeader header;
  std::size_t count = 0;
  bool wide = false;  ///< float64
  [[nodiscard]] std::size_t bytes_each() const { return wide ? 72 : 36; }
};
/// Throws as parse_npy_header, Error{bad_format} if the file is shorter than its shape, and
/// Error{unsupported} unless it is (n, 3, 3) or (n, 9) of little-endian float32 or float64 in C
/// order.
[[nodiscard]] NpyTriangles parse_npy_triangles(Bytes bytes, const std::string& name);

}  // namespace rastrum::io
