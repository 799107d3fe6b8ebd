// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench words`: the data-parallel words beside their alternatives. Each result is checked
// before the timing.
//
// expand_masked beside expand and filter, as in paper 1's README: segments of equal length and a
// predicate that reads one random byte. sort_by_key beside Thrust and std::sort. reduce_by_index
// beside the loop that defines it.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <bench/peers/thrust_peer.hpp>
#include <rastrum/error.hpp>
#include <rastrum/parallel/words.hpp>

#include "measure.hpp"
#include "options.hpp"
#include "registry.hpp"
#include "report.hpp"

namespace rastrum::bench {
namespace {

using parallel::Buffer;
using parallel::counting;
using parallel::Threads;

struct WordsOptions {
  int rounds = 9, threads = 2;
  std::size_t elements = 1'000'000, pairs = 10'000'000;
  std::string json;
};

/// Filter's time over expand_masked's in paper 1's README, by mask width (10⁶ segments, M2000M).
const std::map<std::size_t, double> kPaperRatio = {{8, 11.1 / 5.46},   {16, 18.9 / 9.27},
                                                   {32, 35.2 / 17.8},  {64, 67.7 / 39.6},
                                                   {128, 131.0 / 130}, {256, 1.0}};

void require_equal(bool equal, const std::string& what) {
  if (!equal) throw Error(Errc::invalid_argument, std::string(what).append(": wrong result"));
}

// --- expand_masked ------------------------------------------------------------------------------

/// Segments of one length over random bytes. An element passes if its byte is below `limit`.
struct Segments {
  const std::vector<std::uint8_t>& bytes;
  std::size_t length;
  unsigned limit;

  [[nodiscard]] std::size_t count() const { return bytes.size() / length; }
  [[nodiscard]] bool holds(std::size_t i, std::size_t j) const {
    return bytes[i * length + j] < limit;
  }
};

Buffer<std::uint32_t> filtered(Threads& exec, const Segments& s) {
  const auto all = parallel::expand(
      exec, counting(s.count()), [&](std::size_t) { return s.length; },
      [&](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(i * s.length + j); });
  return parallel::filter(exec, all, [&](std::uint32_t k) { return s.bytes[k] < s.limit; });
}

template <int kBits>
Buffer<std::uint32_t> masked(Threads& exec, const Segments& s) {
  return parallel::expand_masked<kBits>(
      exec, counting(s.count()), [&](std::size_t) { return s.length; },
      [&](std::size_t i, std::size_t j) { return s.holds(i, j); },
      [&](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(i * s.length + j); });
}

nlohmann::json bench_expand_masked(Threads& exec, const WordsOptions& options) {
  using Way = Buffer<std::uint32_t> (*)(Threads&, const Segments&);
  const std::vector<std::pair<std::string, Way>> ways = {
      {"filter", filtered}, {"8", masked<8>},     {"16", masked<16>},  {"32", masked<32>},
      {"64", masked<64>},   {"128", masked<128>}, {"256", masked<256>}};
  std::mt19937 random(1);
  std::vector<std::uint8_t> bytes(options.elements / 256 * 256);
  for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());

  std::printf(
      "\nexpand_masked, %zu elements: the time of expand and filter over that of masks of "
      "8 to 256 bits\n",
      bytes.size());
  Table table({{"length", 6},
               {"hold", 5},
               {"filter ms", 9},
               {"8"},
               {"16"},
               {"32"},
               {"64"},
               {"128"},
               {"256"},
               {"paper", 6}});
  table.print_head();
  nlohmann::json rows = nlohmann::json::array();
  for (const std::size_t length : {8U, 16U, 32U, 64U, 128U, 256U})
    for (const unsigned percent : {1U, 10U, 50U, 90U}) {
      const Segments segments{bytes, length, (percent * 256 + 50) / 100};
      const auto expected = filtered(exec, segments);
      std::vector<Contender> contenders;
      for (const auto& [name, way] : ways) {
        require_equal(way(exec, segments) == expected, "expand_masked " + name);
        contenders.push_back({name, [&, way = way] { way(exec, segments); }});
      }
      const auto timings = measure_interleaved(contenders, {options.rounds, 10});
      std::vector<std::string> cells = {std::to_string(length), std::to_string(percent) + " %",
                                        significant(timings[0].median_ms())};
      nlohmann::json row = {{"length", length}, {"percent", percent}};
      for (std::size_t w = 0; w < timings.size(); ++w) {
        row[timings[w].name] = to_json(timings[w]);
        if (w > 0) cells.push_back(significant(median_ratio(timings[0], timings[w])));
      }
      cells.push_back(significant(kPaperRatio.at(length)));
      table.print_row(cells);
      rows.push_back(row);
    }
  return rows;
}

// --- sort_by_key --------------------------------------------------------------------------------

using Column = std::vector<std::uint32_t>;

/// Times a sort, which changes its input: each run has a fresh copy, made outside of the timed
/// part.
struct Sorter {
  std::string name;
  std::function<void(Column&, Column&)> sort;
  Timing timing = {};
};

void std_stable_sort(Column& keys, Column& values) {
  std::vector<std::uint64_t> pairs(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) pairs[i] = std::uint64_t{keys[i]} << 32 | values[i];
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](std::uint64_t a, std::uint64_t b) { return a >> 32 < b >> 32; });
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i] = static_cast<std::uint32_t>(pairs[i] >> 32);
    values[i] = static_cast<std::uint32_t>(pairs[i]);
  }
}

nlohmann::json bench_sort(Threads& exec, const WordsOptions& options) {
  parallel::Serial serial;
  nlohmann::json rows = nlohmann::json::array();
  std::printf(
      "\nsort_by_key, %zu pairs of 32-bit key and value: time over that of ours; Thrust %d\n",
      options.pairs, thrust_version());
  Table table({{"bits", 4},
               {"ours ms", 8},
               {"spread", 6},
               {"ours, serial", 12},
               {"Thrust TBB", 10},
               {"Thrust serial", 13},
               {"std::stable_sort", 16}});
  table.print_head();
  for (const int bits : {32, 20}) {
    std::mt19937 random(2);
    Column keys(options.pairs), values(options.pairs);
    for (std::uint32_t& k : keys) k = static_cast<std::uint32_t>(random()) >> (32 - bits);
    std::iota(values.begin(), values.end(), 0U);
    std::vector<Sorter> sorters = {
        {"ours", [&](Column& k, Column& v) { parallel::sort_by_key(exec, k, v, bits); }},
        {"ours, serial", [&](Column& k, Column& v) { parallel::sort_by_key(serial, k, v, bits); }}};
    if (thrust_version() != 0) {
      sorters.push_back(
          {"Thrust TBB", [&](Column& k, Column& v) { thrust_sort_tbb(k, v, options.threads); }});
      sorters.push_back({"Thrust serial", [&](Column& k, Column& v) { thrust_sort_serial(k, v); }});
    }
    sorters.push_back({"std::stable_sort", std_stable_sort});

    Column expected_keys = keys, expected_values = values;
    std_stable_sort(expected_keys, expected_values);
    for (int round = -1; round < options.rounds; ++round)
      for (Sorter& s : sorters) {
        Column k = keys, v = values;
        const double ms = timed_ms([&] { s.sort(k, v); });
        if (round >= 0) s.timing.samples_ms.push_back(ms);
        if (round < 0) require_equal(k == expected_keys && v == expected_values, s.name);
      }
    nlohmann::json row = {{"bits", bits}, {"pairs", options.pairs}};
    std::vector<std::string> cells = {std::to_string(bits)};
    cells.push_back(significant(sorters[0].timing.median_ms()));
    cells.push_back(significant(sorters[0].timing.spread(), 2));
    for (const char* name : {"ours, serial", "Thrust TBB", "Thrust serial", "std::stable_sort"}) {
      const auto found = std::ranges::find(sorters, name, &Sorter::name);
      cells.push_back(found == sorters.end()
                          ? "not run"
                          : significant(median_ratio(found->timing, sorters[0].timing)));
    }
    for (const Sorter& s : sorters) row[s.name] = to_json(s.timing);
    table.print_row(cells);
    rows.push_back(row);
  }
  return rows;
}

// --- reduce_by_index ----------------------------------------------------------------------------

nlohmann::json bench_reduce_by_index(Threads& exec, const WordsOptions& options) {
  constexpr std::size_t kBins = std::size_t{1} << 20;
  const std::size_t n = options.pairs;
  std::mt19937_64 random(3);
  std::vector<std::uint32_t> index(n);
  std::vector<std::uint64_t> word(n), expected(kBins, 0), dest(kBins);
  for (std::size_t i = 0; i < n; ++i) {
    index[i] = static_cast<std::uint32_t>(random() % dest.size());
    word[i] = random();
    expected[index[i]] = std::max(expected[index[i]], word[i]);
  }
  const auto larger = [](std::uint64_t a, std::uint64_t b) { return std::max(a, b); };
  const std::vector<Contender> contenders = {
      {"atomic",
       [&] {
         std::ranges::fill(dest, 0);
         parallel::reduce_by_index(exec, dest, index, word, parallel::Maximum{});
       }},
      {"any operator",
       [&] {
         std::ranges::fill(dest, 0);
         parallel::reduce_by_index(exec, dest, index, word, larger);
       }},
      {"loop", [&] {
         std::ranges::fill(dest, 0);
         for (std::size_t i = 0; i < n; ++i) dest[index[i]] = std::max(dest[index[i]], word[i]);
       }}};
  for (const Contender& c : contenders) {
    std::ranges::fill(dest, 1);
    c.frame();
    require_equal(dest == expected, c.name);
  }
  const auto timings = measure_interleaved(contenders, {options.rounds, 30});
  std::printf("\nreduce_by_index, maximum of %zu 64-bit words in %zu bins\n", n, dest.size());
  Table table({{"way", 12, true}, {"ms"}, {"loop ÷ it", 9}});
  table.print_head();
  nlohmann::json rows = nlohmann::json::array();
  for (const Timing& t : timings) {
    table.print_row({t.name, significant(t.median_ms()), significant(median_ratio(timings[2], t))});
    rows.push_back({{"way", t.name}, {"time", to_json(t)}});
  }
  return rows;
}

}  // namespace

int run_words(std::span<const std::string_view> args) {
  WordsOptions options;
  OptionParser parser("words", "the data-parallel words beside what one would use instead");
  parser.add_option("--rounds", options.rounds, "number of rounds (default: 9)")->range(1, 1000);
  parser.add_option("--threads", options.threads, "number of threads (default: 2)")->range(1, 1024);
  parser
      .add_option("--elements", options.elements,
                  "elements that expand_masked tests (default: 1000000)")
      ->range(256, 1 << 30);
  parser
      .add_option("--pairs", options.pairs, "pairs to sort and words to reduce (default: 10000000)")
      ->range(1, 1 << 30);
  parser.add_option("--json", options.json, "write the figures to FILE")->type_name("FILE");
  if (const auto status = parser.parse(args)) return *status;

  std::printf("%s\n", machine_text().c_str());
  Threads exec(options.threads);
  nlohmann::json document = {{"benchmark", "words"}, {"machine", machine_json()}};
  try {
    document["expand_masked"] = bench_expand_masked(exec, options);
    document["sort_by_key"] = bench_sort(exec, options);
    document["reduce_by_index"] = bench_reduce_by_index(exec, options);
  } catch (const Error& e) {
    std::fprintf(stderr, "rastrum bench words: %s\n", e.what());
    return 1;
  }
  if (!options.json.empty()) write_json(options.json, document);
  return 0;
}

}  // namespace rastrum::bench
