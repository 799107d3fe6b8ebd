// An upper bound of the heights in a rectangle of a map, from maxima of 16 × 16 cells and coarser:
// what lies under it need not be sampled where all of it would stay hidden. On hills most samples
// are; 88 % of a frame's here.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <rastrum/core/image.hpp>
#include <rastrum/terrain/terrain.hpp>

namespace rastrum::terrain {

/// Whole cells, ends included, before tiling.
struct CellRange {
  std::int64_t first, last;
};

class Ceiling {
 public:
  /// O(cells), once a map.
  explicit Ceiling(std::shared_ptr<const Image<float>> heights);
  [[nodiscard]] bool is_of(const Terrain& terrain) const { return heights_ == terrain.heights(); }

  /// No height in x × y of the tiled map exceeds it; −inf where all are holes. At most 25 reads.
  [[nodiscard]] float over(CellRange x, CellRange y, Tiling tiling) const;
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  std::shared_ptr<const Image<float>> heights_;
  std::vector<Image<float>> levels_;  ///< of cells of 2⁴, 2⁵, …
};

}  // namespace rastrum::terrain
