// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/layer_oracle.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <stdexcept>

namespace rastrum::test {
namespace {

constexpr SamplePosition kOne[] = {{0, 0}};
constexpr SamplePosition kFour[] = {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}};
constexpr SamplePosition kEight[] = {{1, -3}, {-1, 3},  {5, 1}, {-3, -5},
                                     {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
constexpr SamplePosition kSixteen[] = {{1, 1},  {-1, -3}, {-3, 2}, {4, -1}, {-5, -2}, {2, 5},
                                       {5, 3},  {3, -5},  {-2, 6}, {0, -7}, {-4, -6}, {-6, 4},
                                       {-8, 0}, {7, -4},  {6, 7},  {-7, -8}};

struct Fragment {
  std::uint64_t key;
  bool opaque;
  Rgba64 color;
};

float depth_of(std::uint64_t key) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 33));
}

constexpr std::uint64_t kLow = (std::uint64_t{1} << 33) - 1;

void put_behind(Rgba64& front, const Rgba64& c) {
  front = front + c * (1 - front.a);
}

/// Sorts the fragments of one sample by key and drops those that the nearest opaque one hides.
/// Returns whether equal depths affected the order.
bool keep_visible(std::vector<Fragment>& f) {
  std::stable_sort(f.begin(), f.end(),
                   [](const Fragment& a, const Fragment& b) { return a.key > b.key; });
  const auto opaque = std::find_if(f.begin(), f.end(), [](const Fragment& x) { return x.opaque; });
  const auto end = opaque == f.end() ? opaque : opaque + 1;
  bool tied = false;
  for (auto k = f.begin(); k != end && k + 1 != f.end(); ++k)
    tied |= depth_of(k->key) == depth_of((k + 1)->key);
  f.erase(end, f.end());
  return tied;
}

/// The opaque surface stays behind; of the others the latest is in front.
void order_by_submission(std::vector<Fragment>& f) {
  std::stable_sort(f.begin(), f.end(), [](const Fragment& a, const Fragment& b) {
    if (a.opaque != b.opaque) return b.opaque;
    return (a.key & kLow) < (b.key & kLow);
  });
}

struct Box {
  std::int64_t x0, y0, x1, y1;  ///< pixels, with a margin, both ends included
};

Box box_of(const SnappedTriangle& t) {
  const auto [x0, x1] = std::minmax({t.v[0].x_fx8, t.v[1].x_fx8, t.v[2].x_fx8});
  const auto [y0, y1] = std::minmax({t.v[0].y_fx8, t.v[1].y_fx8, t.v[2].y_fx8});
  return {x0 / 256 - 2, y0 / 256 - 2, x1 / 256 + 2, y1 / 256 + 2};
}

/// One row of pixels: fragments by sample.
class Row {
 public:
  explicit Row(const LayerInput& input)
      : input_(input),
        positions_(standard_positions(input.samples)),
        fragments_(static_cast<std::size_t>(input.width) * positions_.size()) {}

  [[nodiscard]] std::vector<Fragment>& at(int x, std::size_t sample) {
    return fragments_[static_cast<std::size_t>(x) * positions_.size() + sample];
  }

  void add(const SnappedTriangle& t, int x, int y) {
    const std::int64_t cx = std::int64_t{x} * 256 + 128, cy = std::int64_t{y} * 256 + 128;
    const auto place = [&](const SamplePosition& p) {
      return ShadePoint{x, y, cx + 16 * p.x, cy + 16 * p.y};
    };
    std::uint32_t covered = 0;
    for (std::size_t s = 0; s < positions_.size(); ++s) {
      const ShadePoint p = place(positions_[s]);
      covered |= std::uint32_t{covers_sample(t, p.x_fx8, p.y_fx8)} << s;
    }
    if (covered == 0) return;
    const auto first = static_cast<std::size_t>(std::countr_zero(covered));
    const ShadePoint shaded =
        covers_sample(t, cx, cy) ? ShadePoint{x, y, cx, cy} : place(positions_[first]);
    if (input_.is_hole && input_.is_hole(t, shaded)) return;
    const bool opaque = input_.is_opaque(t.id);
    Rgba64 color = input_.color(t, shaded);
    if (opaque) color.a = 1;
    for (std::size_t s = 0; s < positions_.size(); ++s) {
      if ((covered >> s & 1) == 0) continue;
      const ShadePoint p = place(positions_[s]);
      at(x, s).push_back(
          {visibility_key(depth_at_sample(t, p.x_fx8, p.y_fx8), t.id), opaque, color});
    }
  }

  /// Writes the row's pixels and forgets its fragments.
  void resolve(int y, LayerOrder order, LayerImage& image) {
    for (int x = 0; x < input_.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(input_.width) +
                            static_cast<std::size_t>(x);
      Rgba64 sum;
      std::uint64_t nearest = 0;
      for (std::size_t s = 0; s < positions_.size(); ++s) {
        std::vector<Fragment>& f = at(x, s);
        for (const Fragment& each : f) nearest = std::max(nearest, each.key);
        if (keep_visible(f)) image.tied[i] = 1;
        if (order == LayerOrder::submission) order_by_submission(f);
        Rgba64 pixel;
        for (const Fragment& each : f) put_behind(pixel, each.color);
        put_behind(pixel, input_.background);
        sum = sum + pixel;
        const auto layers = std::ranges::count(f, false, &Fragment::opaque);
        image.layers[i] = std::max(image.layers[i], static_cast<std::uint32_t>(layers));
        f.clear();
      }
      const auto n = static_cast<double>(positions_.size());
      image.color[i] = {sum.r / n, sum.g / n, sum.b / n, sum.a / n};
      image.depth[i] = depth_of(nearest);
      image.ids[i] = nearest == 0 ? -1 : static_cast<std::int64_t>(kLow - (nearest & kLow));
    }
  }

 private:
  const LayerInput& input_;
  std::span<const SamplePosition> positions_;
  std::vector<std::vector<Fragment>> fragments_;
};

}  // namespace

std::span<const SamplePosition> standard_positions(int samples) {
  if (samples == 1) return kOne;
  if (samples == 4) return kFour;
  if (samples == 8) return kEight;
  if (samples == 16) return kSixteen;
  throw std::invalid_argument("oracle: 1, 4, 8 or 16 samples");
}

std::uint32_t LayerImage::most_layers() const {
  return layers.empty() ? 0 : *std::max_element(layers.begin(), layers.end());
}

LayerImage blend_layers(const LayerInput& input, LayerOrder order) {
  const std::size_t pixels =
      static_cast<std::size_t>(input.width) * static_cast<std::size_t>(input.height);
  LayerImage image{input.width,
                   input.height,
                   std::vector<Rgba64>(pixels),
                   std::vector<std::int64_t>(pixels),
                   std::vector<float>(pixels),
                   std::vector<std::uint32_t>(pixels),
                   std::vector<std::uint8_t>(pixels)};
  std::vector<Box> boxes;
  for (const SnappedTriangle& t : input.triangles) boxes.push_back(box_of(t));
  Row row(input);
  for (int y = 0; y < input.height; ++y) {
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      const Box& b = boxes[k];
      if (y < b.y0 || y > b.y1) continue;
      const auto first = static_cast<int>(std::max<std::int64_t>(b.x0, 0));
      const auto last = static_cast<int>(std::min<std::int64_t>(b.x1, input.width - 1));
      for (int x = first; x <= last; ++x) row.add(input.triangles[k], x, y);
    }
    row.resolve(y, order, image);
  }
  return image;
}

}  // namespace rastrum::test
