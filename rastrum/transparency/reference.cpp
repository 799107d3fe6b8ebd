// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/transparency/reference.hpp>

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include <rastrum/core/reject.hpp>
#include <rastrum/raster/context/added_transparency.hpp>
#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/frame/reference.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/setup/assemble.hpp>
#include <rastrum/raster/setup/set_up.hpp>
#include <rastrum/raster/shade/shader.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/transparency/blend.hpp>

namespace rastrum::transparency {
namespace {

using raster::BlockColors;
using raster::kBlockSize;
using raster::Piece;

/// A triangle, or one side of a quadric, in a pixel.
struct Fragment {
  std::uint64_t keys[raster::kMaxSamples] = {};  ///< at each sample; 0: not covered
  std::uint64_t shaded_key = 0;                  ///< where it is shaded
  float dx = 0, dy = 0;                          ///< of that place, px from the centre
  bool translucent = false;
  Vec4 color;
};

using Pixel = std::vector<Fragment>;

/// Row, column, and whether it is the back of a quadric.
using Place = std::tuple<int, int, bool>;

/// By pixel; the nearest where the primitive's pieces overlap.
void add_keys(const raster::FrameRequest& request, const Piece& piece,
              std::map<Place, Fragment>& pixels, int sample) {
  const bool away = raster::is_quadric(piece) && (piece.flags & raster::kFacesAway) != 0;
  raster::for_each_covered(piece, {0, 0, request.width, request.height}, [&](int x, int y) {
    Fragment& f = pixels[{y, x, away}];
    const std::uint64_t key = raster::make_key(raster::depth_at(piece, x, y), piece.low);
    std::uint64_t& nearest = sample < 0 ? f.shaded_key : f.keys[sample];
    nearest = std::max(nearest, key);
  });
}

raster::Block block_of(int x, int y) {
  return {0, static_cast<std::uint16_t>(x / kBlockSize), static_cast<std::uint16_t>(y / kBlockSize),
          std::uint64_t{1} << (y % kBlockSize * kBlockSize + x % kBlockSize)};
}

struct Scene {
  raster::FrameRun& under_way;
  const raster::FrameRequest& request;
  const raster::FrameGeometry& frame;
  std::vector<Pixel> pixels;

  bool keeps(const raster::Draw& draw, std::uint64_t primitive, const Place& place,
             const Fragment& f) {
    const auto [y, x, away] = place;
    const std::uint32_t flags = frame.flags_of(draw, primitive);
    if ((flags & raster::kMayDrop) == 0) return true;
    raster::ShadingPoints points{};
    const raster::Block block = block_of(x, y);
    const int i = std::countr_zero(block.mask);
    points.dx[i] = f.dx;
    points.dy[i] = f.dy;
    Piece piece{};
    piece.flags = flags | (away ? raster::kFacesAway : 0);
    piece.low = f.shaded_key & raster::kIdMask;
    piece.z0 = std::bit_cast<float>(static_cast<std::uint32_t>(f.shaded_key >> raster::kIdBits));
    return request.kept(frame, piece, block, &points) != 0;
  }

  raster::Fate add(const raster::Draw& draw, std::uint64_t primitive) {
    const auto offsets = raster::sample_offsets(request.samples);
    std::map<Place, Fragment> covered;
    raster::Fate fate = raster::Fate::culled;
    for (std::size_t s = 0; s < offsets.size(); ++s) {
      const raster::Fate here = raster::assemble_primitive(
          frame, draw, primitive,
          [&](const Piece& p) { add_keys(request, p, covered, static_cast<int>(s)); },
          static_cast<std::uint32_t>(s), offsets[s]);
      if (here != raster::Fate::culled) fate = here;
    }
    // Shaded at the centre if the triangle covers it, else at the first sample that it covers.
    std::map<Place, Fragment> centres;
    (void)raster::assemble_primitive(frame, draw, primitive,
                                     [&](const Piece& p) { add_keys(request, p, centres, -1); });
    for (auto& [place, fragment] : covered) {
      const auto [y, x, away] = place;
      const auto centre = centres.find(place);
      if (centre != centres.end()) {
        fragment.shaded_key = centre->second.shaded_key;
      } else {
        const auto first =
            static_cast<std::size_t>(std::find_if(fragment.keys, fragment.keys + offsets.size(),
                                                  [](std::uint64_t w) { return w != 0; }) -
                                     fragment.keys);
        constexpr float kPx = 1.0F / raster::kSubpixels;
        fragment.shaded_key = fragment.keys[first];
        fragment.dx = static_cast<float>(offsets[first].x) * kPx;
        fragment.dy = static_cast<float>(offsets[first].y) * kPx;
      }
      const auto samples = static_cast<std::uint32_t>(
          std::ranges::count_if(fragment.keys, [](std::uint64_t key) { return key != 0; }));
      under_way.fragments += samples;
      if (!request.targets.overdraw.empty()) request.targets.overdraw(x, y) += samples;
      if (!keeps(draw, primitive, place, fragment)) continue;
      fragment.translucent = request.transparency.method != Transparency::none &&
                             (draw.flags_of(primitive) & kTranslucent) != 0;
      fragment.color = shade(x, y, fragment);
      pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(request.width) +
             static_cast<std::size_t>(x)]
          .push_back(fragment);
    }
    return fate;
  }

  Vec4 shade(int x, int y, const Fragment& f) {
    if (!request.shading) return {};
    alignas(64) std::uint64_t keys[64] = {};
    raster::ShadingPoints points{};
    const raster::Block block = block_of(x, y);
    const int i = std::countr_zero(block.mask);
    keys[i] = f.shaded_key;
    points.dx[i] = f.dx;
    points.dy[i] = f.dy;
    raster::VisibleBlock visible{keys, block.mask, block.bx * kBlockSize, block.by * kBlockSize,
                                 under_way.shader_scratch()};
    visible.points = &points;
    BlockColors colors;
    const bool opaque = shade_block(request.shading, frame, visible, Isa::scalar, colors);
    return {colors.r[i], colors.g[i], colors.b[i], opaque ? 1.0F : colors.a[i]};
  }

  /// `loaded` is the key from earlier passes. Returns the pixel's key.
  std::uint64_t resolve(int x, int y, std::uint64_t loaded, LayerBlend& blend,
                        BlockColors& colors) {
    const Pixel& fragments =
        pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(request.width) +
               static_cast<std::size_t>(x)];
    const int i = y % kBlockSize * kBlockSize + x % kBlockSize;
    const int samples = request.samples;
    raster::FragmentSink* const sink = request.sink;
    std::uint64_t nearest = 0;
    Vec4 sum{0, 0, 0, 0};
    for (int s = 0; s < samples; ++s) {
      const Fragment* surface = nullptr;
      for (const Fragment& f : fragments)
        if (!f.translucent && f.keys[s] > (surface == nullptr ? loaded : surface->keys[s]))
          surface = &f;
      const std::uint64_t opaque = surface == nullptr ? loaded : surface->keys[s];
      std::vector<const Fragment*> layers;
      for (const Fragment& f : fragments)
        if (f.translucent && f.keys[s] > opaque) layers.push_back(&f);
      const std::uint64_t sort_key =
          blend.order() == LayerOrder::depth ? ~std::uint64_t{0} : raster::kIdMask;
      std::ranges::stable_sort(layers, [&](const Fragment* a, const Fragment* b) {
        return (a->keys[s] & sort_key) > (b->keys[s] & sort_key);
      });
      BlockColors behind = {}, layer = {}, out;
      alignas(64) std::uint64_t keys[64] = {};
      if (under_way.plan.translucent == raster::Translucent::left_out) layers.clear();
      const auto hand_on = [&](const Fragment& f, const BlockColors& color) {
        keys[i] = f.keys[s];
        if (sink != nullptr)
          sink->take(
              {x / kBlockSize, y / kBlockSize, keys, std::uint64_t{1} << i,
               under_way.plan.translucent == raster::Translucent::colors_to_sink ? &color : nullptr,
               s, !f.translucent});
      };
      if (surface != nullptr) behind.set(i, surface->color);
      blend.begin(behind);
      for (int pass = 0; pass < blend.passes(); ++pass) {
        blend.begin_pass(pass);
        for (const Fragment* f : layers) {
          layer.set(i, f->color);
          hand_on(*f, layer);
          const std::uint64_t bit = std::uint64_t{1} << i;
          if ((blend.layer({keys, bit, layer}) & bit) != 0) break;
        }
      }
      blend.finish(out);
      if (samples > 1 && surface != nullptr) hand_on(*surface, behind);
      sum = sum + Vec4{out.r[i], out.g[i], out.b[i], out.a[i]};
      nearest = std::max(nearest, opaque);
      if (sink != nullptr) continue;
      for (const Fragment* f : layers) nearest = std::max(nearest, f->keys[s]);
    }
    colors.set(i, samples == 1 ? sum : sum * (1.0F / static_cast<float>(samples)));
    return nearest;
  }
};

class LayeredReference final : public raster::Method {
 public:
  [[nodiscard]] raster::Needs needs() const override {
    return {.rasterizer = "reference",
            .visibility = "layers",
            .colors = true,
            .quadrics = true,
            .whole_view = true};
  }

  void draw(raster::FrameRun& frame, std::uint64_t first, std::uint64_t last) override {
    const raster::FrameRequest& request = frame.request;
    if (filter_of(request.transparency) != 0)
      reject(
          "the filter's errors come from sorted blocks, which --device serial does not "
          "have; use --device threads");
    Scene scene{frame, frame.request, frame.geometry, {}};
    scene.pixels.resize(static_cast<std::size_t>(request.width) *
                        static_cast<std::size_t>(request.height));
    FrameStats::Triangles triangles;
    raster::for_each_primitive(frame, first, last,
                               [&](const raster::Draw& draw, std::uint64_t primitive) {
                                 raster::count_fate(scene.add(draw, primitive), triangles);
                               });
    raster::count_triangles(frame, triangles);
    frame.watch.lap(frame.stats, "rasterize");
    const std::unique_ptr<LayerBlend> blend = make_blend(request.transparency, Isa::scalar);
    for (int y = frame.view.y0; y < frame.view.y1; ++y) {
      throw_if_stopped();
      for (int x = frame.view.x0; x < frame.view.x1; ++x) {
        const int bx = x / kBlockSize, by = y / kBlockSize;
        std::uint64_t& key =
            frame.surface.block(bx, by)[y % kBlockSize * kBlockSize + x % kBlockSize];
        key = scene.resolve(x, y, key, *blend, *frame.surface.colors_of(bx, by));
      }
    }
    frame.watch.lap(frame.stats, "blend");
  }
};

}  // namespace

std::unique_ptr<raster::Method> make_layered_reference() {
  return std::make_unique<LayeredReference>();
}

}  // namespace rastrum::transparency
