#include <rastrum/raster/resolve/sampled_colors.hpp>

#include <algorithm>
#include <bit>

#include <rastrum/raster/assemble/assemble.hpp>
#include <rastrum/raster/cover/rules.hpp>
#include <rastrum/raster/draws/hooks.hpp>

namespace rastrum::raster {
namespace {

constexpr std::uint16_t kNothing = 64 * (1 + kMaxSamples);
}  // namespace

/// Where a primitive is shaded in a pixel.
struct SampledColors::Place {
  std::uint64_t key = 0;
  SampleOffset at{};  ///< from the pixel's centre
};

/// A primitive, as it is found again: what every pixel that sees it asks, in a cache line.
struct alignas(64) SampledColors::Primitive {
  enum class Kind : std::uint8_t { triangle, clipped, point_or_line };

  std::uint64_t low = 0;  ///< of its keys; 0 where nothing is kept
  /// value(x, y) = base + a x + b y ≥ 0 is inside, x and y in n.8.
  std::int64_t base[3];
  std::int32_t a[3], b[3];
  Kind kind;
  bool has_plane;  ///< that of its number is set
};

/// Finds places. Neighbours, also those of the next block, mostly share their primitives, of which
/// some are kept.
class SampledColors::Finder {
 public:
  Finder(const BinContext& context, Primitive* kept, Piece* planes)
      : frame_(*context.frame),
        offsets_(sample_offsets(context.request->samples)),
        wants_depth_(context.request->shading.wants_depth()),
        kept_(kept),
        planes_(planes) {}

  /// Of the primitive of `key`, which some sample of the pixel sees; `all`: all of them do, and so
  /// would the centre, about which they lie.
  Place find(std::uint64_t key, int x, int y, bool all) {
    const std::uint64_t low = key & kIdMask;
    Primitive& p = kept_[low % kKept];
    if (p.low != low) begin(low, p);
    if (p.kind == Primitive::Kind::point_or_line) return {key, {}};
    if (p.kind == Primitive::Kind::clipped) return find_clipped(p, key, x, y);
    if (all) return {wants_depth_ ? key_at(p, {}, x, y) : key, {}};
    // A moved piece's edges at the centre are the piece's at the sample.
    const std::int64_t cx = std::int64_t{x} * kSubpixels + kHalfPixel;
    const std::int64_t cy = std::int64_t{y} * kSubpixels + kHalfPixel;
    std::int64_t value[3];
    for (int k = 0; k < 3; ++k) value[k] = p.base[k] + p.a[k] * cx + p.b[k] * cy;
    SampleOffset at{};
    if ((value[0] | value[1] | value[2]) < 0)
      for (const SampleOffset offset : offsets_) {
        at = offset;  // some sample sees it
        std::int64_t outside = 0;
        for (int k = 0; k < 3; ++k)
          outside |= value[k] + std::int64_t{p.a[k]} * at.x + std::int64_t{p.b[k]} * at.y;
        if (outside >= 0) break;
      }
    return {wants_depth_ ? key_at(p, at, x, y) : key, at};
  }

 private:
  const Draw& draw_of(std::uint64_t low) {
    const std::uint64_t id = kIdMask - low;
    if (draw_ == nullptr || id - draw_->first_id >= draw_->primitive_count)
      draw_ = &frame_.draw_of(id);
    return *draw_;
  }
  void fetch(const Draw& draw, std::uint64_t low, ProjectedVertex (&vertices)[3]) const {
    std::uint32_t index[3];
    draw.vertices(kIdMask - low - draw.first_id, index);
    for (int c = 0; c < 3; ++c) vertices[c] = frame_.vertex(draw, index[c]);
  }
  void begin(std::uint64_t low, Primitive& p) {
    const Draw& draw = draw_of(low);
    p.low = low;
    p.kind = Primitive::Kind::point_or_line;
    p.has_plane = false;
    if (draw.topology != Topology::triangles) return;
    ProjectedVertex vertices[3];
    fetch(draw, low, vertices);
    p.kind = Primitive::Kind::clipped;
    for (const ProjectedVertex& v : vertices)
      if (v.x_fx8 == kNeedsClip) return;
    p.kind = Primitive::Kind::triangle;
    Piece piece;
    set_corners(vertices[0], vertices[1], vertices[2],
                twice_area(vertices[0], vertices[1], vertices[2]), piece);
    for (int i = 0; i < 3; ++i) {
      const int j = i == 2 ? 0 : i + 1;
      p.a[i] = piece.y[i] - piece.y[j];
      p.b[i] = piece.x[j] - piece.x[i];
      const bool top_left = p.a[i] > 0 || (p.a[i] == 0 && p.b[i] > 0);
      p.base[i] = -(std::int64_t{p.a[i]} * piece.x[i] + std::int64_t{p.b[i]} * piece.y[i]) -
                  (top_left ? 0 : 1);
    }
  }
  std::uint64_t key_at(Primitive& p, SampleOffset at, int x, int y) {
    Piece& piece = planes_[p.low % kKept];
    if (!p.has_plane) {
      const Draw& draw = draw_of(p.low);
      ProjectedVertex v[3];
      fetch(draw, p.low, v);
      const std::int64_t area = twice_area(v[0], v[1], v[2]);
      piece.flags = 0;
      set_corners(v[0], v[1], v[2], area, piece);
      set_depth_plane(v[0], v[1], v[2], area, piece);
      add_depth_bias(piece, draw.depth_bias, draw.depth_bias_slope);
      p.has_plane = true;
    }
    Piece plane;  // moved(), of what the depth reads
    plane.x[0] = piece.x[0] - at.x;
    plane.y[0] = piece.y[0] - at.y;
    plane.z0 = piece.z0;
    plane.zx = piece.zx;
    plane.zy = piece.zy;
    return make_key(plane_depth_at(plane, x, y), p.low);
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
    const Draw& draw = draw_of(p.low);
    (void)assemble_primitive(
        frame_, draw, kIdMask - p.low - draw.first_id,
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
  Piece* planes_;    ///< theirs, of what depth reads
};

SampledColors::SampledColors()
    : kept_(std::make_unique<Primitive[]>(kKept)), planes_(std::make_unique<Piece[]>(kKept)) {
  colors_[kNothing / 64] = {};
}
SampledColors::SampledColors(SampledColors&&) noexcept = default;
SampledColors::~SampledColors() = default;

void SampledColors::begin() {
  for (std::size_t i = 0; i < kKept; ++i) kept_[i].low = 0;
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
  const bool wants_depth = context.request->shading.wants_depth();
  const bool knows = !context.clips && !wants_depth;
  const bool has_places = keys.has_places && !wants_depth;
  if (knows) centred_ = covered & ~mixed;
  const std::uint64_t alike = centred_;
  Finder finder(context, kept_.get(), planes_.get());
  std::uint16_t places[64][kMaxSamples];
  for (std::uint64_t m = covered & ~alike; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = x0 + i % kBlockSize, y = y0 + i / kBlockSize;
    std::uint16_t(&at)[kMaxSamples] = places[i];
    if ((mixed >> i & 1) == 0) {
      add(context, i, finder.find(keys.plain(keys.at(x, y, 0)), x, y, true), at[0]);
      std::fill_n(at + 1, samples - 1, at[0]);
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
      at[s] = kNothing;
      if (key == 0) continue;
      const std::uint64_t place =
          has_places ? seen_.places[i] >> (4 * s) & 15 : SampledKeys::kUnknownPlace;
      const std::uint64_t plain = keys.plain(key);
      if (place == 0 || (centred >> s & 1) != 0)
        add(context, i, {plain, {}}, at[s]);
      else if (place != SampledKeys::kUnknownPlace)
        add(context, i, {plain, keys.samples[place - 1]}, at[s]);
      else
        add(context, i, finder.find(plain, x, y, false), at[s]);
    }
  }
  flush(context);
  if (centred_ != 0) shade(context, centre_keys_, centred_, nullptr, colors_[0]);

  // Sample after sample, as layers add them up.
  const float share = 1.0F / static_cast<float>(samples);
  const auto mean = [&](const float* of_centres, float* to) {
    for (std::size_t i = 0; i < 64; ++i) to[i] = 0;
    for (std::size_t s = 0; s < samples; ++s)
      for (std::size_t i = 0; i < 64; ++i) to[i] = to[i] + of_centres[i];
    for (std::size_t i = 0; i < 64; ++i) to[i] = to[i] * share;
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
    Vec4 sum;
    for (std::size_t s = 0; s < samples; ++s) {
      const std::uint16_t at = places[i][s];
      const BlockColors& c = colors_[at / 64];
      const std::size_t k = at % 64;
      sum = sum + Vec4{c.r[k], c.g[k], c.b[k], c.a[k]};
    }
    out.set(i, sum * share);
  }
}

std::uint64_t SampledColors::test(const BinContext& context, const Piece& piece,
                                  const Block& block) {
  Finder finder(context, kept_.get(), planes_.get());
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
