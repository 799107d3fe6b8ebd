// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/bin/bin_quadrics.hpp>

#include <algorithm>
#include <bit>
#include <optional>

#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/raster/rules/make_quadric.hpp>

namespace rastrum::raster {
namespace bin_quadrics {

/// Depths are ordered by so many classes: a slightly wrong order hides only slightly less.
constexpr std::uint32_t kClasses = 1024;
std::uint32_t bits_of(float depth) {
  return std::bit_cast<std::uint32_t>(depth);
}

bool is_hidden(const DeferredInBin& piece, const DepthBounds& bounds) {
  if (piece.highest < bounds.bin) return true;
  for (int by = piece.y0 / kBlockSize; by <= (piece.y1 - 1) / kBlockSize; ++by)
    for (int bx = piece.x0 / kBlockSize; bx <= (piece.x1 - 1) / kBlockSize; ++bx)
      if (!(piece.highest < bounds.block[by * kBlocksPerBinRow + bx])) return false;
  return true;
}

/// Collects pieces to draw until they fill all lanes.
class Waiting {
 public:
  Waiting(const BinContext& context, Rect rect, BinKeys& keys)
      : context_(context), rect_(rect), keys_(keys) {}

  void add(const DeferredInBin& piece) {
    const std::uint64_t id = kIdMask - piece.low;
    if (draw_ == nullptr || id - draw_->first_id >= draw_->primitive_count) {
      draw_all();
      draw_ = &context_.frame->draw_of(id);
      eye_.emplace(*draw_->quadrics, context_.frame->viewport);
    }
    // Neighbours in depth are not neighbours in the caller's arrays.
    draw_->quadrics->prefetch(id - draw_->first_id);
    pieces_[count_++] = piece;
    if (count_ == std::size(pieces_)) draw_all();
  }
  void draw_all() {
    // Tubes have spheres among their segments.
    QuadricBatch spheres, others;
    spheres.eye = others.eye = count_ != 0 ? &*eye_ : nullptr;
    for (std::uint32_t i = 0; i < count_; ++i) {
      QuadricShape shape;
      (void)draw_->quadrics->shape(kIdMask - pieces_[i].low - draw_->first_id, shape);
      QuadricBatch& batch = shape.kind == QuadricKind::sphere ? spheres : others;
      batch.kind = shape.kind;
      batch.shapes[batch.count] = shape;
      batch.places[batch.count++] = pieces_[i];
    }
    draw(spheres);
    draw(others);
    count_ = 0;
  }
  [[nodiscard]] std::uint64_t fragments() const { return fragments_; }

 private:
  void draw(const QuadricBatch& batch) {
    if (batch.count == 0) return;
    const RaisedKeys raised = context_.kernel->raise(batch, rect_, keys_.bounds(), keys_.surface());
    keys_.raised(raised);
    fragments_ += raised.fragments;
  }

  const BinContext& context_;
  Rect rect_;
  BinKeys& keys_;
  const Draw* draw_ = nullptr;  ///< of all that are collected
  std::optional<QuadricEye> eye_;
  DeferredInBin pieces_[QuadricBatch::kCapacity];
  std::uint32_t count_ = 0;
  std::uint64_t fragments_ = 0;
};

}  // namespace bin_quadrics

std::span<const DeferredInBin> BinQuadrics::sort(std::span<const Group> groups, std::size_t bin) {
  using bin_quadrics::bits_of, bin_quadrics::kClasses;
  std::size_t count = 0;
  std::uint32_t least = ~0U, most = 0;
  for (const Group& group : groups) {
    const std::span<const DeferredInBin> list = group.deferred.bin(bin);
    count += list.size();
    for (const DeferredInBin& piece : list) {
      least = std::min(least, bits_of(piece.highest));
      most = std::max(most, bits_of(piece.highest));
    }
  }
  if (count == 0) return {};
  int shift = 0;
  while ((most - least) >> shift >= kClasses) ++shift;
  std::uint32_t begin[kClasses + 1] = {};
  const auto for_each = [&](const auto& use) {
    for (const Group& group : groups)
      for (const DeferredInBin& piece : group.deferred.bin(bin))
        use(piece, (most - bits_of(piece.highest)) >> shift);
  };
  for_each([&](const DeferredInBin&, std::uint32_t c) { ++begin[c + 1]; });
  for (std::uint32_t c = 0; c < kClasses; ++c) begin[c + 1] += begin[c];
  sorted_.reserve(count);
  for_each([&](const DeferredInBin& piece, std::uint32_t c) { sorted_[begin[c]++] = piece; });
  return {sorted_.data(), count};
}

std::uint64_t BinQuadrics::draw(const BinContext& context, std::span<const Group> groups,
                                std::size_t bin, Rect rect, BinKeys& keys) {
  const std::span<const DeferredInBin> pieces = sort(groups, bin);
  bin_quadrics::Waiting waiting(context, rect, keys);
  const DepthBounds* const bounds = keys.bounds();
  std::uint64_t hidden = 0;
  for (const DeferredInBin& piece : pieces) {
    if (bounds != nullptr && bin_quadrics::is_hidden(piece, *bounds))
      ++hidden;
    else
      waiting.add(piece);
  }
  waiting.draw_all();
  keys.hid_pieces(hidden);
  return waiting.fragments();
}

}  // namespace rastrum::raster
