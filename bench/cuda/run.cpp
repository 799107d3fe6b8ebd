// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench cuda`: the data-parallel words on a CUDA device beside the threads', then the
// papers' tables with the device's figures.
#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/tables/document.hpp>
#include <bench/tables/options.hpp>
#include <rastrum/parallel/words.hpp>

#include "device.hpp"
#include "rates.hpp"

namespace rastrum::bench {
namespace {

using parallel::Threads;

constexpr std::size_t kElements = std::size_t{1} << 25, kBins = std::size_t{1} << 20;

WordInput make_input(std::size_t n, std::size_t bins) {
  std::mt19937_64 random(7);
  WordInput in;
  in.bins = bins;
  for (std::vector<std::uint32_t>* v : {&in.keys, &in.values, &in.index}) v->resize(n);
  in.words.resize(n);
  // Few enough owners that expand writes about n.
  in.counts.resize(n / 8);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t r = random();
    in.keys[i] = static_cast<std::uint32_t>(r);
    in.index[i] = static_cast<std::uint32_t>((r >> 32) % bins);
    in.words[i] = random();
  }
  std::iota(in.values.begin(), in.values.end(), 0U);
  for (std::uint32_t& c : in.counts) c = static_cast<std::uint32_t>(random() % 17);
  return in;
}

/// The threads' words, with the interface of DeviceWords.
class HostWords {
 public:
  HostWords(const WordInput& in, int threads)
      : in_(in),
        exec_(threads),
        copies_(in.words.size()),
        dest_(in.bins),
        sums_(in.counts.size()) {}

  void run(Word word) {
    switch (word) {
      case Word::copy:
        parallel::transform(exec_, in_.words, copies_, [](std::uint64_t x) { return x; });
        break;
      case Word::exclusive_scan:
        static_cast<void>(parallel::exclusive_scan(exec_, in_.counts, sums_, std::uint32_t{0}));
        break;
      case Word::sort_by_key:
        keys_ = in_.keys;
        values_ = in_.values;
        parallel::sort_by_key(exec_, keys_, values_);
        break;
      case Word::reduce_by_index:
        std::ranges::fill(dest_, 0);
        parallel::reduce_by_index(exec_, dest_, in_.index, in_.words, parallel::Maximum{});
        break;
      case Word::expand:
        owners_ = parallel::expand(
            exec_, parallel::counting(in_.counts.size()),
            [&](std::size_t i) { return std::size_t{in_.counts[i]}; },
            [](std::size_t i, std::size_t) { return static_cast<std::uint32_t>(i); });
        break;
    }
  }
  [[nodiscard]] std::vector<std::uint64_t> result(Word word) const {
    switch (word) {
      case Word::copy:
        return copies_;
      case Word::exclusive_scan:
        return {sums_.begin(), sums_.end()};
      case Word::sort_by_key: {
        std::vector<std::uint64_t> pairs(keys_.size());
        for (std::size_t i = 0; i < pairs.size(); ++i)
          pairs[i] = std::uint64_t{keys_[i]} << 32 | values_[i];
        return pairs;
      }
      case Word::reduce_by_index:
        return dest_;
      case Word::expand:
        return {owners_.begin(), owners_.end()};
    }
    return {};
  }

 private:
  const WordInput& in_;
  Threads exec_;
  std::vector<std::uint64_t> copies_, dest_;
  std::vector<std::uint32_t> sums_, keys_, values_;
  parallel::Buffer<std::uint32_t> owners_;
};

/// A word, and the bytes that it must read and write.
struct WordRow {
  Word word;
  const char* name;
  std::size_t (*items)(const WordInput& in);
  double (*bytes)(const WordInput& in, double written);
};
std::size_t all(const WordInput& in) {
  return in.words.size();
}
std::size_t owners(const WordInput& in) {
  return in.counts.size();
}
constexpr std::array<WordRow, 5> kWordRows{
    {{Word::copy, "copy (64-bit)", all,
      [](const WordInput& in, double) { return 16.0 * static_cast<double>(in.words.size()); }},
     {Word::exclusive_scan, "exclusive_scan (32-bit)", owners,
      [](const WordInput& in, double) { return 8.0 * static_cast<double>(in.counts.size()); }},
     {Word::sort_by_key, "sort_by_key (32-bit pairs, and a copy of them)", all,
      [](const WordInput& in, double) { return 2 * 16.0 * static_cast<double>(in.keys.size()); }},
     {Word::reduce_by_index, "reduce_by_index (maximum of 64-bit words)", all,
      [](const WordInput& in, double) {
        return 12.0 * static_cast<double>(in.words.size()) + 16.0 * static_cast<double>(in.bins);
      }},
     {Word::expand, "expand (owners, 0 to 16 times each)", owners,
      [](const WordInput& in, double written) {
        return 4.0 * (static_cast<double>(in.counts.size()) + written);
      }}}};

/// Returns false if a result differs from the threads'.
bool bench_words(const TableOptions& options, Document& document) {
  const std::size_t n = options.quick ? kElements / 1024 : kElements;
  const WordInput input = make_input(n, options.quick ? kBins / 1024 : kBins);
  const MachineLimits limits = measure_device(options);
  document.notes.push_back(device_note(options, limits));
  HostWords host(input, options.threads);
  DeviceWords device(input);
  Grid grid{"Words, " + std::to_string(n) + " elements, an eighth of that for scan and expand",
            {"word", "threads ms", "cuda ms", "threads ÷ cuda", "10⁶ elements/s", "floor ms",
             "cuda ÷ floor"},
            {}};
  bool right = true;
  for (const WordRow& row : kWordRows) {
    progress(row.name);
    host.run(row.word);
    device.run(row.word);
    const std::vector<std::uint64_t> expected = host.result(row.word);
    if (device.result() != expected) {
      right = false;
      grid.rows.push_back({row.name, "WRONG RESULT"});
      continue;
    }
    const std::array contenders{Contender{"threads", [&] { host.run(row.word); }},
                                Contender{"cuda", [&] { device.run(row.word); }}};
    const std::vector<Timing> t = measure_interleaved(contenders, options.plan());
    const double floor =
        row.bytes(input, static_cast<double>(expected.size())) / limits.copy_gbs / 1e6;
    const double ms = t[1].median_ms();
    grid.rows.push_back({row.name, significant(t[0].median_ms()), significant(ms),
                         significant(median_ratio(t[0], t[1])),
                         significant(static_cast<double>(row.items(input)) / ms / 1e3),
                         significant(floor), significant(ms / floor)});
    document.figures.push_back({{"table", "words"},
                                {"word", row.name},
                                {"items", row.items(input)},
                                {"threads", to_json(t[0])},
                                {"cuda", to_json(t[1])},
                                {"floor_ms", floor}});
  }
  document.grids.push_back(std::move(grid));
  return right;
}

}  // namespace

int run_cuda(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("cuda",
                      "Everything that is to be measured on a GPU: the words, then cuda-frames, "
                      "paper2, paper3, transparency and paper5-table4 with --device cuda.");
  options.device = Device::cuda;
  if (const auto status = options.read(parser, arguments, true)) return *status;

  Document document = options.document("cuda", "The words on a CUDA device");
  int status = bench_words(options, document) ? 0 : 1;
  publish(document, options.out);

  const std::string rounds = std::to_string(options.rounds);
  const std::string threads = std::to_string(options.threads);
  std::vector<std::string_view> shared{"--threads", threads};
  if (parser.given("--rounds")) shared.insert(shared.end(), {"--rounds", rounds});
  if (!options.out.empty()) shared.insert(shared.end(), {"--out", options.out});
  if (options.quick) shared.emplace_back("--quick");
  status = std::max(status, run_cuda_frames(shared));
  shared.insert(shared.end(), {"--device", "cuda"});
  for (const auto table : {run_paper2, run_paper3, run_transparency})
    status = std::max(status, table(shared));
  if (!options.mesh.empty()) shared.insert(shared.end(), {"--mesh", options.mesh});
  return std::max(status, run_paper5_table4(shared));
}

}  // namespace rastrum::bench
