#include <rastrum/raster/resolve/sampled_colors.hpp>

#include <algorithm>
#include <bit>

#include <rastrum/raster/assemble/assemble.hpp>
#include <rastrum/raster/cover/rules.hpp>
#include <rastrum/raster/draws/hooks.hpp>

namespace rastrum::raster {
namespace {

constexpr std::uint16_t kNoPlace = 0xFFFF;
}  // namespace

/// Where a primitive is shaded in a pixel.
struct SampledColors::Place {
  std::uint64_t key = 0;
  SampleOffset at{};  ///< from the pixel's centre
};

/// A primitive, as it is found again.
struct SampledColors::Primitive {
  /// value(x, y) = base + a x + b y ≥ 0 is inside, x and y in n.8.
  struct SubpixelEdge {
    std::int64_t base, a, b;
  };
  const Draw* draw;
  bool is_clipped, has_plane;
  ProjectedVertex vertices[3];
  std::int64_t area;
  SubpixelEdge edges[3];
  Piece piece;  ///< at the centres; its `low` is always set, 0 where nothing is kept
};

/// Finds places. Neighbours, also those of the next block, mostly share their primitives, of which
/// some are kept.
class SampledColors::Finder {
 public:
  Finder(const BinContext& context, Primitive* kept)
      : frame_(*context.frame),
        offsets_(sample_offsets(context.request->samples)),
        wants_depth_(context.request->shading.wants_depth()),
        kept_(kept) {}

  /// Of the primitive of `key`, which some sample of the pixel sees; `all`: all of them do, and so
  /// would the centre, about which they lie.
  Place find(std::uint64_t key, int x, int y, bool all) {
    const std::uint64_t low = key & kIdMask;
    Primitive& p = kept_[low % kKept];
    if (p.piece.low != low) begin(low, p);
    // A point or line is at all samples of its pixels.
    if (p.draw->topology != Topology::triangles) return {key, {}};
    if (p.is_clipped) return find_clipped(p, key, x, y);
    if (all) return {wants_depth_ ? key_at(p, {}, x, y) : key, {}};
    // A moved piece's edges at the centre are the piece's at the sample.
    const std::int64_t cx = std::int64_t{x} * kSubpixels + kHalfPixel;
    const std::int64_t cy = std::int64_t{y} * kSubpixels + kHalfPixel;
    std::int64_t value[3];
    for (int k = 0; k < 3; ++k) value[k] = p.edges[k].base + p.edges[k].a * cx + p.edges[k].b * cy;
    SampleOffset at{};
    if ((value[0] | value[1] | value[2]) < 0)
      for (const SampleOffset offset : offsets_) {
        at = offset;  // some sample sees it
        std::int64_t outside = 0;
        for (int k = 0; k < 3; ++k) outside |= value[k] + p.edges[k].a * at.x + p.edges[k].b * at.y;
        if (outside >= 0) break;
      }
    return {wants_depth_ ? key_at(p, at, x, y) : key, at};
  }

 private:
  void begin(std::uint64_t low, Primitive& p) {
    const std::uint64_t id = kIdMask - low;
    if (draw_ == nullptr || id - draw_->first_id >= draw_->primitive_count)
      draw_ = &frame_.draw_of(id);
    p.draw = draw_;
    p.piece.low = low;
    p.has_plane = p.is_clipped = false;
    if (draw_->topology != Topology::triangles) return;
    std::uint32_t index[3];
    draw_->vertices(id - draw_->first_id, index);
    for (int c = 0; c < 3; ++c) {
      p.vertices[c] = frame_.vertex(*draw_, index[c]);
      p.is_clipped |= p.vertices[c].x_fx8 == kNeedsClip;
    }
    if (p.is_clipped) return;
    Piece& piece = p.piece;
    piece.flags = 0;
    p.area = twice_area(p.vertices[0], p.vertices[1], p.vertices[2]);
    set_corners(p.vertices[0], p.vertices[1], p.vertices[2], p.area, piece);
    for (int i = 0; i < 3; ++i) {
      const int j = i == 2 ? 0 : i + 1;
      const std::int64_t a = piece.y[i] - piece.y[j], b = piece.x[j] - piece.x[i];
      const bool top_left = a > 0 || (a == 0 && b > 0);
      p.edges[i] = {-(a * piece.x[i] + b * piece.y[i]) - (top_left ? 0 : 1), a, b};
    }
  }
  static std::uint64_t key_at(Primitive& p, SampleOffset at, int x, int y) {
    if (!p.has_plane) {
      set_depth_plane(p.vertices[0], p.vertices[1], p.vertices[2], p.area, p.piece);
      add_depth_bias(p.piece, p.draw->depth_bias, p.draw->depth_bias_slope);
      p.has_plane = true;
    }
    Piece plane;  // moved(), of what the depth reads
    plane.x[0] = p.piece.x[0] - at.x;
    plane.y[0] = p.piece.y[0] - at.y;
    plane.z0 = p.piece.z0;
    plane.zx = p.piece.zx;
    plane.zy = p.piece.zy;
    return make_key(plane_depth_at(plane, x, y), p.piece.low);
  }
  /// Of one that has to be clipped: the nearest of the pieces that cover it.
  Place find_clipped(const Primitive& p, std::uint64_t key, int x, int y) {
    Place place;
    if (covers_at(p, {}, x, y, place)) return place;
    for (const SampleOffset at : offsets_)
      if (covers_at(p, at, x, y, place)) return place;
    return {key, {}};  // not reached
  }
  bool covers_at(const Primitive& p, SampleOffset at, int x, int y, Place& place) {
    bool covered = false;
    (void)assemble_primitive(
        frame_, *p.draw, kIdMask - p.piece.low - p.draw->first_id,
        [&](const Piece& piece) {
          if (!covers_centre(edges_of(piece), x, y)) return;
          place = {std::max(place.key, make_key(depth_at(piece, x, y), piece.low)), at};
          covered = true;
        },
        0, at);
    return covered;
  }

  const FrameGeometry& frame_;
  std::span<const SampleOffset> offsets_;
  bool wants_depth_;  ///< else any key of the primitive will do
  const Draw* draw_ = nullptr;
  Primitive* kept_;  ///< kKept, by the last bits of `low`
};

SampledColors::SampledColors() : kept_(std::make_unique<Primitive[]>(kKept)) {}
SampledColors::SampledColors(SampledColors&&) noexcept = default;
SampledColors::~SampledColors() = default;

void SampledColors::begin() {
  for (std::size_t i = 0; i < kKept; ++i) kept_[i].piece.low = 0;
}

void SampledColors::resolve(const BinContext& context, const SampledKeys& keys, int bx, int by,
                            std::uint64_t* nearest, BlockColors& out) {
  const std::size_t samples = keys.samples.size();
  const int x0 = bx * kBlockSize, y0 = by * kBlockSize;
  context.kernel->merge(keys, x0, y0, nearest, centre_keys_, seen_);
  const std::uint64_t covered = seen_.covered, mixed = seen_.mixed;
  if (!context.request->wants_colors() || covered == 0) return;

  bx_ = bx;
  by_ = by;
  centred_ = 0;
  packed_ = groups_ = 0;
  // A triangle that two opposite samples see, or all, covers the centre between them.
  const bool knows = !context.clips && !context.request->shading.wants_depth();
  if (knows) centred_ = covered & ~mixed;
  const std::uint64_t alike = centred_;
  Finder finder(context, kept_.get());
  std::uint16_t places[64][kMaxSamples];
  for (std::uint64_t m = covered & ~alike; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = x0 + i % kBlockSize, y = y0 + i / kBlockSize;
    std::uint16_t(&at)[kMaxSamples] = places[i];
    if ((mixed >> i & 1) == 0) {
      add(context, i, finder.find(keys.at(x, y, 0), x, y, true), at[0]);
      continue;
    }
    const std::uint64_t first = seen_.first[i];
    const std::uint64_t centred = knows ? seen_.centred[i] : 0;
    for (std::size_t s = 0; s < samples; ++s) {
      const std::size_t same = first >> (4 * s) & 15;
      if (same != s) {
        at[s] = at[same];
        continue;
      }
      const std::uint64_t key = keys.at(x, y, s);
      at[s] = kNoPlace;
      if (key != 0)
        add(context, i, (centred >> s & 1) != 0 ? Place{key, {}} : finder.find(key, x, y, false),
            at[s]);
    }
  }
  flush(context);
  if (centred_ != 0) shade(context, centre_keys_, centred_, nullptr, colors_[0]);

  // Sample after sample, as layers add them up.
  const float share = 1.0F / static_cast<float>(samples);
  const auto mean = [&](const float* of_centres, float* to) {
    for (std::size_t i = 0; i < 64; ++i) {
      float sum = 0;
      for (std::size_t s = 0; s < samples; s += 4)
        sum = (((sum + of_centres[i]) + of_centres[i]) + of_centres[i]) + of_centres[i];
      to[i] = sum * share;
    }
  };
  if (alike != 0) {
    mean(colors_[0].r, out.r);
    mean(colors_[0].g, out.g);
    mean(colors_[0].b, out.b);
    mean(colors_[0].a, out.a);
  }
  // All others, where a sample sees something else.
  for (std::uint64_t m = covered & ~alike; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const bool one = (mixed >> i & 1) == 0;
    Vec4 sum;
    for (std::size_t s = 0; s < samples; ++s) {
      const std::uint16_t at = places[i][one ? 0 : s];
      if (at == kNoPlace) continue;
      const BlockColors& c = colors_[at / 64];
      const std::size_t k = at % 64;
      sum = sum + Vec4{c.r[k], c.g[k], c.b[k], c.a[k]};
    }
    out.set(i, sum * share);
  }
}

std::uint64_t SampledColors::test(const BinContext& context, const Piece& piece,
                                  const Block& block) {
  Finder finder(context, kept_.get());
  constexpr float kPx = 1.0F / kSubpixels;
  ShadingPoints points;
  for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const Place place = finder.find(piece.low, block.bx * kBlockSize + i % kBlockSize,
                                    block.by * kBlockSize + i / kBlockSize, false);
    points.dx[i] = static_cast<float>(place.at.x) * kPx;
    points.dy[i] = static_cast<float>(place.at.y) * kPx;
  }
  return context.request->kept(*context.frame, piece, block, &points);
}

void SampledColors::add(const BinContext& context, int pixel, const Place& place,
                        std::uint16_t& at) {
  const std::uint64_t bit = std::uint64_t{1} << pixel;
  if (place.at.x == 0 && place.at.y == 0 && (centred_ & bit) == 0) {
    centre_keys_[pixel] = place.key;
    centred_ |= bit;
    at = static_cast<std::uint16_t>(pixel);
    return;
  }
  if (packed_ == 64) flush(context);
  constexpr float kPx = 1.0F / kSubpixels;
  const int e = packed_++;
  packed_keys_[e] = place.key;
  packed_points_.dx[e] = static_cast<float>(pixel % kBlockSize - e % kBlockSize) +
                         static_cast<float>(place.at.x) * kPx;
  packed_points_.dy[e] = static_cast<float>(pixel / kBlockSize - e / kBlockSize) +
                         static_cast<float>(place.at.y) * kPx;
  at = static_cast<std::uint16_t>((groups_ + 1) * 64 + e);
}

void SampledColors::flush(const BinContext& context) {
  if (packed_ == 0) return;
  const std::uint64_t mask = packed_ == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << packed_) - 1;
  shade(context, packed_keys_, mask, &packed_points_, colors_[++groups_]);
  packed_ = 0;
}

void SampledColors::shade(const BinContext& context, const std::uint64_t* keys, std::uint64_t mask,
                          const ShadingPoints* points, BlockColors& colors) {
  VisibleBlock block{keys, mask, bx_ * kBlockSize, by_ * kBlockSize, context.shader_scratch};
  block.points = points;
  if (context.request->shading.shade(*context.frame, block, context.request->isa, colors))
    std::fill_n(colors.a, 64, 1.0F);
}

}  // namespace rastrum::raster
