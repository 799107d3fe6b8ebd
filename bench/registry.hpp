// SPDX-License-Identifier: BSD-3-Clause
// The benchmarks by name.
#pragma once

#include <span>
#include <string_view>

namespace rastrum::bench {

/// Parses its own options; returns an exit status.
using RunBenchmark = int(std::span<const std::string_view> options);

struct Benchmark {
  std::string_view name, description;
  RunBenchmark* run;
};

[[nodiscard]] std::span<const Benchmark> benchmarks();

// Each function is in the file of its name; a paper's tables share a file.
RunBenchmark run_machine, run_peers, run_materials, run_peers_check, run_paper1_table1,
    run_paper1_table2, run_paper1_table3, run_paper1_table4, run_paper1_table5, run_paper1_table6,
    run_paper2, run_paper3, run_paper5_table1, run_paper5_table3, run_paper5_table4, run_auto,
    run_effects, run_instances, run_out_of_core, run_prepared, run_ranks, run_replay, run_samples,
    run_hashed, run_hiz, run_transparency, run_transparency_pictures, run_cuda, run_cuda_frames,
    run_stages, run_spheres, run_points, run_terrain, run_tubes, run_words;

}  // namespace rastrum::bench
