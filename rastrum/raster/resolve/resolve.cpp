#include <rastrum/raster/resolve/resolve.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <unordered_map>

#include <rastrum/core/enum.hpp>
#include <rastrum/core/srgb.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/mask.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/kernels/kernels.hpp>
#include <rastrum/raster/resolve/surfaces.hpp>
#include <rastrum/raster/shade/lit_constants.hpp>
#include <rastrum/raster/shade/srgb.hpp>
#include <rastrum/scene/mesh_checks.hpp>

namespace rastrum::raster {
namespace {

/// The part of the image that a block covers.
struct Window {
  int x0, y0, columns, rows;
  [[nodiscard]] bool whole() const { return columns == kBlockSize && rows == kBlockSize; }
};

/// `b`: display values with straight alpha. Costs three powers in linear light.
Backdrop backdrop_of(Vec4 b, bool linear_light) {
  Backdrop backdrop = Backdrop::of(b);
  if (!linear_light) return backdrop;
  if (b.w != 0)
    for (float* const channel : {&b.x, &b.y, &b.z})
      *channel = static_cast<float>(linear_from_srgb(static_cast<double>(*channel)));
  backdrop.color = premultiplied_from_straight(b);
  backdrop.linear = true;
  return backdrop;
}

Vec4 straight(Vec4 premultiplied) {
  return straight_from_premultiplied(premultiplied);
}
Vec4 straight(Rgba8 c) {
  return straight_from_rgba8(c);
}

/// Stores colours in every case: float targets, pictures that are drawn over, blocks cut by the
/// image's edge, passes that touch some pixels alone. Pixels that are not in `touched` keep what
/// they have.
void store_colors(const FrameRequest& request, const BlockColors& colors, std::uint64_t covered,
                  std::uint64_t touched, const Backdrop& backdrop, const Window& w,
                  bool wants_8_bit) {
  const Targets& targets = request.targets;
  const Vec4 background = premultiplied_from_straight(request.background);
  const auto behind = [&](const auto& target, int x, int y) {
    return targets.over && !target.empty()
               ? backdrop_of(straight(target(x, y)), request.linear_light)
               : backdrop;
  };
  for (std::uint64_t m = touched; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = w.x0 + i % kBlockSize, y = w.y0 + i / kBlockSize;
    Vec4 color = background, linear = backdrop.color;
    Rgba8 color8 = backdrop.empty;
    if ((covered >> i & 1) != 0) {
      const Vec4 front{colors.r[i], colors.g[i], colors.b[i], colors.a[i]};
      color = behind(targets.color, x, y).color_over(front);
      if (wants_8_bit) color8 = behind(targets.color8, x, y).color8_over(front);
      if (targets.over && !targets.linear.empty()) linear = targets.linear(x, y);
      linear = front + linear * (1 - front.w);
    }
    if (wants_8_bit) targets.color8(x, y) = color8;
    if (!targets.color.empty()) targets.color(x, y) = color;
    if (!targets.linear.empty()) targets.linear(x, y) = linear;
  }
}

void resolve_colors(const FrameRequest& request, const FrameGeometry& frame,
                    const VisibleBlock& block, std::uint64_t touched, const BlockColors* shaded,
                    const Backdrop& backdrop, const Window& w, BlockPixels to) {
  const Targets& targets = request.targets;
  bool wants_8_bit = !targets.color8.empty();
  if (block.covered == 0 && wants_8_bit && !targets.load && !targets.over) {
    for (int y = 0; y < w.rows; ++y)
      std::fill_n(to.data + y * to.stride, w.columns, backdrop.empty);
    wants_8_bit = false;
  }
  const bool only_8_bit = targets.color.empty() && targets.linear.empty();
  if (only_8_bit && !wants_8_bit) return;
  const bool stores_block =
      wants_8_bit && w.whole() && touched == ~std::uint64_t{0} && !targets.over;
  if (stores_block && only_8_bit && shaded == nullptr && block.lit == nullptr &&
      !request.linear_light && request.shading.store(frame, block, request.isa, backdrop.empty, to))
    return;
  BlockColors own;
  const BlockColors* colors = shaded;
  bool opaque = false;
  if (shaded == nullptr) {
    colors = &own;
    if (block.covered != 0) opaque = request.shading.shade(frame, block, request.isa, own);
  }
  const Kernels& kernel = kernels(request.isa);
  if (stores_block && opaque && !request.linear_light) {
    kernel.store_opaque(*colors, block.covered, backdrop.empty, to.data, to.stride);
    if (only_8_bit) return;
    wants_8_bit = false;
  }
  if (opaque) std::fill_n(own.a, 64, 1.0F);
  if (stores_block && wants_8_bit) {
    kernel.store_blended(*colors, block.covered, backdrop, to.data, to.stride);
    wants_8_bit = false;
  }
  if (wants_8_bit || !targets.color.empty() || !targets.linear.empty())
    store_colors(request, *colors, block.covered, touched, backdrop, w, wants_8_bit);
}

/// Shades into `colors` and stores all of Targets::extra, which are shaded with them.
void shade_extra(const FrameRequest& request, const FrameGeometry& frame, VisibleBlock block,
                 std::uint64_t touched, const Window& w, BlockColors& colors) {
  BlockColors extra[kMaxExtraTargets];
  block.extra = extra;
  if (block.covered != 0 && request.shading.shade(frame, block, request.isa, colors))
    std::fill_n(colors.a, 64, 1.0F);
  for (std::size_t k = 0; k < request.targets.extra.size(); ++k)
    for (std::uint64_t m = touched; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      const BlockColors& c = extra[k];
      request.targets.extra[k](w.x0 + i % kBlockSize, w.y0 + i / kBlockSize) =
          (block.covered >> i & 1) != 0 ? Vec4{c.r[i], c.g[i], c.b[i], c.a[i]} : Vec4{};
    }
}

void store_keys(const FrameRequest& request, const std::uint64_t* keys, std::uint64_t touched,
                const Window& w) {
  const Targets& targets = request.targets;
  const Rect part = request.part.value_or(Rect{});
  const int x0 = w.x0 - part.x0, y0 = w.y0 - part.y0;
  if (!targets.depth.empty()) {
    float depth[64];
    for (int i = 0; i < 64; ++i)
      depth[i] = std::bit_cast<float>(static_cast<std::uint32_t>(keys[i] >> kIdBits));
    store_block(targets.depth, depth, touched, x0, y0);
  }
  if (!targets.ids.empty()) {
    std::int64_t ids[64];
    for (int i = 0; i < 64; ++i)
      ids[i] = keys[i] == 0 ? -1 : static_cast<std::int64_t>(id_of_key(keys[i]));
    store_block(targets.ids, ids, touched, x0, y0);
  }
  if (!targets.ids32.empty()) {
    std::int32_t ids[64];
    for (int i = 0; i < 64; ++i)
      ids[i] = keys[i] == 0 ? -1 : static_cast<std::int32_t>(id_of_key(keys[i]));
    store_block(targets.ids32, ids, touched, x0, y0);
  }
  if (!targets.keys.empty()) store_block(targets.keys, keys, touched, x0, y0);
}

[[noreturn]] void refuse(const DrawNames& names, std::size_t draw, const std::string& problem) {
  throw Error(Errc::invalid_argument, names.of(draw).append(": ").append(problem));
}

void check_draw(const Draw& draw, const DrawNames& names, std::size_t number) {
  const auto require = [&](bool ok, const char* what) {
    if (!ok) refuse(names, number, what);
  };
  require(draw.topology >= Topology::points, "its topology is 0, which is no value of its enum");
  const auto check = [&](auto value, auto last, const char* what) {
    if (value > last)  // a million draws make no million names
      check_enum(value, last, names.of(number).append(what));
  };
  check(draw.topology, Topology::triangles, ": its topology");
  check(draw.cull, Cull::front, ": its cull");
  check(draw.winding, Winding::either, ": its winding");
  if (draw.quadrics != nullptr) return;
  require(bool{draw.source}, "its source is null; set it to what projects its vertices");
  if (draw.mesh != nullptr) {
    if (const std::string problem = faces_problem(*draw.mesh); !problem.empty())
      refuse(names, number, problem);
    require(draw.topology == Topology::triangles, "a mesh has triangles");
  }
  const bool indexed = !draw.indices.empty();
  const std::size_t corners = indexed ? draw.indices.size() : draw.own_vertices();
  const std::uint64_t most = draw.mesh != nullptr
                                 ? draw.mesh->triangle_count()
                                 : corners / static_cast<std::size_t>(draw.topology);
  // Points and lines are counted from their own arrays, so their number is right.
  if (draw.points == nullptr && draw.lines == nullptr && draw.own_primitives() > most)
    refuse(names, number,
           "primitive_count is " + std::to_string(draw.own_primitives()) + ", but its " +
               std::to_string(corners) + (indexed ? " indices" : " vertices") + " make up " +
               std::to_string(most));
  // Written so that a NaN fails.
  require(draw.line_width > 0 && draw.line_width <= kMaxLineWidth,
          "the line width must be > 0 and at most 4096 px");
  require(draw.point_size > 0 && draw.point_size <= kMaxPointSize,
          "the point size must be > 0 and at most 4096 px");
  require(std::isfinite(draw.depth_bias) && std::isfinite(draw.depth_bias_slope),
          "the depth bias must be finite");
  if (draw.material_flags.empty()) return;
  require(draw.face_materials.size() >=
              (draw.mesh != nullptr ? draw.mesh->face_count() : draw.own_primitives()),
          "it has flags by material, but fewer face materials than primitives");
  require(
      first_beyond(draw.face_materials, draw.material_flags.size()) == draw.face_materials.size(),
      "a face material is out of range");
}

}  // namespace

std::uint64_t of_this_pass(const FrameRequest& request, const std::uint64_t* keys,
                           std::uint64_t covered) noexcept {
  if (request.draws.empty()) return 0;
  const std::uint64_t first = request.targets.first_id;
  std::uint64_t mask = 0;
  for (std::uint64_t m = covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    mask |= std::uint64_t{id_of_key(keys[i]) >= first} << i;
  }
  return mask;
}

Backdrop backdrop_of(const FrameRequest& request) {
  return backdrop_of(request.background, request.linear_light);
}

int resolve_block(const FrameRequest& request, const FrameGeometry& frame, const Backdrop& backdrop,
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
  if (targets.over) touched = covered;
  if (targets.load) touched = covered = of_this_pass(request, keys, covered);
  if (touched == 0) return 0;
  LitBlock lit;
  VisibleBlock block{keys, covered, x0, y0, scratch};
  block.bin = bin;
  if (!targets.normals.empty() || !targets.camera_normals.empty()) block.lit = &lit;
  BlockColors colors;
  if (!targets.extra.empty()) {
    shade_extra(request, frame, block, touched, window, colors);
    if (shaded == nullptr) shaded = &colors;
  }
  if (request.wants_colors()) {
    if (to.data == nullptr && !targets.color8.empty())
      to = {&targets.color8(x0, y0), targets.color8.stride};
    resolve_colors(request, frame, block, touched, shaded, backdrop, window, to);
  }
  if (!targets.depth.empty() || !targets.ids.empty() || !targets.ids32.empty() ||
      !targets.keys.empty())
    store_keys(request, keys, touched, window);
  if (request.wants_surface) store_surfaces(request, frame, block, touched);
  return parallel::popcount(covered);
}

bool streams_colors(const FrameRequest& request, Rect rect) noexcept {
  // Last-level caches of today hold smaller pictures until they are read next.
  constexpr std::uint64_t kLeast = std::uint64_t{24} << 20;
  const Targets& targets = request.targets;
  const ImageView<Rgba8>& to = targets.color8;
  if (to.empty() || targets.load || targets.over) return false;
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(to.width) * static_cast<std::uint64_t>(to.height);
  const auto is_whole = [](int begin, int end) {
    return begin % kBlockSize == 0 && end % kBlockSize == 0 && end - begin <= kBinSize;
  };
  return pixels * sizeof(Rgba8) >= kLeast && is_whole(rect.x0, rect.x1) &&
         is_whole(rect.y0, rect.y1);
}

void load_keys(const Targets& targets, Rect rect, const SurfaceView& surface, Rect part) noexcept {
  const int bx0 = rect.x0 / kBlockSize, by0 = rect.y0 / kBlockSize;
  for (int by = by0; by * kBlockSize < rect.y1; ++by) {
    std::uint64_t* const row = surface.block(bx0, by);
    std::fill_n(row, static_cast<std::size_t>(block_columns(rect)) * 64, 0);
    if (!targets.load) continue;
    for (int y = by * kBlockSize; y < std::min((by + 1) * kBlockSize, rect.y1); ++y)
      for (int x = rect.x0; x < rect.x1; ++x)
        row[(x / kBlockSize - bx0) * 64 + y % kBlockSize * kBlockSize + x % kBlockSize] =
            targets.keys(x - part.x0, y - part.y0);
  }
}

void resolve_empty(const FrameRequest& request, Rect rect) noexcept {
  const Targets& targets = request.targets;
  if (targets.load || targets.over) return;
  const Vec4 background = premultiplied_from_straight(request.background);
  const Rgba8 background8 = to_straight_rgba8(background);
  const Vec4 linear = targets.linear.empty() ? Vec4{} : backdrop_of(request).color;
  const Rect part = request.part.value_or(Rect{});
  const auto fill = [&](const auto& target, int y, auto value) {
    if (!target.empty()) std::fill_n(target.row(y) + rect.x0, rect.x1 - rect.x0, value);
  };
  // These targets hold the part alone, as in store_keys.
  const auto fill_part = [&](const auto& target, int y, auto value) {
    if (!target.empty())
      std::fill_n(target.row(y - part.y0) + (rect.x0 - part.x0), rect.x1 - rect.x0, value);
  };
  if (!targets.color8.empty()) {
    const Kernels& kernel = kernels(request.isa);
    const bool streams = streams_colors(request, rect);
    (streams ? kernel.stream_fill : kernel.fill)(background8, rect.x1 - rect.x0, rect.y1 - rect.y0,
                                                 &targets.color8(rect.x0, rect.y0),
                                                 targets.color8.stride);
    if (streams) kernel.end_stream();
  }
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (const ImageView<Vec4>& extra : targets.extra) fill(extra, y, Vec4{});
    fill(targets.color, y, background);
    fill_part(targets.depth, y, 0.0F);
    fill_part(targets.ids, y, std::int64_t{-1});
    fill_part(targets.keys, y, std::uint64_t{0});
    fill(targets.linear, y, linear);
    if (!request.wants_surface) continue;
    fill(targets.instances, y, std::int64_t{-1});
    fill(targets.primitives, y, std::int64_t{-1});
    fill_part(targets.ids32, y, std::int32_t{-1});
    fill(targets.instances32, y, std::int32_t{-1});
    fill(targets.primitives32, y, std::int32_t{-1});
    fill(targets.barycentrics, y, Vec2{});
    fill(targets.positions, y, Vec3{});
    fill(targets.normals, y, Vec3{});
    fill(targets.camera_normals, y, Vec3{});
    fill(targets.view_depth, y, targets.no_distance);
    fill(targets.distance, y, targets.no_distance);
    fill(targets.albedo, y, Vec4{});
    fill(targets.scalars, y, kNoNumber);
  }
}

Totals number_draws(std::span<Draw> draws, std::uint64_t first_id, const DrawNames& names) {
  Totals totals;
  std::unordered_map<Shading, std::size_t, Shading::Hash> of_shading;
  std::size_t* number = nullptr;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    Draw& draw = draws[i];
    check_draw(draw, names, i);
    draw.first_id = first_id + totals.primitives;
    draw.first_vertex = totals.vertices;
    // Mostly all draws have one shading, so few have to be looked up.
    if (i == 0 || draw.shading != draws[i - 1].shading) number = &of_shading[draw.shading];
    draw.number = (*number)++;
    totals.primitives += draw.primitive_count;
    totals.vertices += draw.vertex_count;
  }
  if (totals.primitives > kMaxId || first_id > kMaxId - totals.primitives)
    throw Error(Errc::invalid_argument,
                "the scene has " + std::to_string(first_id + totals.primitives) +
                    " primitives; at most " + std::to_string(kMaxId) + " have an id");
  return totals;
}

void check_indices(std::span<const Draw> draws, const DrawNames& names) {
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const Draw& draw = draws[i];
    const IndexView indices = draw.index_view();
    if (const std::size_t at = first_beyond(indices, draw.own_vertices()); at != indices.size())
      refuse(names, i,
             "indices[" + std::to_string(at) + "]: index " + indices.text(at) +
                 " is out of range, there are " + std::to_string(draw.own_vertices()) +
                 " vertices");
  }
}

}  // namespace rastrum::raster
