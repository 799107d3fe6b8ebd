// SPDX-License-Identifier: BSD-3-Clause
// Digests of pictures: two pictures are equal if their digests are, on whatever machine and in
// whatever way they were drawn (docs/conventions.md, "Equal pictures").
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <rastrum/image.hpp>

namespace RASTRUM_API rastrum {

/// SHA-256 (FIPS 180-4).
struct Digest {
  std::array<std::uint8_t, 32> bytes{};

  /// 64 lower-case hexadecimal digits.
  [[nodiscard]] std::string hex() const;
  bool operator==(const Digest&) const = default;
};

/// The digest of a line with type and shape, then the rows from the top, little-endian, without the
/// memory between rows. In Python, for an array `a` of such pixels:
///   hashlib.sha256(f"{a.dtype} {'x'.join(map(str, a.shape))}\n".encode() + a.tobytes())
/// where a shape is (height, width) or (height, width, channels): "uint8 720x1280x4" for 8-bit
/// colours. A NaN counts as 0x7fc00000, because processors differ in its sign and payload.
/// Cost: about 3.5 ms per megabyte. Throws Error{invalid_argument} for rows that overlap.
[[nodiscard]] Digest digest(ImageView<const Rgba8> image);
[[nodiscard]] Digest digest(ImageView<const Vec4> image);  ///< float32, four channels
[[nodiscard]] Digest digest(ImageView<const Vec3> image);  ///< float32, three channels
[[nodiscard]] Digest digest(ImageView<const Vec2> image);  ///< float32, two channels
[[nodiscard]] Digest digest(ImageView<const float> image);
[[nodiscard]] Digest digest(ImageView<const std::uint8_t> image);
[[nodiscard]] Digest digest(ImageView<const std::uint32_t> image);
[[nodiscard]] Digest digest(ImageView<const std::uint64_t> image);
[[nodiscard]] Digest digest(ImageView<const std::int32_t> image);
[[nodiscard]] Digest digest(ImageView<const std::int64_t> image);
/// The digest of an owned image.
template <class T>
[[nodiscard]] Digest digest(const Image<T>& image) {
  return digest(image.view());
}

}  // namespace rastrum
