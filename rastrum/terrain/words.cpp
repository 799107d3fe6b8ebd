// Paper 3, chapter 4, on the data-parallel words: colour–height pairs for all samples, the
// `occlude` scan along each column, a scatter into the columns of the picture, the `fill` scan down
// them, a transposition. Work O(n · m + l · m), span O(log) beside the words' blocks.
//
// Deviations. The maps over columns with scans inside are segmented scans. What a pair hides is not
// scattered a second time, since writers of one element must differ here: a pair is written where
// its row is not that of the pair before. Columns go in batches, so that pairs take bounded memory.
#include <algorithm>

#include <rastrum/parallel/for_each.hpp>
#include <rastrum/parallel/reduce.hpp>
#include <rastrum/parallel/scatter.hpp>
#include <rastrum/parallel/segmented.hpp>
#include <rastrum/parallel/tabulate.hpp>
#include <rastrum/parallel/transform.hpp>
#include <rastrum/parallel/transpose.hpp>
#include <rastrum/terrain/methods.hpp>
#include <rastrum/terrain/words.hpp>

namespace rastrum::terrain {
namespace {

/// Pairs of a batch, 12 bytes each.
constexpr std::size_t kBatch = std::size_t{1} << 21;

/// Section 4.2: the pair of sample i of the batch, samples lying column after column.
struct MakePair {
  const Samples& samples;
  std::size_t first_column;

  Pair operator()(std::size_t i) const {
    const Setup& setup = samples.setup;
    const std::size_t column = first_column + i / setup.slices.size();
    const Slice& slice = setup.slices[i % setup.slices.size()];
    const float row = samples.row(samples.height(column, slice), slice);
    // Also without a row: NaN.
    if (!(row < static_cast<float>(setup.height))) return kNoPair;
    return {samples.color(column, slice), slice.z, row > 0 ? static_cast<std::int32_t>(row) : 0};
  }
};

template <class Exec>
std::uint64_t draw_columns(Exec& exec, const Samples& samples, std::size_t first, std::size_t m,
                           const TerrainTargets& targets) {
  using namespace parallel;
  const std::size_t n = samples.setup.slices.size();
  const auto l = static_cast<std::size_t>(samples.setup.height);
  const auto columns_of = [m](std::size_t length) {
    return Computed(m, [length](std::size_t j) { return j * length; });
  };

  auto pairs = make_buffer<Pair>(exec, n * m);
  tabulate(exec, pairs, MakePair{samples, first});
  segmented_scan<Pair>(exec, columns_of(n), pairs, pairs, Occlude{});

  const auto seen = Computed(pairs.size(), [&](std::size_t i) {
    return pairs[i].row != kNoRow && (i % n == 0 || pairs[i].row != pairs[i - 1].row);
  });
  const auto pixels = Computed(pairs.size(), [&](std::size_t i) {
    return Pixel{pairs[i].color, pairs[i].depth};
  });
  const auto places = Computed(pairs.size(), [&](std::size_t i) {
    return i / n * l + static_cast<std::size_t>(pairs[i].row);
  });
  auto screen = make_buffer<Pixel>(exec, l * m);
  tabulate(exec, screen, [](std::size_t) { return Pixel{}; });
  scatter_if(exec, pixels, places, seen, screen);
  segmented_scan<Pixel>(exec, columns_of(l), screen, screen, Fill{});

  auto frame = make_buffer<Pixel>(exec, l * m);
  transpose(exec, screen, m, l, frame);
  const Pixel sky{samples.setup.sky, std::numeric_limits<float>::infinity()};
  for_each_index(exec, l, [&](std::size_t y) {
    for (std::size_t j = 0; j < m; ++j) {
      const Pixel pixel = Fill{}(sky, frame[y * m + j]);
      const int at_x = static_cast<int>(first + j), at_y = static_cast<int>(y);
      if (!targets.color8.empty()) targets.color8(at_x, at_y) = pixel.color;
      if (!targets.depth.empty()) targets.depth(at_x, at_y) = pixel.depth;
    }
  });
  return reduce(exec, Computed(pairs.size(), [&](std::size_t i) { return std::uint64_t{seen[i]}; }),
                std::uint64_t{0});
}

template <class Exec>
Counts draw(Exec& exec, const Samples& samples, const TerrainTargets& targets) {
  const std::size_t columns = samples.setup.ux.size(), n = samples.setup.slices.size();
  const std::size_t longest = std::max(n, static_cast<std::size_t>(samples.setup.height));
  const std::size_t batch = std::clamp<std::size_t>(kBatch / longest, 1, columns);
  Counts counts{n * columns, 0};
  for (std::size_t first = 0; first < columns; first += batch)
    counts.visible += draw_columns(exec, samples, first, std::min(batch, columns - first), targets);
  return counts;
}

}  // namespace

Counts draw_words(parallel::Serial& exec, const Samples& samples, const TerrainTargets& targets) {
  return draw(exec, samples, targets);
}
Counts draw_words(parallel::Threads& exec, const Samples& samples, const TerrainTargets& targets) {
  return draw(exec, samples, targets);
}

}  // namespace rastrum::terrain
