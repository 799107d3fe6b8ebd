// SPDX-License-Identifier: BSD-3-Clause
// The table of benchmarks and its lookup.
#include <bench/bench.hpp>

#include <algorithm>
#include <array>
#include <cstdio>

#include "registry.hpp"

namespace rastrum::bench {
namespace {

constexpr std::array kBenchmarks = {
    Benchmark{"machine", "what this machine can do: memory bandwidth, arithmetic", run_machine},
    Benchmark{"peers", "frames beside OpenGL (Mesa llvmpipe) and Embree, interleaved", run_peers},
    Benchmark{"materials", "the textured shader `material` beside the same formula on llvmpipe",
              run_materials},
    Benchmark{"peers-check", "coverage, fragment counts and phong compared with OpenGL",
              run_peers_check},
    Benchmark{"paper1-table1", "immediate Pineda by hardware", run_paper1_table1},
    Benchmark{"paper1-table2", "time and memory by share of the triangles", run_paper1_table2},
    Benchmark{"paper1-table3", "time by size of the picture", run_paper1_table3},
    Benchmark{"paper1-table4", "bins and fine tiles of pineda", run_paper1_table4},
    Benchmark{"paper1-table5", "the threshold of small triangles", run_paper1_table5},
    Benchmark{"paper1-table6", "bins and fine tiles of tiled", run_paper1_table6},
    Benchmark{"paper2", "large triangles: both schedules of binned, and the load", run_paper2},
    Benchmark{"paper3", "voxel space beside node; time over d, m and l; shadows", run_paper3},
    Benchmark{"terrain", "a map with shadows by cell, between cells, by pyramid", run_terrain},
    Benchmark{"paper5-table1", "frames a second by data set; GPU over CPU", run_paper5_table1},
    Benchmark{"paper5-table3", "time, cost and phases by threads", run_paper5_table3},
    Benchmark{"paper5-table4", "subdivisions × image scale, streamed", run_paper5_table4},
    Benchmark{"cuda", "a GPU: words, frames, paper2, paper3, transparency, paper5-table4",
              run_cuda},
    Benchmark{"cuda-frames", "a GPU: frames of meshes beside the threads'", run_cuda_frames},
    Benchmark{"auto", "auto compared with every rasterizer and visibility", run_auto},
    Benchmark{"hashed", "hashed compared with sorted as depth complexity grows", run_hashed},
    Benchmark{"hiz", "the gain of hierarchical Z as depth complexity grows", run_hiz},
    Benchmark{"transparency", "exact compared with unsorted, approximations, lists, peeling",
              run_transparency},
    Benchmark{"transparency-pictures", "one scene by every technique, and how it differs",
              run_transparency_pictures},
    Benchmark{"stages", "cycles a triangle and a pixel of each stage; shaders, instruction sets",
              run_stages},
    Benchmark{"points", "ten million points beside OpenGL's (Mesa llvmpipe)", run_points},
    Benchmark{"effects", "what occlusion, eye-dome lighting, silhouettes and edges add",
              run_effects},
    Benchmark{"instances", "many instances of one mesh beside one large mesh", run_instances},
    Benchmark{"out_of_core", "a mesh larger than memory, drawn within a limit", run_out_of_core},
    Benchmark{"prepared", "prepared meshes beside unprepared ones", run_prepared},
    Benchmark{"ranks", "parts on 1 to 16 ranks, and what 16,384 would send", run_ranks},
    Benchmark{"replay", "a frame on 1 to 256 simulated workers, and what stops it", run_replay},
    Benchmark{"samples", "several samples a pixel beside one, cut triangles among them",
              run_samples},
    Benchmark{"spheres", "a million exact spheres", run_spheres},
    Benchmark{"tubes", "a hundred thousand segments of tubes", run_tubes},
    Benchmark{"words", "expand_masked, sort_by_key, reduce_by_index beside others", run_words},
};

void print_usage(std::FILE* out) {
  std::fputs(
      "usage: rastrum bench NAME [options]; `rastrum bench NAME --help` lists the options\n\n",
      out);
  for (const Benchmark& b : kBenchmarks)
    std::fprintf(out, "  %-21.*s %.*s\n", static_cast<int>(b.name.size()), b.name.data(),
                 static_cast<int>(b.description.size()), b.description.data());
}

}  // namespace

std::span<const Benchmark> benchmarks() {
  return kBenchmarks;
}

int run(std::span<const std::string_view> args) {
  if (args.empty() || args[0] == "--help" || args[0] == "-h") {
    print_usage(stdout);
    return 0;
  }
  const auto found = std::ranges::find(kBenchmarks, args[0], &Benchmark::name);
  if (found == kBenchmarks.end()) {
    std::fprintf(stderr, "rastrum bench: there is no benchmark \"%.*s\"\n",
                 static_cast<int>(args[0].size()), args[0].data());
    print_usage(stderr);
    return 2;
  }
  return found->run(args.subspan(1));
}

}  // namespace rastrum::bench
