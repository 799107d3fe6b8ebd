// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/resolve/sampled_colors.hpp>

#include <algorithm>
#include <bit>

#include <rastrum/raster/draws/hooks.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/setup/assemble.hpp>
#include <rastrum/raster/shade/shader.hpp>

namespace rastrum::raster {
namespace {

constexpr std::uint16_t kUncovered = 64 * (1 + kMaxSamples);
}  // namespace

/// The edges of a triangle's piece: base + a x + b y ≥ 0 is inside, in n.8.
struct SampledColors::ExactEdges {
  std::int64_t base[3];
  std::int32_t a[3], b[3];

  void set(const Piece& piece) {
    for (int i = 0; i < 3; ++i) {
      const int j = i == 2 ? 0 : i + 1;
      a[i] = piece.y[i] - piece.y[j];
      b[i] = piece.x[j] - piece.x[i];
      base[i] = edge_value<std::int64_t>(a[i], b[i], -piece.x[i], -piece.y[i]);
    }
  }
  /// Whether the sample at `at` in pixel (x, y) is inside. This equals what the moved piece covers
  /// at the centre.
  [[nodiscard]] bool covers(int x, int y, SampleOffset at) const {
    const std::int64_t px = std::int64_t{x} * kSubpixels + kHalfPixel + at.x;
    const std::int64_t py = std::int64_t{y} * kSubpixels + kHalfPixel + at.y;
    std::int64_t outside = 0;
    for (int k = 0; k < 3; ++k) outside |= base[k] + a[k] * px + b[k] * py;
    return outside >= 0;
  }
};

namespace {

std::uint64_t key_of(const Piece& piece, SampleOffset at, int x, int y) {
  return make_key(plane_depth_at(moved(piece, at), x, y), piece.low);
}

}  // namespace

/// A primitive found again from its vertices: in one cache line, all that its pixels read.
struct alignas(64) SampledColors::Primitive {
  enum class Kind : std::uint8_t { triangle, clipped, point_or_line };

  std::uint64_t low = 0;  ///< its keys' low part; 0: none is kept
  ExactEdges edges;
  Kind kind;
  bool has_plane;  ///< its plane in planes_ is set
};

/// The pieces of a clipped triangle, not moved.
struct SampledColors::Clipped {
  std::uint64_t low = 0;  ///< as in Primitive
  int count;
  ExactEdges edges[kMaxPieces];
  Piece pieces[kMaxPieces];
};

/// Finds places in pixels, from their centres, and depths there. Neighbours, even in the next
/// block, mostly share primitives, so some are kept.
class SampledColors::Finder {
 public:
  Finder(const BinContext& context, const SampledColors& colors)
      : context_(context),
        frame_(*context.frame),
        offsets_(sample_offsets(context.request->samples)),
        kept_(colors.kept_.get()),
        planes_(colors.planes_.get()),
        clipped_(colors.clipped_.get()) {}

  /// Where in the pixel primitive `low`, which some sample sees, is shaded. `all`: all samples see
  /// it, and so would the centre between them.
  SampleOffset find(std::uint64_t low, int x, int y, bool all) {
    const Primitive& p = primitive(low);
    if (p.kind == Primitive::Kind::point_or_line) return {};
    if (p.kind == Primitive::Kind::clipped) {
      const Clipped& c = clipped(low);
      return first_covered([&](SampleOffset at) {
        return std::any_of(c.edges, c.edges + c.count,
                           [&](const ExactEdges& edges) { return edges.covers(x, y, at); });
      });
    }
    if (all) return {};
    return first_covered([&](SampleOffset at) { return p.edges.covers(x, y, at); });
  }
  /// `key` with the depth at the place `at` in a pixel, which the primitive covers.
  std::uint64_t key_at(std::uint64_t key, int x, int y, SampleOffset at) {
    const std::uint64_t low = key & kIdMask;
    Primitive& p = primitive(low);
    if (p.kind == Primitive::Kind::point_or_line) return key;
    if (p.kind == Primitive::Kind::triangle) return key_of(plane(p), at, x, y);
    const Clipped& c = clipped(low);
    std::uint64_t nearest = 0;
    for (int i = 0; i < c.count; ++i)
      if (c.edges[i].covers(x, y, at)) nearest = std::max(nearest, key_of(c.pieces[i], at, x, y));
    return nearest == 0 ? key : nearest;
  }
  /// In the pixels `mask` of block (bx, by) all samples see the primitive of the key. Returns the
  /// pixels whose centre it covers. With `depths`, their keys get the depth there.
  std::uint64_t centre(int bx, int by, std::uint64_t mask, bool depths, std::uint64_t* keys) {
    std::uint64_t covered = 0;
    Block block{0, static_cast<std::uint16_t>(bx), static_cast<std::uint16_t>(by), 0};
    while (mask != 0) {
      const std::uint64_t low = keys[std::countr_zero(mask)] & kIdMask;
      std::uint64_t run = 0;
      for (; mask != 0 && (keys[std::countr_zero(mask)] & kIdMask) == low; mask &= mask - 1)
        run |= mask & -mask;
      Primitive& p = primitive(low);
      if (p.kind == Primitive::Kind::clipped) {
        const Clipped& c = clipped(low);
        std::uint64_t by_pieces = 0;
        for (int i = 0; i < c.count; ++i) {
          block.mask = 0;
          context_.kernel->masks(&c.pieces[i], &block, 1);
          block.mask &= run;
          if (depths && block.mask != 0) set_depths(c.pieces[i], block, by_pieces, keys);
          by_pieces |= block.mask;
        }
        covered |= by_pieces;
        continue;
      }
      covered |= run;
      block.mask = run;
      if (depths && p.kind == Primitive::Kind::triangle) set_depths(plane(p), block, 0, keys);
    }
    return covered;
  }

 private:
  /// The centre or else the first sample that is covered; some is.
  template <class Covers>
  SampleOffset first_covered(const Covers& covers) const {
    if (covers(SampleOffset{})) return {};
    const auto at = std::ranges::find_if(offsets_, covers);
    return at == offsets_.end() ? offsets_.back() : *at;
  }
  /// Sets the keys of `block` from a piece, those of `raised` only to nearer ones.
  void set_depths(const Piece& piece, const Block& block, std::uint64_t raised,
                  std::uint64_t* keys) const {
    alignas(64) std::uint64_t found[64];
    context_.kernel->keys(piece, block, found);
    for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
      const int i = std::countr_zero(m);
      keys[i] = (raised >> i & 1) != 0 ? std::max(keys[i], found[i]) : found[i];
    }
  }
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
  Primitive& primitive(std::uint64_t low) {
    Primitive& p = kept_[low % kKept];
    if (p.low == low) return p;
    const Draw& draw = draw_of(low);
    p.low = low;
    p.kind = Primitive::Kind::point_or_line;
    p.has_plane = false;
    if (draw.topology != Topology::triangles) return p;
    ProjectedVertex v[3];
    fetch(draw, low, v);
    p.kind = Primitive::Kind::clipped;
    for (const ProjectedVertex& corner : v)
      if (corner.x_fx8 == kNeedsClip) return p;
    p.kind = Primitive::Kind::triangle;
    Piece piece;
    set_corners(v[0], v[1], v[2], twice_area(v[0], v[1], v[2]), piece);
    p.edges.set(piece);
    return p;
  }
  /// A triangle that is not clipped, for its depths.
  const Piece& plane(Primitive& p) {
    Piece& piece = planes_[p.low % kKept];
    if (p.has_plane) return piece;
    const Draw& draw = draw_of(p.low);
    ProjectedVertex v[3];
    fetch(draw, p.low, v);
    const std::int64_t area = twice_area(v[0], v[1], v[2]);
    piece.flags = 0;
    piece.low = p.low;
    set_corners(v[0], v[1], v[2], area, piece);
    set_depth_plane(v[0], v[1], v[2], area, piece);
    add_depth_bias(piece, draw.depth_bias, draw.depth_bias_slope);
    p.has_plane = true;
    return piece;
  }
  /// Clips a triangle once for all pixels and samples: its pieces move with its vertices.
  const Clipped& clipped(std::uint64_t low) {
    Clipped& c = clipped_[low % kKeptClipped];
    if (c.low == low) return c;
    c.low = low;
    c.count = 0;
    const Draw& draw = draw_of(low);
    (void)assemble_primitive(
        frame_, draw, kIdMask - low - draw.first_id,
        [&](const Piece& piece) {
          c.edges[c.count].set(piece);
          c.pieces[c.count++] = piece;
        },
        0, {}, reach_of(offsets_));
    return c;
  }

  const BinContext& context_;
  const FrameGeometry& frame_;
  std::span<const SampleOffset> offsets_;
  const Draw* draw_ = nullptr;
  Primitive* kept_;   ///< kKept, by the low bits of `low`
  Piece* planes_;     ///< their planes, for depth
  Clipped* clipped_;  ///< kKeptClipped, by the low bits of `low`
};

SampledColors::SampledColors()
    : kept_(std::make_unique<Primitive[]>(kKept)),
      planes_(std::make_unique<Piece[]>(kKept)),
      clipped_(std::make_unique<Clipped[]>(kKeptClipped)) {
  colors_[kUncovered / 64] = {};
}
SampledColors::SampledColors(SampledColors&&) noexcept = default;
SampledColors::~SampledColors() = default;

void SampledColors::begin() {
  for (std::size_t i = 0; i < kKept; ++i) kept_[i].low = 0;
  for (std::size_t i = 0; i < kKeptClipped; ++i) clipped_[i].low = 0;
}

void SampledColors::resolve(const BinContext& context, const SampledKeys& keys, int bx, int by,
                            std::uint64_t* nearest, BlockColors& out) {
  const std::size_t samples = keys.samples.size();
  const int x0 = bx * kBlockSize, y0 = by * kBlockSize;
  context.kernel->merge(keys, x0, y0, nearest, centre_keys_, seen_);
  const std::uint64_t covered = seen_.covered, mixed = seen_.mixed;
  if (context.plan->colors == FramePlan::Colors::none || covered == 0) return;

  bx_ = bx;
  by_ = by;
  centred_ = 0;
  packed_ = groups_ = 0;
  // A triangle that covers two opposite samples, or all, covers the centre between them, unless it
  // was clipped: then its pieces may lie around the centre.
  const bool knows = !context.clips, wants_depth = raster::wants_depth(context.request->shading);
  Finder finder(context, *this);
  std::uint64_t alike = covered & ~mixed, asked = wants_depth || !knows ? alike : 0;
  for (std::uint64_t m = !wants_depth && keys.has_places ? asked : 0; m != 0; m &= m - 1)
    if ((seen_.places[std::countr_zero(m)] & 15) != SampledKeys::kUnknownPlace) asked &= ~(m & -m);
  if (asked != 0) alike &= ~asked | finder.centre(bx, by, asked, wants_depth, centre_keys_);
  centred_ = alike;
  std::uint16_t places[64][kMaxSamples];
  for (std::uint64_t m = covered & ~alike; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = x0 + i % kBlockSize, y = y0 + i / kBlockSize;
    std::uint16_t(&at)[kMaxSamples] = places[i];
    const bool is_mixed = (mixed >> i & 1) != 0;
    const std::uint64_t first = is_mixed ? seen_.first[i] : 0;
    const std::uint64_t centred = is_mixed && knows ? seen_.centred[i] : 0;
    for (std::size_t s = 0; s < samples; ++s) {
      const std::size_t same = first >> (4 * s) & 15;
      if (same != s) {
        at[s] = at[same];
        continue;
      }
      const std::uint64_t key = keys.at(x, y, s);
      at[s] = kUncovered;
      if (key == 0) continue;
      const std::uint64_t place =
          keys.has_places ? seen_.places[i] >> (4 * s) & 15 : SampledKeys::kUnknownPlace;
      std::uint64_t plain = keys.plain(key);
      SampleOffset from_centre{};
      if (place == SampledKeys::kUnknownPlace && (centred >> s & 1) == 0)
        from_centre = finder.find(plain & kIdMask, x, y, !is_mixed);
      else if (place != SampledKeys::kUnknownPlace && place != 0)
        from_centre = keys.samples[place - 1];
      if (wants_depth) plain = finder.key_at(plain, x, y, from_centre);
      at[s] = add(context, i, plain, from_centre);
    }
  }
  flush(context);
  if (centred_ != 0) shade(context, centre_keys_, centred_, nullptr, colors_[0]);

  // Sums sample by sample, in the layers' order.
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
  // The other pixels, whose samples may see different surfaces.
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
  Finder finder(context, *this);
  constexpr float kPx = 1.0F / kSubpixels;
  ShadingPoints points;
  for (std::uint64_t m = block.mask; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const SampleOffset at = finder.find(piece.low, block.bx * kBlockSize + i % kBlockSize,
                                        block.by * kBlockSize + i / kBlockSize, false);
    points.dx[i] = static_cast<float>(at.x) * kPx;
    points.dy[i] = static_cast<float>(at.y) * kPx;
  }
  return context.request->kept(*context.frame, piece, block, &points);
}

std::uint16_t SampledColors::add(const BinContext& context, int pixel, std::uint64_t key,
                                 SampleOffset from_centre) {
  const std::uint64_t bit = std::uint64_t{1} << pixel;
  if (from_centre.x == 0 && from_centre.y == 0 && (centred_ & bit) == 0) {
    centre_keys_[pixel] = key;
    centred_ |= bit;
    return static_cast<std::uint16_t>(pixel);
  }
  if (packed_ == 64) flush(context);
  constexpr float kPx = 1.0F / kSubpixels;
  const int e = packed_++;
  packed_keys_[e] = key;
  packed_points_.dx[e] = static_cast<float>(pixel % kBlockSize - e % kBlockSize) +
                         static_cast<float>(from_centre.x) * kPx;
  packed_points_.dy[e] = static_cast<float>(pixel / kBlockSize - e / kBlockSize) +
                         static_cast<float>(from_centre.y) * kPx;
  return static_cast<std::uint16_t>((groups_ + 1) * 64 + e);
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
  if (shade_block(context.request->shading, *context.frame, block, context.request->isa, colors))
    std::fill_n(colors.a, 64, 1.0F);
}

}  // namespace rastrum::raster
