// The translucent fragments of a rank, on their way to the owners of their pixels, and what an
// owner makes of those of all ranks. docs/scale.md has what is sent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <rastrum/device.hpp>
#include <rastrum/image.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/raster/frame/fragment_sink.hpp>
#include <rastrum/raster/setup/piece.hpp>
#include <rastrum/transparency/blend_kernels.hpp>

namespace rastrum::ranks {

/// Of a fragment between ranks: depth above the inverted place of its part in the list of all, as
/// opaque words have it, and the premultiplied colour in float32.
inline constexpr std::size_t kFragmentBytes = 24;

/// Where a rank has fragments that its own opaque surfaces do not hide, and how many.
class LayerSurvey final : public raster::FragmentSink {
 public:
  LayerSurvey(int width, int height);
  void take(const raster::FragmentPlane& plane) override;
  /// By block, in rows.
  [[nodiscard]] std::span<const std::uint64_t> masks() const { return masks_; }
  /// Of block (bx, by).
  [[nodiscard]] std::uint64_t count(int bx, int by) const {
    return counts_[static_cast<std::size_t>(by) * columns_ + static_cast<std::size_t>(bx)];
  }

 private:
  std::size_t columns_;
  std::vector<std::uint64_t> masks_, counts_;
};

/// Shaded fragments of a part of the picture, in the order in which one renderer blends those of
/// this rank. As bytes: of each block its number and how many bytes follow, then planes of at most
/// one fragment a pixel: a mask, which sample and whether the fragments are opaque, and the
/// fragments of its pixels.
class FragmentBytes final : public raster::FragmentSink {
 public:
  /// The place, in the list of all parts, of a key's.
  using PlaceOf = std::function<std::uint64_t(std::uint64_t key)>;

  FragmentBytes(int columns, raster::Rect band, PlaceOf place_of);
  void take(const raster::FragmentPlane& plane) override;
  /// Packs each block for its owner, and is empty then. Returns how many fragments.
  std::uint64_t pack(Mail& mail);

 private:
  int columns_;
  raster::Rect band_;
  PlaceOf place_of_;
  std::vector<Bytes> blocks_;
};

/// Who blends the layers of a block: dealt as if by chance, so that ranks have equal work wherever
/// the picture is full.
[[nodiscard]] std::size_t layer_owner(std::uint32_t block, std::size_t ranks);

/// What is seen of a block's layers, and where it has some. With several samples it is `seen`
/// alone, the mean of their colours with what is behind them.
struct SeenBlock {
  BlockMask where;
  transparency::Seen seen;
};

/// Merges what each rank has packed, block by block, and blends it by the exact method of one
/// renderer: the nearest first, of equal depths the part that comes first.
class LayerMerge {
 public:
  LayerMerge(Isa isa, float opaque_at, int samples)
      : kernel_(transparency::blend_kernels(isa)),
        opaque_at_(opaque_at),
        samples_(static_cast<std::size_t>(samples)),
        pixels_(samples_ * kPixels) {}
  /// Calls f(const SeenBlock&) for each block, in rising order.
  void blend(const Mail& mail, const std::function<void(const SeenBlock&)>& f);

 private:
  struct Fragment {
    std::uint64_t word;
    Vec4 color;
    bool opaque;
  };
  void add(Reader planes);
  void blend_block(SeenBlock& block);
  /// Takes a sample's lists; returns where it has some.
  std::uint64_t blend_sample(std::size_t sample, transparency::Seen& seen,
                             raster::BlockColors& behind);

  const transparency::BlendKernels& kernel_;
  float opaque_at_;
  std::size_t samples_;
  std::vector<std::vector<Fragment>> pixels_;  ///< of each sample's pixels
  raster::BlockColors plane_{};
};

/// A block as it goes to the root: its mask, and of each pixel colour and what is seen through it.
void put_seen(const BlockGrid& grid, const SeenBlock& block, Bytes& to);
[[nodiscard]] SeenBlock take_seen(const BlockGrid& grid, Reader& from);

}  // namespace rastrum::ranks
