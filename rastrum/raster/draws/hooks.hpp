// SPDX-License-Identifier: BSD-3-Clause
// The two hooks of the programmable stages, fragment test and shading. They see blocks, so that one
// virtual call serves up to 64 fragments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <rastrum/device.hpp>
#include <rastrum/primitives.hpp>
#include <rastrum/raster/rules/color.hpp>
#include <rastrum/raster/rules/piece.hpp>
#include <rastrum/raster/rules/samples.hpp>

namespace rastrum::raster {

struct FrameGeometry;
struct SeenBin;
struct LitBlock;

/// Decides which covered samples of a block survive, before the maximum. Need not be asked of what
/// is hidden. Thread-safe.
class FragmentTest {
 public:
  virtual ~FragmentTest() = default;
  /// The subset of `block.mask` that is kept. `points`: where in their pixels the fragments are;
  /// null: at the centres.
  [[nodiscard]] virtual std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                                           const Block& block,
                                           const ShadingPoints* points) const noexcept = 0;
};

/// The visible surface of an 8 × 8 block: a key per sample.
struct VisibleBlock {
  const std::uint64_t* keys = nullptr;    ///< 64, element 8 · row + column; on 64 bytes
  std::uint64_t covered = 0;              ///< samples that hold a surface and lie in the image
  int x0 = 0, y0 = 0;                     ///< first pixel
  void* scratch = nullptr;                ///< the shader's, zeroed when a thread begins a frame
  BlockColors* extra = nullptr;           ///< its further outputs; null: not wanted
  const ShadingPoints* points = nullptr;  ///< where they are; null: at their pixels' centres
  LitBlock* lit = nullptr;  ///< where a shader may leave normals that it has found; null: nowhere
  const SeenBin* bin = nullptr;  ///< what is known of its triangles (seen_bin.hpp); null: nothing
};

/// Shades the visible surface of a block. Thread-safe.
class BlockShader {
 public:
  virtual ~BlockShader() = default;
  /// Sets the colours of the covered samples (others may be set to anything). Returns whether all
  /// of them are opaque; alpha need not be set then.
  virtual bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                     BlockColors& colors) const noexcept = 0;
  /// Asks the cache for what shading primitive `id` will read: a hint for who knows long before.
  virtual void prefetch(const FrameGeometry& /*frame*/, std::uint64_t /*id*/) const noexcept {}
  /// The alpha of all fragments, where it is one and known before they are shaded.
  [[nodiscard]] virtual std::optional<float> alpha() const noexcept { return std::nullopt; }
  /// Whether colours depend on the depth in a key, not on its id alone.
  [[nodiscard]] virtual bool wants_depth() const noexcept { return true; }
  /// How many bytes of VisibleBlock::scratch the shader uses, for each thread; 64-byte aligned,
  /// kept from block to block of a frame.
  [[nodiscard]] virtual std::size_t scratch_bytes() const noexcept { return 0; }
  /// How many VisibleBlock::extra it sets (Targets::extra), at most kMaxExtraTargets.
  [[nodiscard]] virtual std::size_t extra_count() const noexcept { return 0; }
};

/// A thread's VisibleBlock::scratch.
class ShaderScratch {
 public:
  /// `bytes`, zeroed.
  void begin(std::size_t bytes) { lines_.assign((bytes + sizeof(Line) - 1) / sizeof(Line), {}); }
  [[nodiscard]] void* data() { return lines_.data(); }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<Line> lines_;
};

}  // namespace rastrum::raster
