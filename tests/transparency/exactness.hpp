// SPDX-License-Identifier: BSD-3-Clause
// Pictures of layers that must be exact on every instruction set and rasterizer.
#pragma once

#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/every_way.hpp"
#include "tests/support/layer_picture.hpp"
#include "tests/support/layer_program.hpp"
#include "tests/support/layer_scenes.hpp"

namespace rastrum::test {

[[nodiscard]] inline LayerImage oracle_of(const LayerScene& scene, int width, int height,
                                          int samples, Vec4 background,
                                          LayerOrder order = LayerOrder::depth) {
  const LayerQuestion question(scene, width, height, samples, background);
  return blend_layers(question.input(), order);
}

[[nodiscard]] inline std::string title_of(std::uint64_t number, const LayerScene& scene) {
  return "scene " + std::to_string(number) + " (" + scene.kind + ")";
}

[[nodiscard]] inline std::string title_of(const Painter& painter) {
  const RenderOptions& o = painter.options();
  return o.rasterizer + " " + std::to_string(o.tuning.tile_px) + ", " + name_of(o);
}

/// Expects that take_by(painter)'s picture is the oracle's, with the same bits on all instruction
/// sets, threads and tiles.
template <class Take>
void expect_exact(RenderOptions o, const LayerImage& oracle, Check check, const Take& take_by) {
  std::optional<LayerPicture> first;
  for (const Isa isa : available_isas())
    for (const bool grouped : {true, false}) {
      o.isa = isa;
      o.rasterizer = grouped ? "grouped" : "tiled";
      o.threads = grouped ? 2 : 8;
      Painter painter(o);
      SCOPED_TRACE(title_of(painter));
      const LayerPicture picture = take_by(painter);
      if (first) {
        ASSERT_TRUE(same_bits(picture, *first));
        continue;
      }
      ASSERT_TRUE(equals_oracle(picture, oracle, check));
      first = picture;
    }
}

}  // namespace rastrum::test
