#include <rastrum/raster/resolve.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include <rastrum/core/error.hpp>

namespace rastrum::raster {
namespace {

std::uint8_t quantize(float c) {
  const float clamped = c > 0 ? (c < 1 ? c : 1.0F) : 0.0F;
  return static_cast<std::uint8_t>(std::nearbyint(clamped * 255.0F));
}

Rgba8 to_straight_rgba8(Vec4 premultiplied) {
  const float a = premultiplied.w;
  const float scale = a > 0 && a != 1 ? 1 / a : 1.0F;
  return {quantize(premultiplied.x * scale), quantize(premultiplied.y * scale),
          quantize(premultiplied.z * scale), quantize(a)};
}

}  // namespace

int resolve_block(const FrameRequest& request, const FrameGeometry& frame,
                  const std::uint64_t (&words)[64], int x0, int y0) noexcept {
  const Targets& targets = request.targets;
  const int columns = std::min(kBlockSize, request.width - x0);
  const int rows = std::min(kBlockSize, request.height - y0);
  int covered = 0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) covered += words[y * kBlockSize + x] != 0;

  const bool wants_color = !targets.color8.empty() || !targets.color.empty();
  BlockColors colors;
  if (wants_color && covered != 0) request.shader->shade(frame, words, x0, y0, request.isa, colors);
  const Vec4 b = request.background;
  const Vec4 background{b.x * b.w, b.y * b.w, b.z * b.w, b.w};

  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const int i = y * kBlockSize + x;
      const std::uint64_t word = words[i];
      if (wants_color) {
        Vec4 color = background;
        if (word != 0) {
          const float through = 1 - colors.a[i];
          color = Vec4{colors.r[i], colors.g[i], colors.b[i], colors.a[i]} + background * through;
        }
        if (!targets.color8.empty()) targets.color8(x0 + x, y0 + y) = to_straight_rgba8(color);
        if (!targets.color.empty()) targets.color(x0 + x, y0 + y) = color;
      }
      if (!targets.depth.empty())
        targets.depth(x0 + x, y0 + y) =
            std::bit_cast<float>(static_cast<std::uint32_t>(word >> kIdBits));
      if (!targets.ids.empty())
        targets.ids(x0 + x, y0 + y) = word == 0 ? -1 : static_cast<std::int64_t>(id_of_word(word));
    }
  return covered;
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
