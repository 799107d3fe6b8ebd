#include <rastrum/raster/resolve.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include <rastrum/core/error.hpp>
#include <rastrum/raster/kernels.hpp>

namespace rastrum::raster {
namespace {

/// The part of the image that a block covers.
struct Window {
  int x0, y0, columns, rows;
  [[nodiscard]] bool whole() const { return columns == kBlockSize && rows == kBlockSize; }
};

/// Every case: float targets, translucent colours, blocks cut by the image's edge.
void store_colors(const FrameRequest& request, const BlockColors& colors, std::uint64_t covered,
                  const Window& w, bool wants_8_bit) {
  const Vec4 b = request.background;
  const Vec4 background{b.x * b.w, b.y * b.w, b.z * b.w, b.w};
  for (int y = 0; y < w.rows; ++y)
    for (int x = 0; x < w.columns; ++x) {
      const int i = y * kBlockSize + x;
      Vec4 color = background;
      if ((covered >> i & 1) != 0)
        color = Vec4{colors.r[i], colors.g[i], colors.b[i], colors.a[i]} +
                background * (1 - colors.a[i]);
      if (wants_8_bit) request.targets.color8(w.x0 + x, w.y0 + y) = to_straight_rgba8(color);
      if (!request.targets.color.empty()) request.targets.color(w.x0 + x, w.y0 + y) = color;
    }
}

void resolve_colors(const FrameRequest& request, const FrameGeometry& frame,
                    const VisibleBlock& block, const Window& w) {
  const Targets& targets = request.targets;
  const Vec4 b = request.background;
  const Rgba8 background = to_straight_rgba8({b.x * b.w, b.y * b.w, b.z * b.w, b.w});
  bool wants_8_bit = !targets.color8.empty();
  if (block.covered == 0 && wants_8_bit) {
    for (int y = 0; y < w.rows; ++y)
      std::fill_n(targets.color8.row(w.y0 + y) + w.x0, w.columns, background);
    wants_8_bit = false;
  }
  BlockColors colors;
  if (block.covered != 0) {
    const bool opaque = request.shader->shade(frame, block, request.isa, colors);
    if (opaque && wants_8_bit && w.whole()) {
      kernels(request.isa)
          .store_opaque(colors, block.covered, background, &targets.color8(w.x0, w.y0),
                        targets.color8.stride);
      wants_8_bit = false;
    }
    if (opaque) std::fill_n(colors.a, 64, 1.0F);
  }
  if (wants_8_bit || !targets.color.empty())
    store_colors(request, colors, block.covered, w, wants_8_bit);
}

void store_ids_and_depth(const Targets& targets, const std::uint64_t* words, const Window& w) {
  for (int y = 0; y < w.rows; ++y)
    for (int x = 0; x < w.columns; ++x) {
      const std::uint64_t word = words[y * kBlockSize + x];
      if (!targets.depth.empty())
        targets.depth(w.x0 + x, w.y0 + y) =
            std::bit_cast<float>(static_cast<std::uint32_t>(word >> kIdBits));
      if (!targets.ids.empty())
        targets.ids(w.x0 + x, w.y0 + y) =
            word == 0 ? -1 : static_cast<std::int64_t>(id_of_word(word));
    }
}

}  // namespace

int resolve_block(const FrameRequest& request, const FrameGeometry& frame,
                  const std::uint64_t* words, int x0, int y0, void* scratch) noexcept {
  const Targets& targets = request.targets;
  const Window window{x0, y0, std::min(kBlockSize, request.width - x0),
                      std::min(kBlockSize, request.height - y0)};
  std::uint64_t covered = kernels(request.isa).covered(words);
  if (!window.whole())
    covered &=
        samples_inside({0, 0, request.width, request.height}, x0 / kBlockSize, y0 / kBlockSize);
  if (!targets.color8.empty() || !targets.color.empty())
    resolve_colors(request, frame, {words, covered, x0, y0, scratch}, window);
  if (!targets.depth.empty() || !targets.ids.empty()) store_ids_and_depth(targets, words, window);
  return std::popcount(covered);
}

void resolve_empty(const FrameRequest& request, Rect rect) noexcept {
  const Targets& targets = request.targets;
  const Vec4 b = request.background;
  const Vec4 background{b.x * b.w, b.y * b.w, b.z * b.w, b.w};
  const Rgba8 background8 = to_straight_rgba8(background);
  const auto fill = [&](const auto& target, int y, auto value) {
    if (!target.empty()) std::fill_n(target.row(y) + rect.x0, rect.x1 - rect.x0, value);
  };
  for (int y = rect.y0; y < rect.y1; ++y) {
    fill(targets.color8, y, background8);
    fill(targets.color, y, background);
    fill(targets.depth, y, 0.0F);
    fill(targets.ids, y, std::int64_t{-1});
  }
}

Totals number_draws(std::span<Draw> draws) {
  Totals totals;
  for (Draw& draw : draws) {
    draw.first_id = totals.triangles;
    draw.first_vertex = totals.vertices;
    totals.triangles += draw.triangle_count;
    totals.vertices += draw.vertex_count;
  }
  if (totals.triangles > kMaxId)
    throw Error(Errc::invalid_argument, "the scene has " + std::to_string(totals.triangles) +
                                            " triangles; at most " + std::to_string(kMaxId) +
                                            " have an id");
  return totals;
}

void check_indices(std::span<const Draw> draws) {
  for (std::size_t i = 0; i < draws.size(); ++i)
    for (const std::uint32_t index : draws[i].indices)
      if (index >= draws[i].vertex_count)
        throw Error(Errc::invalid_argument,
                    "instance " + std::to_string(i) + ": index " + std::to_string(index) +
                        " is out of range, the mesh has " + std::to_string(draws[i].vertex_count) +
                        " vertices");
}

}  // namespace rastrum::raster
