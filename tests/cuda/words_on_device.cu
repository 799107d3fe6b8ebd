// SPDX-License-Identifier: BSD-3-Clause
// Runs every word once on the device and on Serial, with the same functors. So nvcc instantiates
// each, which is all that can be tested without a GPU; tests/parallel tests all cases on the CPU.
// Types are few, because each costs nvcc seconds.
#include "words_on_device.hpp"

#include <cstdint>
#include <span>

#include <rastrum/parallel/cuda/words.cuh>

namespace rastrum::parallel::test {
namespace {

using U = std::uint64_t;

struct Noise {
  U limit;
  RASTRUM_HD U operator()(std::size_t i) const {
    U x = (i + 1) * 0x9E3779B97F4A7C15U;
    x ^= x >> 29;
    return x * 0xBF58476D1CE4E5B9U % limit;
  }
};
struct Twice {
  RASTRUM_HD U operator()(U x) const { return 2 * x + 1; }
};
struct Sum {
  RASTRUM_HD U operator()(U a, U b) const { return a + b; }
};
struct IsOdd {
  RASTRUM_HD bool operator()(U x) const { return x % 2 == 1; }
};
struct Self {
  RASTRUM_HD U operator()(U x) const { return x; }
};
struct Add {
  std::span<U> to;
  RASTRUM_HD void operator()(U& x) const { x += to.size(); }
};
struct PairOf {
  RASTRUM_HD U operator()(U x, std::size_t j) const { return x << 32 | j; }
};
struct ThirdHolds {
  RASTRUM_HD bool operator()(U x, std::size_t j) const { return (x + j) % 3 == 0; }
};
struct WriteResult {
  std::span<U> out;
  std::size_t per_chunk;
  RASTRUM_HD void operator()(std::size_t chunk, U x, std::size_t j) const {
    // One thread per chunk: results are counted in the chunk's own place.
    U& count = out[chunk * (per_chunk + 1)];
    out[chunk * (per_chunk + 1) + 1 + count++] = x << 32 | j;
  }
};
struct SharedSum {
  U value[64];
};
/// Sums of 64 values by a tree: members read what others wrote.
struct TreeSum {
  std::span<const U> in;
  std::span<U> out;
  template <class Team>
  RASTRUM_HD void operator()(std::size_t i, SharedSum& shared, const Team& team) const {
    for (std::size_t k = team.rank(); k < 64; k += team.size()) shared.value[k] = in[64 * i + k];
    team.sync();
    for (std::size_t width = 32; width > 0; width /= 2) {
      for (std::size_t k = team.rank(); k < width; k += team.size())
        shared.value[k] += shared.value[k + width];
      team.sync();
    }
    if (team.rank() == 0) out[i] = shared.value[0];
  }
};
constexpr std::size_t kMany = 20011;

struct Backwards {
  RASTRUM_HD U operator()(std::size_t i) const { return kMany - 1 - i; }
};
struct IsOddIndex {
  RASTRUM_HD bool operator()(std::size_t i) const { return i % 2 == 1; }
};

/// A word's output on a backend. All backends get the same input.
struct Result {
  std::string word;
  std::vector<U> values;
};

template <class Exec>
class Run {
 public:
  [[nodiscard]] std::vector<Result> operator()() {
    elementwise();
    folds();
    selections();
    keys();
    expansions();
    histograms();
    exec_.wait_for_all();
    return std::move(results_);
  }

 private:
  template <class R>
  void keep(const char* word, const R& range) {
    const auto values = exec_.host(range);
    std::vector<U> as_u(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) as_u[i] = static_cast<U>(values[i]);
    results_.push_back({word, std::move(as_u)});
  }
  [[nodiscard]] auto numbers(U limit, std::size_t n = kMany) {
    auto out = make_buffer<U>(exec(), n);
    tabulate(exec(), out, Noise{limit});
    return out;
  }
  [[nodiscard]] auto zeros(std::size_t n) {
    auto out = make_buffer<U>(exec(), n);
    tabulate(exec(), out, range_detail::SameValue<U>{0});
    return out;
  }
  [[nodiscard]] auto& exec() { return exec_.exec; }

  void elementwise() {
    const auto in = numbers(1000);
    auto out = zeros(kMany);
    transform(exec(), in, out, Twice{});
    keep("transform", out);
    for_each(exec(), view_of(out), Add{view_of(out)});
    keep("for_each", out);
    auto map = make_buffer<U>(exec(), kMany);
    tabulate(exec(), map, Backwards{});
    auto scattered = zeros(kMany);
    scatter(exec(), in, map, scattered);
    keep("scatter", scattered);
    scatter_if(exec(), constant(kMany, U{7}), map, Computed(kMany, IsOddIndex{}), scattered);
    keep("scatter_if", scattered);
    auto turned = zeros(100 * 200);
    transpose(exec(), view_of(in).first(100 * 200), 100, 200, turned);
    keep("transpose", turned);
  }
  void folds() {
    const auto in = numbers(1000);
    auto out = zeros(kMany);
    keep_number("reduce", reduce(exec(), in, U{5}));
    keep_number("reduce in blocks", reduce(exec(), in, U{5}, Sum{}));
    keep_number("exclusive_scan", exclusive_scan(exec(), in, out, U{3}));
    keep("exclusive_scan", out);
    keep_number("inclusive_scan in blocks", inclusive_scan(exec(), in, out, U{3}, Sum{}));
    keep("inclusive_scan in blocks", out);
    inclusive_scan(exec(), in, out, U{3});
    keep("inclusive_scan", out);
  }
  void selections() {
    const auto in = numbers(3);
    keep("filter", filter(exec(), in, IsOdd{}));
    const auto parted = partition(exec(), in, IsOdd{});
    keep("partition", parted.elements);
    keep_number("partition", parted.first_count);
  }
  void keys() {
    auto keys = numbers(200);
    auto values = make_buffer<U>(exec(), kMany);
    tabulate(exec(), values, range_detail::IndexItself<U>{});
    sort_by_key(exec(), keys, values, 5);
    keep("sort_by_key", values);
    const auto reduced = reduce_by_key(exec(), keys, values);
    keep("reduce_by_key", reduced.keys);
    keep("reduce_by_key", reduced.values);
    keep("reduce_by_key in blocks", reduce_by_key(exec(), keys, values, Sum{}).values);
    auto first = numbers(30, 1000);
    exclusive_scan(exec(), first, first, U{0});
    auto out = zeros(kMany);
    segmented_scan<U>(exec(), first, values, out);
    keep("segmented_scan", out);
    segmented_scan<U>(exec(), first, values, out, Sum{});
    keep("segmented_scan in blocks", out);
  }
  void expansions() {
    const auto in = numbers(40, 1000);
    keep("expand", expand(exec(), in, Self{}, PairOf{}));
    keep("expand_masked", expand_masked(exec(), in, Self{}, ThirdHolds{}, PairOf{}));
    keep("expand_masked of 256", expand_masked<256>(exec(), in, Self{}, ThirdHolds{}, PairOf{}));
    const auto plan = make_expansion(exec(), in, Self{}, 17);
    auto out = zeros(plan.chunks() * 18);
    expand_each(exec(), plan, in, WriteResult{view_of(out), 17});
    keep("expand_each", out);
  }
  void histograms() {
    const auto at = numbers(70);
    const auto values = numbers(~U{0});
    auto dest = zeros(64);
    reduce_by_index(exec(), dest, at, values, Maximum{});
    keep("reduce_by_index, maximum", dest);
    reduce_by_index(exec(), dest, at, values, Sum{});
    keep("reduce_by_index", dest);
  }
  void keep_number(const char* word, U number) { results_.push_back({word, {number}}); }

  Exec exec_;
  std::vector<Result> results_;
};

struct OnSerial {
  Serial exec;
  template <class R>
  [[nodiscard]] const R& host(const R& range) const {
    return range;
  }
  void wait_for_all() const {}
};
struct OnDevice {
  Cuda exec;
  template <class R>
  [[nodiscard]] auto host(const R& range) {
    return to_host(exec, range);
  }
  void wait_for_all() const { exec.wait(); }
};

bool teams_sum_up() {
  constexpr std::size_t kTeams = 300;
  Cuda exec;
  std::vector<U> values(64 * kTeams), expected(kTeams, 0);
  for (std::size_t i = 0; i < values.size(); ++i) expected[i / 64] += values[i] = Noise{1000}(i);
  const auto in = to_device(exec, values);
  auto out = make_buffer<U>(exec, kTeams);
  for_each_team<SharedSum, 64>(exec, kTeams, TreeSum{view_of(in), view_of(out)});
  return to_host(exec, out) == expected;
}

}  // namespace

std::vector<std::string> words_that_differ() {
  const std::vector<Result> expected = Run<OnSerial>()(), got = Run<OnDevice>()();
  std::vector<std::string> differing;
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (i >= got.size() || got[i].values != expected[i].values)
      differing.push_back(expected[i].word);
  if (!teams_sum_up()) differing.emplace_back("for_each_team");
  return differing;
}

}  // namespace rastrum::parallel::test
