// SPDX-License-Identifier: BSD-3-Clause
// A program whose directory has a small map of hills: h.png, c.png, and the same in memory.
#pragma once

#include <cmath>
#include <cstdint>

#include <rastrum/io.hpp>
#include <rastrum/terrain.hpp>

#include "program.hpp"

#include "tests/support/painter.hpp"

namespace rastrum::test {

class ProgramOnHills : public Program {
 protected:
  static constexpr int kWidth = 96, kHeight = 64, kMap = 60;

  void SetUp() override {
    Program::SetUp();
    options_.width = kWidth;
    options_.height = kHeight;
    options_.filter = terrain::MapFilter::bilinear;
    options_.step = 0;
    map_.heights = Image<float>(kMap, kMap);
    map_.colors = Image<Rgba8>(kMap, kMap);
    Image<Rgba8> grey(kMap, kMap);
    for (int y = 0; y < kMap; ++y)
      for (int x = 0; x < kMap; ++x) {
        const auto h = static_cast<std::uint8_t>(16 + 15 * std::sin(x * 0.21) * std::cos(y * 0.17));
        map_.heights(x, y) = h;
        grey(x, y) = {h, h, h, 255};
        map_.colors(x, y) = {static_cast<std::uint8_t>(4 * x), static_cast<std::uint8_t>(4 * y), 90,
                             255};
      }
    io::write_png(path("h.png"), grey.view());
    io::write_png(path("c.png"), map_.colors.view());
  }

  TerrainLook options_;
  terrain::TerrainCamera camera_;
  terrain::HeightMap map_;
};

}  // namespace rastrum::test
