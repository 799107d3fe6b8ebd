// The machine's limits, measured; and `rastrum bench machine`.
#include "machine.hpp"

#include <algorithm>
#include <barrier>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
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

/// Floats from the system, aligned; written once by the thread that uses them.
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

/// Runs `work` on all threads at once, several times; the seconds of the fastest round.
class Team {
 public:
  explicit Team(int threads) : threads_(threads) {}

  double best_seconds(const std::function<void(const FloatArray&, const FloatArray&)>& work) const {
    using Clock = std::chrono::steady_clock;
    std::vector<std::vector<double>> seconds(static_cast<std::size_t>(threads_));
    std::barrier sync(threads_);
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

 private:
  int threads_;
};

}  // namespace

MachineLimits measure_machine(int threads) {
  const Team team(threads);
  const double n = threads;
  const double gigabytes = n * static_cast<double>(kFloats * sizeof(float)) / 1e9;
  // Results of the loops go here, so that the loops are not optimized away.
  volatile float sink = 0;
  const auto keep = [&](float value) { sink = value; };
  MachineLimits m;
  m.threads = threads;
  m.read_gbs = gigabytes / team.best_seconds([&](const FloatArray& a, const FloatArray&) {
    keep(read_floats(a.data(), kFloats));
  });
  m.write_gbs = gigabytes / team.best_seconds([&](const FloatArray& a, const FloatArray&) {
    write_floats(a.data(), kFloats, 2);
  });
  m.stream_gbs = gigabytes / team.best_seconds([&](const FloatArray& a, const FloatArray&) {
    stream_floats(a.data(), kFloats, 2);
  });
  m.copy_gbs = 2 * gigabytes / team.best_seconds([&](const FloatArray& a, const FloatArray& b) {
    copy_floats(a.data(), b.data(), kFloats);
  });
  const double gigaoperations = n * arithmetic_operations(kSteps) / 1e9;
  m.gflops_fma = gigaoperations / team.best_seconds([&](const FloatArray&, const FloatArray&) {
    keep(fused_multiply_adds(kSteps, 0.5F));
  });
  m.gflops = gigaoperations / team.best_seconds([&](const FloatArray&, const FloatArray&) {
    keep(multiplies_and_adds(kSteps, 0.5F));
  });
  return m;
}

nlohmann::json to_json(const MachineLimits& m) {
  return {{"threads", m.threads},       {"read_gbs", m.read_gbs}, {"write_gbs", m.write_gbs},
          {"stream_gbs", m.stream_gbs}, {"copy_gbs", m.copy_gbs}, {"gflops_fma", m.gflops_fma},
          {"gflops", m.gflops}};
}

int run_machine(std::span<const std::string_view> options) {
  int threads = 2;
  std::string json;
  OptionParser parser("machine", "memory bandwidth and arithmetic, all threads at once");
  parser.add_option("--threads", threads, "threads (2)")->range(1, 1024);
  parser.add_option("--json", json, "write the figures to FILE")->type_name("FILE");
  if (const auto status = parser.parse(options)) return *status;

  const MachineLimits m = measure_machine(threads);
  std::printf("%s\n\n%d threads\n", machine_text().c_str(), m.threads);
  const auto line = [](const char* what, double value, const char* unit) {
    std::printf("  %-38s %8s %s\n", what, significant(value).c_str(), unit);
  };
  line("read", m.read_gbs, "GB/s");
  line("write, plain stores", m.write_gbs, "GB/s");
  line("write, streaming stores", m.stream_gbs, "GB/s");
  line("copy (read + written, streaming)", m.copy_gbs, "GB/s");
  line("float32, fused multiply-add", m.gflops_fma, "GFLOP/s");
  line("float32, multiply and add apart", m.gflops, "GFLOP/s");
  if (!json.empty())
    write_json(json,
               {{"benchmark", "machine"}, {"machine", machine_json()}, {"limits", to_json(m)}});
  return 0;
}

}  // namespace rastrum::bench
