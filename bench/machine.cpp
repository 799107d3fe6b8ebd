// SPDX-License-Identifier: BSD-3-Clause
// Measures the machine's limits; and `rastrum bench machine`.
#include "machine.hpp"

#include <algorithm>
#include <barrier>
#include <chrono>
#include <cstdio>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "machine_json.hpp"
#include "machine_kernels.hpp"
#include "options.hpp"
#include "registry.hpp"
#include "report.hpp"

namespace rastrum::bench {
namespace {

constexpr std::size_t kFloats = std::size_t{1} << 25;  ///< 128 MiB, four times any cache here
constexpr std::size_t kSteps = std::size_t{1} << 22;
constexpr int kRepeats = 7;
constexpr std::align_val_t kAlignment{128};

/// Aligned memory from the system. The thread that uses it writes it first.
class FloatArray {
 public:
  FloatArray() : data_(static_cast<float*>(::operator new(kFloats * sizeof(float), kAlignment))) {
    write_floats(data_, kFloats, 1);
  }
  ~FloatArray() { ::operator delete(data_, kAlignment); }
  FloatArray(const FloatArray&) = delete;
  FloatArray& operator=(const FloatArray&) = delete;
  [[nodiscard]] float* data() const { return data_; }

 private:
  float* data_;
};

/// Runs `work` on all threads at once, several times. Returns the seconds of the fastest round.
double best_seconds(int threads,
                    const std::function<void(const FloatArray&, const FloatArray&)>& work) {
  using Clock = std::chrono::steady_clock;
  std::vector<std::vector<double>> seconds(static_cast<std::size_t>(threads));
  std::barrier sync(threads);
  std::vector<std::jthread> team;
  for (auto& mine : seconds)
    team.emplace_back([&] {
      const FloatArray a, b;
      for (int i = 0; i < kRepeats; ++i) {
        sync.arrive_and_wait();
        const auto begin = Clock::now();
        work(a, b);
        sync.arrive_and_wait();
        mine.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
      }
    });
  team.clear();
  double best = seconds[0][0];
  for (int i = 0; i < kRepeats; ++i) {
    double round = 0;
    for (const auto& mine : seconds) round = std::max(round, mine[static_cast<std::size_t>(i)]);
    best = std::min(best, round);
  }
  return best;
}

struct Limit {
  const char *key, *text, *unit;
  double MachineLimits::*value;
};
constexpr Limit kLimits[] = {
    {"read_gbs", "read", "GB/s", &MachineLimits::read_gbs},
    {"write_gbs", "write, plain stores", "GB/s", &MachineLimits::write_gbs},
    {"stream_gbs", "write, streaming stores", "GB/s", &MachineLimits::stream_gbs},
    {"copy_gbs", "copy (read + written, streaming)", "GB/s", &MachineLimits::copy_gbs},
    {"gflops_fma", "float32, fused multiply-add", "GFLOP/s", &MachineLimits::gflops_fma},
    {"gflops", "float32, multiply and add apart", "GFLOP/s", &MachineLimits::gflops}};

}  // namespace

MachineLimits measure_machine(int threads) {
  // Takes the loops' results, so that they are not optimized away.
  volatile float sink = 0;
  MachineLimits m;
  m.threads = threads;
  /// 10⁹ units a second, all threads together.
  const auto rate = [&](double of_each, const auto& work) {
    return threads * of_each / 1e9 / best_seconds(threads, work);
  };
  constexpr double kBytes = kFloats * sizeof(float);
  const double operations = arithmetic_operations(kSteps);
  m.read_gbs = rate(kBytes, [&](const FloatArray& a, const FloatArray&) {
    sink = read_floats(a.data(), kFloats);
  });
  m.write_gbs = rate(
      kBytes, [](const FloatArray& a, const FloatArray&) { write_floats(a.data(), kFloats, 2); });
  m.stream_gbs = rate(
      kBytes, [](const FloatArray& a, const FloatArray&) { stream_floats(a.data(), kFloats, 2); });
  m.copy_gbs = rate(2 * kBytes, [](const FloatArray& a, const FloatArray& b) {
    copy_floats(a.data(), b.data(), kFloats);
  });
  m.gflops_fma = rate(operations, [&](const FloatArray&, const FloatArray&) {
    sink = fused_multiply_adds(kSteps, 0.5F);
  });
  m.gflops = rate(operations, [&](const FloatArray&, const FloatArray&) {
    sink = multiplies_and_adds(kSteps, 0.5F);
  });
  return m;
}

nlohmann::json to_json(const MachineLimits& m) {
  nlohmann::json j = {{"threads", m.threads}};
  for (const Limit& limit : kLimits) j[limit.key] = m.*limit.value;
  return j;
}

int run_machine(std::span<const std::string_view> options) {
  int threads = 2;
  std::string json;
  OptionParser parser("machine", "memory bandwidth and arithmetic, all threads at once");
  parser.add_option("--threads", threads, "number of threads (default: 2)")->range(1, 1024);
  parser.add_option("--json", json, "write the figures to FILE")->type_name("FILE");
  if (const auto status = parser.parse(options)) return *status;

  const MachineLimits m = measure_machine(threads);
  std::printf("%s\n\n%d threads\n", machine_text().c_str(), m.threads);
  for (const Limit& limit : kLimits)
    std::printf("  %-38s %8s %s\n", limit.text, significant(m.*limit.value).c_str(), limit.unit);
  if (!json.empty())
    write_json(json,
               {{"benchmark", "machine"}, {"machine", machine_json()}, {"limits", to_json(m)}});
  return 0;
}

}  // namespace rastrum::bench
