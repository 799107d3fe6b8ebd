// SPDX-License-Identifier: BSD-3-Clause
// Mip chains of a scene's textures. Level 0 is the caller's image, borrowed. The others are 8 bit
// and built once, since a frame has no time for it: a box filter over exactly the texels under a
// texel of the next level (three weighted ones a side at odd sizes), in linear light for colours.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <rastrum/core/memory.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::raster {

/// How r, g, b of a texture are read. The material decides, since a picture may be used both ways.
enum class TexelUse : std::uint8_t {
  color = 1,  ///< sRGB: base colour, emission
  data = 2,   ///< linear: metallic-roughness, normals, occlusion, alpha maps
};

struct MipLevel {
  const Rgba8* texels = nullptr;  ///< row 0 at the top, rows contiguous
  std::int32_t width = 0, height = 0;
};

inline constexpr int kMaxLevels = 16;  // 2^15 px and below

/// One texture with one use.
struct MipChain {
  TexelUse use = TexelUse::color;
  const float* decode = nullptr;  ///< 256 values for codes of r, g, b; alpha is code / 255
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  TextureFilter mag = TextureFilter::linear, min = TextureFilter::linear;
  int levels = 0;
  std::uint64_t number = 0;  ///< unique to this chain, whatever its address
  MipLevel level[kMaxLevels];
};

/// The chains of a scene, kept from frame to frame.
class TextureSet {
 public:
  explicit TextureSet(MemoryAccount& memory);
  ~TextureSet();

  /// Makes the chains of `uses` (a sum of TexelUse for each texture), and drops those of textures
  /// that are gone. A texture with the same address, size and fingerprint (some hundred texels
  /// spread over it) keeps its chain. After changing a few texels in place, make a new Renderer.
  /// `exec` may be null: one thread. Cost: O(new texels), about 10 ns each; O(textures) if none is
  /// new. Holds a third of the textures' bytes. The images must live while chains are read.
  void update(std::span<const Texture> textures, std::span<const std::uint8_t> uses,
              parallel::Threads* exec);

  /// Null: `texture` is kNoTexture, an empty image, or has no chain for this use.
  [[nodiscard]] const MipChain* find(std::int32_t texture, TexelUse use) const noexcept;
  [[nodiscard]] std::uint64_t bytes() const noexcept;
  [[nodiscard]] std::uint64_t builds() const noexcept { return builds_; }

 private:
  struct Chain;
  struct Entry;
  MemoryAccount& memory_;
  std::vector<Entry> entries_;
  std::uint64_t builds_ = 0;
};

}  // namespace rastrum::raster
