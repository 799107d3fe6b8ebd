// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/core/view_rows.hpp>
#include <rastrum/digest.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

namespace rastrum {
namespace {

static_assert(std::endian::native == std::endian::little, "rows are hashed as they lie in memory");

/// The first 32 bits of the fractions of the cube roots of the first 64 primes.
constexpr std::uint32_t kRound[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

class Sha256 {
 public:
  void add(const void* data, std::size_t n) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    length_ += n;
    while (n != 0) {
      const std::size_t part = std::min(n, sizeof(block_) - used_);
      std::memcpy(block_ + used_, bytes, part);
      bytes += part;
      n -= part;
      used_ += part;
      if (used_ == sizeof(block_)) take_block();
    }
  }
  Digest finish() {
    const std::uint64_t bits = length_ * 8;
    const std::uint8_t end = 0x80, zero = 0;
    add(&end, 1);
    while (used_ != 56) add(&zero, 1);
    for (int i = 8; i-- > 0;) {
      const auto byte = static_cast<std::uint8_t>(bits >> 8 * i);
      add(&byte, 1);
    }
    Digest digest;
    for (std::size_t i = 0; i < 32; ++i)
      digest.bytes[i] = static_cast<std::uint8_t>(state_[i / 4] >> (24 - 8 * (i % 4)));
    return digest;
  }

 private:
  void take_block() {
    std::uint32_t w[64];
    for (std::size_t i = 0; i < 16; ++i)
      w[i] = std::uint32_t{block_[4 * i]} << 24 | std::uint32_t{block_[4 * i + 1]} << 16 |
             std::uint32_t{block_[4 * i + 2]} << 8 | block_[4 * i + 3];
    for (std::size_t i = 16; i < 64; ++i) {
      const std::uint32_t a = w[i - 15], b = w[i - 2];
      w[i] = w[i - 16] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ a >> 3) + w[i - 7] +
             (std::rotr(b, 17) ^ std::rotr(b, 19) ^ b >> 10);
    }
    auto [a, b, c, d, e, f, g, h] = state_;
    for (std::size_t i = 0; i < 64; ++i) {
      const std::uint32_t t1 = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                               ((e & f) ^ (~e & g)) + kRound[i] + w[i];
      const std::uint32_t t2 =
          (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
      h = g;
      g = f;
      f = e;
      e = d + t1;
      d = c;
      c = b;
      b = a;
      a = t1 + t2;
    }
    const std::uint32_t more[8] = {a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < 8; ++i) state_[i] += more[i];
    used_ = 0;
  }

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::uint8_t block_[64];
  std::size_t used_ = 0;
  std::uint64_t length_ = 0;
};

/// `type` is NumPy's name for a pixel's numbers.
template <class Number, class T>
Digest of(ImageView<const T> image, const char* type) {
  constexpr std::size_t kChannels = sizeof(T) / sizeof(Number);
  check_stride(image, "digest: the image");
  std::string what(type);
  what.append(" ").append(std::to_string(image.height));
  what.append("x").append(std::to_string(image.width));
  if (kChannels > 1) what.append("x").append(std::to_string(kChannels));
  what.append("\n");
  Sha256 hash;
  hash.add(what.data(), what.size());
  const std::size_t bytes = static_cast<std::size_t>(image.width) * sizeof(T);
  std::vector<Number> row(static_cast<std::size_t>(image.width) * kChannels);
  for (int y = 0; y < image.height; ++y) {
    const void* data = image.row(y);
    if constexpr (std::is_same_v<Number, float>) {
      if (bytes != 0) std::memcpy(row.data(), data, bytes);
      for (float& v : row)
        if (std::isnan(v)) v = std::bit_cast<float>(0x7fc00000U);
      data = row.data();
    }
    hash.add(data, bytes);
  }
  return hash.finish();
}

}  // namespace

std::string Digest::hex() const {
  std::string text;
  for (const std::uint8_t b : bytes)
    for (const int digit : {b >> 4, b & 15}) text.push_back("0123456789abcdef"[digit]);
  return text;
}

Digest digest(ImageView<const Rgba8> image) {
  return of<std::uint8_t>(image, "uint8");
}
Digest digest(ImageView<const Vec4> image) {
  return of<float>(image, "float32");
}
Digest digest(ImageView<const Vec3> image) {
  return of<float>(image, "float32");
}
Digest digest(ImageView<const Vec2> image) {
  return of<float>(image, "float32");
}
Digest digest(ImageView<const float> image) {
  return of<float>(image, "float32");
}
Digest digest(ImageView<const std::uint8_t> image) {
  return of<std::uint8_t>(image, "uint8");
}
Digest digest(ImageView<const std::uint32_t> image) {
  return of<std::uint32_t>(image, "uint32");
}
Digest digest(ImageView<const std::uint64_t> image) {
  return of<std::uint64_t>(image, "uint64");
}
Digest digest(ImageView<const std::int32_t> image) {
  return of<std::int32_t>(image, "int32");
}
Digest digest(ImageView<const std::int64_t> image) {
  return of<std::int64_t>(image, "int64");
}

}  // namespace rastrum
