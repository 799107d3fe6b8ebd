// The benchmarks by name: a static table, one row a benchmark.
#pragma once

#include <span>
#include <string_view>

namespace rastrum::bench {

struct Benchmark {
  std::string_view name, description;
  /// Parses its own options; returns an exit status.
  int (*run)(std::span<const std::string_view> options);
};

[[nodiscard]] std::span<const Benchmark> benchmarks();

// The rows' functions, each in the file of its name (the tables of a paper share one).
int run_machine(std::span<const std::string_view> options);
int run_peers(std::span<const std::string_view> options);
int run_materials(std::span<const std::string_view> options);
int run_peers_check(std::span<const std::string_view> options);
int run_paper1_table1(std::span<const std::string_view> options);
int run_paper1_table2(std::span<const std::string_view> options);
int run_paper1_table3(std::span<const std::string_view> options);
int run_paper1_table4(std::span<const std::string_view> options);
int run_paper1_table5(std::span<const std::string_view> options);
int run_paper1_table6(std::span<const std::string_view> options);
int run_paper2(std::span<const std::string_view> options);
int run_paper3(std::span<const std::string_view> options);
int run_paper5_table1(std::span<const std::string_view> options);
int run_paper5_table3(std::span<const std::string_view> options);
int run_paper5_table4(std::span<const std::string_view> options);
int run_auto(std::span<const std::string_view> options);
int run_effects(std::span<const std::string_view> options);
int run_instances(std::span<const std::string_view> options);
int run_out_of_core(std::span<const std::string_view> options);
int run_prepared(std::span<const std::string_view> options);
int run_ranks(std::span<const std::string_view> options);
int run_replay(std::span<const std::string_view> options);
int run_samples(std::span<const std::string_view> options);
int run_hashed(std::span<const std::string_view> options);
int run_hiz(std::span<const std::string_view> options);
int run_transparency(std::span<const std::string_view> options);
int run_transparency_pictures(std::span<const std::string_view> options);
int run_cuda(std::span<const std::string_view> options);
int run_cuda_frames(std::span<const std::string_view> options);
int run_stages(std::span<const std::string_view> options);
int run_spheres(std::span<const std::string_view> options);
int run_points(std::span<const std::string_view> options);
int run_terrain(std::span<const std::string_view> options);
int run_tubes(std::span<const std::string_view> options);
int run_words(std::span<const std::string_view> options);

}  // namespace rastrum::bench
