// SPDX-License-Identifier: BSD-3-Clause
// The hooks of the two programmable stages, fragment test and shading. They see blocks, so that one
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

/// Decides before the maximum which covered samples of a block survive. Hidden fragments may be
/// left untested. Thread-safe.
class FragmentTest {
 public:
  virtual ~FragmentTest() = default;
  /// The subset of `block.mask` that is kept. `points`: where in their pixels the fragments are;
  /// null: the centres.
  [[nodiscard]] virtual std::uint64_t test(const FrameGeometry& frame, const Piece& piece,
                                           const Block& block,
                                           const ShadingPoints* points) const noexcept = 0;
};

/// The visible surface of an 8 × 8 block: a key per sample.
struct VisibleBlock {
  const std::uint64_t* keys = nullptr;    ///< 64, element 8 · row + column; 64-byte aligned
  std::uint64_t covered = 0;              ///< samples in the image that hold a surface
  int x0 = 0, y0 = 0;                     ///< first pixel
  void* scratch = nullptr;                ///< the shader's, zeroed when a thread begins a frame
  BlockColors* extra = nullptr;           ///< the further outputs; null: not wanted
  const ShadingPoints* points = nullptr;  ///< where the fragments are; null: pixel centres
  LitBlock* lit = nullptr;                ///< where a shader may leave its normals; null: nowhere
  const SeenBin* bin = nullptr;  ///< its triangles, set up before (seen_bin.hpp); null: none
};

/// Shades the visible surface of a block. Thread-safe.
class BlockShader {
 public:
  virtual ~BlockShader() = default;
  /// Sets the colours of the covered samples, and any to others. Returns whether all covered ones
  /// are opaque; then alpha need not be set.
  virtual bool shade(const FrameGeometry& frame, const VisibleBlock& block, Isa isa,
                     BlockColors& colors) const noexcept = 0;
  /// Prefetches what shading primitive `id` will read; useful long before.
  virtual void prefetch(const FrameGeometry& /*frame*/, std::uint64_t /*id*/) const noexcept {}
  /// The alpha of all fragments, if it is one and known before shading.
  [[nodiscard]] virtual std::optional<float> alpha() const noexcept { return std::nullopt; }
  /// Whether colours depend on a key's depth, not only on its id.
  [[nodiscard]] virtual bool wants_depth() const noexcept { return true; }
  /// The bytes of VisibleBlock::scratch that each thread needs, 64-byte aligned and kept from block
  /// to block of a frame.
  [[nodiscard]] virtual std::size_t scratch_bytes() const noexcept { return 0; }
  /// How many VisibleBlock::extra it sets (Targets::extra), at most kMaxExtraTargets.
  [[nodiscard]] virtual std::size_t extra_count() const noexcept { return 0; }
};

class ShaderScratch {
 public:
  /// Zeroes them.
  void begin(std::size_t bytes) { lines_.assign((bytes + sizeof(Line) - 1) / sizeof(Line), {}); }
  [[nodiscard]] void* data() { return lines_.data(); }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<Line> lines_;
};

}  // namespace rastrum::raster
