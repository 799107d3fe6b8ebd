// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/resolve/resolve.hpp>

#include <algorithm>
#include <bit>

#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/resolve/surfaces.hpp>
#include <rastrum/raster/shade/lit_kernels.hpp>
#include <rastrum/raster/shade/shader.hpp>

namespace rastrum::raster {
namespace {

struct Window {
  int x0, y0, columns, rows;
  [[nodiscard]] bool whole() const { return columns == kBlockSize && rows == kBlockSize; }
};

Vec4 straight(Vec4 premultiplied) {
  return straight_from_premultiplied(premultiplied);
}
Vec4 straight(Rgba8 c) {
  return straight_from_rgba8(c);
}

/// Stores colours in the general case: float targets, pictures that are drawn over, blocks cut by
/// the image's edge, passes that touch only some pixels. Keeps pixels outside of `touched`.
void store_colors(const Targets& targets, const FramePlan& plan, const BlockColors& colors,
                  std::uint64_t covered, std::uint64_t touched, const Window& w, bool wants_8_bit) {
  const Backdrop& backdrop = plan.backdrop;
  const bool over = plan.writes == FramePlan::Writes::surfaces;
  const auto behind = [&](const auto& target, int x, int y) {
    return over && !target.empty() ? backdrop_of(straight(target(x, y)), backdrop.linear)
                                   : backdrop;
  };
  for (std::uint64_t m = touched; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = w.x0 + i % kBlockSize, y = w.y0 + i / kBlockSize;
    Vec4 color = plan.background, linear = backdrop.color;
    Rgba8 color8 = backdrop.empty;
    if ((covered >> i & 1) != 0) {
      const Vec4 front{colors.r[i], colors.g[i], colors.b[i], colors.a[i]};
      color = behind(targets.color, x, y).color_over(front);
      if (wants_8_bit) color8 = behind(targets.color8, x, y).color8_over(front);
      if (over && !targets.linear.empty()) linear = targets.linear(x, y);
      linear = front + linear * (1 - front.w);
    }
    if (wants_8_bit) targets.color8(x, y) = color8;
    if (!targets.color.empty()) targets.color(x, y) = color;
    if (!targets.linear.empty()) targets.linear(x, y) = linear;
  }
}

void resolve_colors(const FrameRequest& request, const FramePlan& plan, const FrameGeometry& frame,
                    const VisibleBlock& block, std::uint64_t touched, const BlockColors* shaded,
                    const Window& w, BlockPixels to) {
  const Targets& targets = request.targets;
  const Backdrop& backdrop = plan.backdrop;
  bool wants_8_bit = !targets.color8.empty();
  if (block.covered == 0 && wants_8_bit && plan.writes == FramePlan::Writes::all) {
    for (int y = 0; y < w.rows; ++y)
      std::fill_n(to.data + y * to.stride, w.columns, backdrop.empty);
    wants_8_bit = false;
  }
  const bool only_8_bit = targets.color.empty() && targets.linear.empty();
  if (only_8_bit && !wants_8_bit) return;
  const bool stores_block = wants_8_bit && w.whole() && touched == ~std::uint64_t{0} &&
                            plan.writes != FramePlan::Writes::surfaces;
  if (stores_block && plan.at_once &&
      store_shaded(request.shading, frame, block, request.isa, backdrop.empty, to))
    return;
  BlockColors own;
  const BlockColors* colors = shaded;
  bool opaque = false;
  if (shaded == nullptr) {
    colors = &own;
    if (block.covered != 0) opaque = shade_block(request.shading, frame, block, request.isa, own);
  }
  const Kernels& kernel = kernels(request.isa);
  if (stores_block && opaque && !backdrop.linear) {
    kernel.store_opaque(*colors, block.covered, backdrop.empty, to.data, to.stride);
    if (only_8_bit) return;
    wants_8_bit = false;
  }
  if (opaque) std::fill_n(own.a, 64, 1.0F);
  if (stores_block && wants_8_bit) {
    kernel.store_blended(*colors, block.covered, backdrop, to.data, to.stride);
    wants_8_bit = false;
  }
  if (wants_8_bit || !only_8_bit)
    store_colors(targets, plan, *colors, block.covered, touched, w, wants_8_bit);
}

/// Shades into `colors`, and shades and stores Targets::extra with them.
void shade_extra(const FrameRequest& request, const FrameGeometry& frame, VisibleBlock block,
                 std::uint64_t touched, const Window& w, BlockColors& colors) {
  BlockColors extra[kMaxExtraTargets];
  block.extra = extra;
  if (block.covered != 0 && shade_block(request.shading, frame, block, request.isa, colors))
    std::fill_n(colors.a, 64, 1.0F);
  for (std::size_t k = 0; k < request.targets.extra.size(); ++k)
    for (std::uint64_t m = touched; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      const BlockColors& c = extra[k];
      request.targets.extra[k](w.x0 + i % kBlockSize, w.y0 + i / kBlockSize) =
          (block.covered >> i & 1) != 0 ? Vec4{c.r[i], c.g[i], c.b[i], c.a[i]} : Vec4{};
    }
}

void store_keys(const Targets& targets, const std::uint64_t* keys, std::uint64_t touched,
                const Window& w) {
  if (!targets.depth.empty()) {
    float depth[64];
    for (int i = 0; i < 64; ++i)
      depth[i] = std::bit_cast<float>(static_cast<std::uint32_t>(keys[i] >> kIdBits));
    store_block(targets.depth, depth, touched, w.x0, w.y0);
  }
  if (!targets.ids.empty()) {
    std::int64_t ids[64];
    for (int i = 0; i < 64; ++i)
      ids[i] = keys[i] == 0 ? -1 : static_cast<std::int64_t>(id_of_key(keys[i]));
    store_block(targets.ids, ids, touched, w.x0, w.y0);
  }
  if (!targets.ids32.empty()) {
    std::int32_t ids[64];
    for (int i = 0; i < 64; ++i)
      ids[i] = keys[i] == 0 ? -1 : static_cast<std::int32_t>(id_of_key(keys[i]));
    store_block(targets.ids32, ids, touched, w.x0, w.y0);
  }
  if (!targets.keys.empty()) store_block(targets.keys, keys, touched, w.x0, w.y0);
}

}  // namespace

std::uint64_t of_this_pass(const FrameRequest& request, const std::uint64_t* keys,
                           std::uint64_t covered) noexcept {
  if (request.draws.empty()) return 0;
  const std::uint64_t first = request.pass.first_id;
  std::uint64_t mask = 0;
  for (std::uint64_t m = covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    mask |= std::uint64_t{id_of_key(keys[i]) >= first} << i;
  }
  return mask;
}

int resolve_block(const FrameRequest& request, const FramePlan& plan, const FrameGeometry& frame,
                  const std::uint64_t* keys, int x0, int y0, void* scratch,
                  const BlockColors* shaded, BlockPixels to, const SeenBin* bin) noexcept {
  const Targets& targets = request.targets;
  const Window window{x0, y0, std::min(kBlockSize, request.width - x0),
                      std::min(kBlockSize, request.height - y0)};
  std::uint64_t covered = kernels(request.isa).covered(keys);
  std::uint64_t touched = ~std::uint64_t{0};
  if (!window.whole())
    touched =
        samples_inside({0, 0, request.width, request.height}, x0 / kBlockSize, y0 / kBlockSize);
  covered &= touched;
  if (plan.writes == FramePlan::Writes::nearer) covered = of_this_pass(request, keys, covered);
  if (plan.writes != FramePlan::Writes::all) touched = covered;
  if (touched == 0) return 0;
  LitBlock lit;
  VisibleBlock block{keys, covered, x0, y0, scratch};
  block.bin = bin;
  if (plan.normals) block.lit = &lit;
  BlockColors colors;
  if (!targets.extra.empty()) {
    shade_extra(request, frame, block, touched, window, colors);
    if (shaded == nullptr) shaded = &colors;
  }
  if (plan.colors != FramePlan::Colors::none) {
    if (to.data == nullptr && !targets.color8.empty())
      to = {&targets.color8(x0, y0), targets.color8.stride};
    resolve_colors(request, plan, frame, block, touched, shaded, window, to);
  }
  if (plan.keys) store_keys(targets, keys, touched, window);
  if (plan.surface) store_surfaces(request, frame, block, touched);
  return parallel::popcount(covered);
}

bool streams_colors(const FramePlan& plan, Rect rect) noexcept {
  const auto is_whole = [](int begin, int end) {
    return begin % kBlockSize == 0 && end % kBlockSize == 0 && end - begin <= kBinSize;
  };
  return plan.streams && is_whole(rect.x0, rect.x1) && is_whole(rect.y0, rect.y1);
}

void load_keys(const FrameRequest& request, Rect rect, const SurfaceView& surface) noexcept {
  const int bx0 = rect.x0 / kBlockSize, by0 = rect.y0 / kBlockSize;
  for (int by = by0; by * kBlockSize < rect.y1; ++by) {
    std::uint64_t* const row = surface.block(bx0, by);
    std::fill_n(row, static_cast<std::size_t>(block_columns(rect)) * 64, 0);
    if (!request.pass.load) continue;
    for (int y = by * kBlockSize; y < std::min((by + 1) * kBlockSize, rect.y1); ++y)
      for (int x = rect.x0; x < rect.x1; ++x)
        row[(x / kBlockSize - bx0) * 64 + y % kBlockSize * kBlockSize + x % kBlockSize] =
            request.targets.keys(x, y);
  }
}

void resolve_empty(const FrameRequest& request, const FramePlan& plan, Rect rect) noexcept {
  const Targets& targets = request.targets;
  if (plan.writes != FramePlan::Writes::all) return;
  if (!targets.color8.empty()) {
    const Kernels& kernel = kernels(request.isa);
    const bool streams = streams_colors(plan, rect);
    (streams ? kernel.stream_fill : kernel.fill)(
        to_straight_rgba8(plan.background), rect.x1 - rect.x0, rect.y1 - rect.y0,
        &targets.color8(rect.x0, rect.y0), targets.color8.stride);
    if (streams) kernel.end_stream();
  }
  const auto fill = [&](const auto& view, auto value) {
    if (view.empty()) return;
    for (int y = rect.y0; y < rect.y1; ++y)
      std::fill_n(view.row(y) + rect.x0, rect.x1 - rect.x0, value);
  };
  for (const ImageView<Vec4>& extra : targets.extra) fill(extra, Vec4{});
  for_each_target([&](const auto& row) {
    if (row.kind != TargetKind::color && row.kind != TargetKind::count)
      fill(targets.*row.image, empty_pixel(row, request.no_distance));
  });
  fill(targets.color, plan.background);
  fill(targets.linear, plan.backdrop.color);
}

}  // namespace rastrum::raster
