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

/// Finds it. Neighbours mostly share their primitive.
class SampledColors::Finder {
 public:
  explicit Finder(const BinContext& context)
      : frame_(*context.frame),
        offsets_(sample_offsets(context.request->samples)),
        wants_depth_(context.request->shading.wants_depth()) {}

  /// Of the primitive of `key`, which some sample of the pixel sees.
  Place find(std::uint64_t key, int x, int y) {
    const std::uint64_t low = key & kIdMask;
    if (low != piece_.low || draw_ == nullptr) begin(low);
    // A point or line is at all samples of its pixels.
    if (draw_->topology != Topology::triangles) return {key, {}};
    if (is_clipped_) return find_clipped(key, x, y);
    // A moved piece's edges at the centre are the piece's at the sample.
    const std::int64_t cx = std::int64_t{x} * kSubpixels + kHalfPixel;
    const std::int64_t cy = std::int64_t{y} * kSubpixels + kHalfPixel;
    std::int64_t value[3];
    for (int k = 0; k < 3; ++k) value[k] = edges_[k].base + edges_[k].a * cx + edges_[k].b * cy;
    SampleOffset at{};
    if ((value[0] | value[1] | value[2]) < 0)
      for (const SampleOffset offset : offsets_) {
        at = offset;  // some sample sees it
        std::int64_t outside = 0;
        for (int k = 0; k < 3; ++k) outside |= value[k] + edges_[k].a * at.x + edges_[k].b * at.y;
        if (outside >= 0) break;
      }
    return {wants_depth_ ? key_at(at, x, y) : key, at};
  }

 private:
  /// value(x, y) = base + a x + b y ≥ 0 is inside, x and y in n.8.
  struct SubpixelEdge {
    std::int64_t base, a, b;
  };

  void begin(std::uint64_t low) {
    const std::uint64_t id = kIdMask - low;
    if (draw_ == nullptr || id - draw_->first_id >= draw_->primitive_count)
      draw_ = &frame_.draw_of(id);
    primitive_ = id - draw_->first_id;
    piece_.low = low;
    has_plane_ = false;
    if (draw_->topology != Topology::triangles) return;
    std::uint32_t index[3];
    draw_->vertices(primitive_, index);
    is_clipped_ = false;
    for (int c = 0; c < 3; ++c) {
      vertices_[c] = frame_.vertex(*draw_, index[c]);
      is_clipped_ |= vertices_[c].x_fx8 == kNeedsClip;
    }
    if (is_clipped_) return;
    piece_.flags = 0;
    area_ = twice_area(vertices_[0], vertices_[1], vertices_[2]);
    set_corners(vertices_[0], vertices_[1], vertices_[2], area_, piece_);
    for (int i = 0; i < 3; ++i) {
      const int j = i == 2 ? 0 : i + 1;
      const std::int64_t a = piece_.y[i] - piece_.y[j], b = piece_.x[j] - piece_.x[i];
      const bool top_left = a > 0 || (a == 0 && b > 0);
      edges_[i] = {-(a * piece_.x[i] + b * piece_.y[i]) - (top_left ? 0 : 1), a, b};
    }
  }
  std::uint64_t key_at(SampleOffset at, int x, int y) {
    if (!has_plane_) {
      set_depth_plane(vertices_[0], vertices_[1], vertices_[2], area_, piece_);
      add_depth_bias(piece_, draw_->depth_bias, draw_->depth_bias_slope);
      has_plane_ = true;
    }
    return make_key(plane_depth_at(moved(piece_, at), x, y), piece_.low);
  }
  /// Of one that has to be clipped: the nearest of the pieces that cover it.
  Place find_clipped(std::uint64_t key, int x, int y) {
    Place place;
    if (covers_at({}, x, y, place)) return place;
    for (const SampleOffset at : offsets_)
      if (covers_at(at, x, y, place)) return place;
    return {key, {}};  // not reached
  }
  bool covers_at(SampleOffset at, int x, int y, Place& place) {
    bool covered = false;
    (void)assemble_primitive(
        frame_, *draw_, primitive_,
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
  std::uint64_t primitive_ = 0;
  bool is_clipped_ = false, has_plane_ = false;
  ProjectedVertex vertices_[3];
  std::int64_t area_ = 0;
  SubpixelEdge edges_[3];
  Piece piece_{};  ///< at the centres
};

void SampledColors::resolve(const BinContext& context, const std::uint64_t* planes,
                            std::size_t plane, int bx, int by, std::uint64_t* nearest,
                            BlockColors& out) {
  const auto samples = static_cast<std::size_t>(context.request->samples);
  const auto [covered, mixed] =
      context.kernel->merge(planes, plane, context.request->samples, nearest);
  if (!context.request->wants_colors() || covered == 0) return;

  bx_ = bx;
  by_ = by;
  centred_ = 0;
  packed_ = groups_ = 0;
  if (!context.clips && !context.request->shading.wants_depth()) {
    // All samples lie about the centre, so a triangle that covers them covers it.
    centred_ = covered & ~mixed;
    std::copy_n(planes, 64, centre_keys_);
  }
  const std::uint64_t alike = centred_;
  Finder finder(context);
  std::uint16_t places[kMaxSamples][64];
  for (std::uint64_t m = covered & ~alike; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const int x = bx * kBlockSize + i % kBlockSize, y = by * kBlockSize + i / kBlockSize;
    const bool one = (mixed >> i & 1) == 0;
    for (std::size_t s = 0; s < samples; ++s) {
      const std::uint64_t key = planes[s * plane + static_cast<std::size_t>(i)];
      std::uint16_t& at = places[s][i];
      at = kNoPlace;
      if (key == 0) continue;
      for (std::size_t t = 0; t < s && at == kNoPlace; ++t)
        if (((planes[t * plane + static_cast<std::size_t>(i)] ^ key) & kIdMask) == 0)
          at = places[t][i];
      if (at == kNoPlace) add(context, i, finder.find(key, x, y), at);
      if (one) break;
    }
  }
  flush(context);
  if (centred_ != 0) shade(context, centre_keys_, centred_, nullptr, colors_[0]);

  // Sample after sample, as layers add them up.
  const float share = 1.0F / static_cast<float>(samples);
  const auto mean = [&](const float* of_centres, float* to) {
    float sum[64] = {};
    for (std::size_t s = 0; s < samples; ++s)
      for (std::size_t i = 0; i < 64; ++i) sum[i] += of_centres[i];
    for (std::size_t i = 0; i < 64; ++i) to[i] = sum[i] * share;
  };
  mean(colors_[0].r, out.r);
  mean(colors_[0].g, out.g);
  mean(colors_[0].b, out.b);
  mean(colors_[0].a, out.a);
  // All others, where a sample sees something else.
  for (std::uint64_t m = (mixed | ~centred_) & covered; m != 0; m &= m - 1) {
    const int i = std::countr_zero(m);
    const bool one = (mixed >> i & 1) == 0;
    Vec4 sum;
    for (std::size_t s = 0; s < samples; ++s) {
      const std::uint16_t at = places[one ? 0 : s][i];
      if (at == kNoPlace) continue;
      const BlockColors& c = colors_[at / 64];
      const std::size_t k = at % 64;
      sum = sum + Vec4{c.r[k], c.g[k], c.b[k], c.a[k]};
    }
    out.set(i, sum * share);
  }
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
