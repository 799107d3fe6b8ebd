// SPDX-License-Identifier: BSD-3-Clause
// Generated scenes for transparency: many layers a pixel in various orders, crossing, at equal
// depths, with opaque surfaces between them. Reproducible from a seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <rastrum/scene.hpp>

#include "tests/support/layer_oracle.hpp"
#include "tests/support/pieces.hpp"

namespace rastrum::test {

/// How the fragments of a triangle get their colours.
enum class Paint {
  triangle,  ///< one colour
  pixel,     ///< LayerScene::pixel_color: a different one at each pixel
  gradient,  ///< linear between the colours of its corners; such scenes have w = 1 everywhere
};

struct LayerScene {
  std::string kind;
  Camera camera;
  Mesh mesh;                         ///< with indices
  std::vector<Vec4> colors;          ///< of each triangle, premultiplied
  std::vector<std::uint8_t> opaque;  ///< of each triangle: 1 or 0
  std::vector<Vec4> corner_colors;   ///< for Paint::gradient: of each index, premultiplied
  Paint paint = Paint::triangle;
  bool holes = false;  ///< is_hole leaves out fragments of every second triangle

  /// Premultiplied. Pure, so that threads may call it.
  [[nodiscard]] Vec4 pixel_color(std::uint64_t id, int x, int y) const;
  [[nodiscard]] bool is_hole(std::uint64_t id, int x, int y) const;

  [[nodiscard]] std::size_t size() const { return colors.size(); }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, Vec4 color, bool is_opaque = false);
};

/// The number of kinds; `generate_layers` draws kind seed % kLayerKinds.
extern const int kLayerKinds;

/// For a `width` × `height` picture: at most 4,000 triangles and about `most_fragments`.
[[nodiscard]] LayerScene generate_layers(std::uint64_t seed, int width, int height,
                                         int most_fragments = 1000000);

/// `count` quads that fill the picture in planes parallel to it, at distinct depths in random
/// order. Alphas are about `alpha`.
[[nodiscard]] LayerScene layer_stack(std::uint64_t seed, int count, double alpha, int width,
                                     int height);

/// Translucent clipped triangles whose pieces overlap because of a snapped vertex, each over a
/// pixel's centre in a 64 × 64 picture.
[[nodiscard]] LayerScene overlapping_pieces();

/// The oracle's input for a scene: its snapped triangles and colour functions. Refers to `scene`.
struct LayerQuestion {
  LayerQuestion(const LayerScene& scene, int width, int height, int samples, Vec4 background);
  [[nodiscard]] LayerInput input() const;

  PieceList pieces;

 private:
  const LayerScene& scene_;
  int width_, height_, samples_;
  Rgba64 background_;
};

}  // namespace rastrum::test
