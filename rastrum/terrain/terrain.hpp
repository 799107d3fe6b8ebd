// What is flown over: a height map with colours, or two functions of the plane. x runs east, y
// south (rows of a map), heights up, all in units of a map's cell; cell (i, j) of a map is the
// square [i, i + 1) × [j, j + 1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include <rastrum/core/config.hpp>
#include <rastrum/core/image.hpp>

namespace rastrum::terrain {

/// What lies beyond a map's edge: the map again, its mirror image, or its outermost cells.
enum class Tiling : std::uint8_t { repeat, mirror, clamp };

/// The cell of a map that is `size` long to which coordinate `i` belongs; floor, not truncation.
[[nodiscard]] RASTRUM_HD inline std::int64_t tiled(std::int64_t i, std::int64_t size,
                                                   Tiling tiling) {
  if (static_cast<std::uint64_t>(i) < static_cast<std::uint64_t>(size)) return i;
  const auto modulo = [](std::int64_t a, std::int64_t n) {
    const std::int64_t r = a % n;
    return r < 0 ? r + n : r;
  };
  if (tiling == Tiling::repeat) return modulo(i, size);
  if (tiling == Tiling::clamp) return i < 0 ? 0 : i < size ? i : size - 1;
  const std::int64_t m = modulo(i, 2 * size);
  return m < size ? m : 2 * size - 1 - m;
}

struct HeightMap {
  Image<float> heights{};  ///< in cells; NaN is a hole, through which one sees what lies behind
  Image<Rgba8> colors{};   ///< of any size, stretched over the map; empty: grey by height
};

/// A terrain without cells. Both are called from several threads at once, for the samples of a row
/// of the picture; coordinates may be any finite numbers.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual void heights(const double* x, const double* y, std::size_t n, float* out) const = 0;
  virtual void colors(const double* x, const double* y, std::size_t n, Rgba8* out) const = 0;
};

class LitFunction;

/// A terrain to look at: cheap to copy, never changed, safe to share between threads.
class Terrain {
 public:
  /// Takes over the map. Throws Error{invalid_argument} where it has no cell. O(cells).
  explicit Terrain(HeightMap map);
  explicit Terrain(std::shared_ptr<const Surface> surface);
  /// What function_terrain (light.hpp) makes.
  explicit Terrain(std::shared_ptr<const LitFunction> function);

  /// From two functors `float height(double x, double y)` and `Rgba8 color(double x, double y)`.
  template <class Height, class Color>
  [[nodiscard]] static Terrain of(Height height, Color color);

  /// The same heights under other colours, of any size: a map's light, for one. O(1) beside the
  /// move. Requires a map.
  [[nodiscard]] Terrain with_colors(Image<Rgba8> colors) const;

  [[nodiscard]] bool is_map() const { return surface_ == nullptr; }
  /// The map's; requires is_map().
  [[nodiscard]] const std::shared_ptr<const Image<float>>& heights() const { return heights_; }
  [[nodiscard]] const std::shared_ptr<const Image<Rgba8>>& colors() const { return colors_; }
  /// Of a map: the largest of its heights, NaN left out; −inf where there is none. Of functions:
  /// +inf.
  [[nodiscard]] float highest() const { return highest_; }
  [[nodiscard]] const Surface& surface() const { return *surface_; }
  /// The surface, where function_terrain made it; else null.
  [[nodiscard]] const LitFunction* lit_function() const { return lit_function_; }

  /// The height at a point, unfiltered; NaN in a hole.
  [[nodiscard]] float height_at(double x, double y, Tiling tiling = Tiling::repeat) const;
  /// The colour at a point, unfiltered.
  [[nodiscard]] Rgba8 color_at(double x, double y, Tiling tiling = Tiling::repeat) const;

 private:
  std::shared_ptr<const Image<float>> heights_;
  std::shared_ptr<const Image<Rgba8>> colors_;
  std::shared_ptr<const Surface> surface_;
  const LitFunction* lit_function_ = nullptr;
  float highest_ = 0;
};

template <class Height, class Color>
Terrain Terrain::of(Height height, Color color) {
  class Functions final : public Surface {
   public:
    Functions(Height h, Color c) : height_(std::move(h)), color_(std::move(c)) {}
    void heights(const double* x, const double* y, std::size_t n, float* out) const override {
      for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<float>(height_(x[i], y[i]));
    }
    void colors(const double* x, const double* y, std::size_t n, Rgba8* out) const override {
      for (std::size_t i = 0; i < n; ++i) out[i] = color_(x[i], y[i]);
    }

   private:
    Height height_;
    Color color_;
  };
  return Terrain(std::make_shared<const Functions>(std::move(height), std::move(color)));
}

}  // namespace rastrum::terrain
