// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/frame/reference.hpp>

#include <algorithm>

#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/setup/assemble.hpp>
#include <rastrum/raster/setup/set_up.hpp>

namespace rastrum::raster {
namespace {

/// Keeps the maximum key of each covered sample. Uses blocks of one sample, so that fragment tests
/// have their usual interface.
void draw_piece(FrameRun& frame, const Piece& piece) {
  const FrameRequest& request = frame.request;
  for_each_covered(piece, frame.view, [&](int x, int y) {
    ++frame.fragments;
    if (!request.targets.overdraw.empty()) ++request.targets.overdraw(x, y);
    const int sample = y % kBlockSize * kBlockSize + x % kBlockSize;
    if ((piece.flags & kMayDrop) != 0) {
      const Block block{0, static_cast<std::uint16_t>(x / kBlockSize),
                        static_cast<std::uint16_t>(y / kBlockSize), std::uint64_t{1} << sample};
      if (request.kept(frame.geometry, piece, block, nullptr) == 0) return;
    }
    std::uint64_t& key = frame.surface.block(x / kBlockSize, y / kBlockSize)[sample];
    key = std::max(key, make_key(depth_at(piece, x, y), piece.low));
  });
}

class Reference final : public Method {
 public:
  [[nodiscard]] Needs needs() const override {
    return {.rasterizer = "reference", .visibility = "atomic", .quadrics = true};
  }
  void draw(FrameRun& frame, std::uint64_t first, std::uint64_t last) override {
    FrameStats::Triangles triangles;
    for_each_primitive(frame, first, last, [&](const Draw& draw, std::uint64_t primitive) {
      count_fate(assemble_primitive(frame.geometry, draw, primitive,
                                    [&](const Piece& piece) { draw_piece(frame, piece); }),
                 triangles);
    });
    count_triangles(frame, triangles);
    frame.watch.lap(frame.stats, "rasterize");
  }
};

}  // namespace

std::unique_ptr<Method> make_reference() {
  return std::make_unique<Reference>();
}

}  // namespace rastrum::raster
