// SPDX-License-Identifier: BSD-3-Clause
// Paper 5: "Rasterization with data-parallel primitives", sections 4.3 and 5. Its CPU is a Xeon
// E5-2690 v4 with 14 threads (INTEL), its GPUs A100 (NVIDIA 1 and 2) and MI250X (AMD).
#pragma once

#include <bench/tables/published.hpp>

namespace rastrum::bench::paper5 {

/// Section 4.3: triangles, resolution and fragments at scale 1.
struct DataSet {
  std::string_view name;
  std::size_t triangles;
  int width, height;
  std::size_t fragments;
};
inline constexpr DataSet kBagHolder{"Bag Holder", 12138, 134, 124, 13378};
inline constexpr DataSet kBunny{"Bunny", 112402, 108, 88, 14207};
inline constexpr DataSet kDarwin{"Darwin", 2132934, 78, 122, 22795};
inline constexpr DataSet kDragon{"Dragon", 311572, 22, 23, 1175};
inline constexpr DataSet kCat{"Cat", 533180, 164, 150, 26531};
inline constexpr DataSet kLandshark{"Landshark", 3750442, 77, 104, 30690};

/// Table 1's columns in the paper's order, and how many times faster than the better of the two CPU
/// figures our default has to be (0: no goal).
struct Goal {
  DataSet data;
  double times;
};
inline constexpr std::array<Goal, 6> kDataSets{
    {{kBagHolder, 20}, {kBunny, 20}, {kDarwin, 2.5}, {kDragon, 0}, {kCat, 10}, {kLandshark, 2.5}}};
/// The image scale of the portability tests (section 4.5.1).
inline constexpr int kScale = 10;

/// Table 1, frames a second: a line a configuration, a column a data set.
inline constexpr std::array kTable1{
    PublishedRow<6>{"Thrust OpenMP, INTEL", "", {{{8}, {7}, {5}, {57}, {4}, {3}}}},
    PublishedRow<6>{"Viskores TBB, INTEL", "", {{{11}, {10}, {6}, {56}, {6}, {4}}}},
    PublishedRow<6>{"Thrust CUDA, NVIDIA 1", "", {{{90}, {92}, {51}, {352}, {55}, {40}}}},
    PublishedRow<6>{"Viskores CUDA, NVIDIA 1", "", {{{85}, {88}, {50}, {337}, {52}, {40}}}},
    PublishedRow<6>{"Thrust CUDA, NVIDIA 2", "", {{{156}, {173}, {114}, {449}, {122}, {103}}}},
    PublishedRow<6>{"Viskores CUDA, NVIDIA 2", "", {{{135}, {153}, {126}, {376}, {105}, {112}}}},
    PublishedRow<6>{"Viskores Kokkos, NVIDIA 2", "", {{{57}, {57}, {42}, {98}, {38}, {33}}}},
    PublishedRow<6>{"Viskores Kokkos, AMD", "", {{{38}, {38}, {27}, {88}, {25}, {23}}}},
    PublishedRow<6>{"VisIt OpenGL, NVIDIA 3", "", {{{200}, {200}, {26}, {250}, {200}, {26}}}},
};
/// The first lines of table 1 are the CPU's.
inline constexpr std::size_t kCpuRows = 2;

/// Table 2: seconds on average over all of table 1, and their ratio.
struct Speedup {
  std::string_view algorithm;
  double gpu_s, cpu_s, ratio;
};
inline constexpr std::array<Speedup, 3> kTable2{{{"Rasterization", 0.016, 0.158, 9.9},
                                                 {"Raytracing", 0.042, 0.460, 10.9},
                                                 {"Volume rendering", 0.059, 0.974, 16.5}}};

/// Table 3: Landshark, seconds by threads. The paper does not give the image scale.
struct Scaling {
  int threads;
  double seconds, cost_core_s, speedup;
};
inline constexpr std::array<Scaling, 5> kTable3{{{1, 0.143, 0.143, 1.00},
                                                 {2, 0.135, 0.27, 1.059},
                                                 {4, 0.081, 0.324, 1.765},
                                                 {8, 0.05, 0.4, 2.86},
                                                 {14, 0.036, 0.507, 3.972}}};

/// Table 4: Bunny on NVIDIA 2, frames a second: a line an image scale, a column a number of
/// subdivisions. The last figure failed for memory.
inline constexpr std::array<int, 8> kScales{1, 2, 4, 8, 16, 32, 64, 128};
inline constexpr std::array kTable4{
    PublishedRow<7>{"", "1", {{{818}, {663}, {54}, {359}, {202}, {78}, {19}}}},
    PublishedRow<7>{"", "2", {{{693}, {553}, {416}, {307}, {185}, {75}, {22}}}},
    PublishedRow<7>{"", "4", {{{353}, {303}, {271}, {222}, {145}, {66}, {16}}}},
    PublishedRow<7>{"", "8", {{{209}, {196}, {150}, {131}, {98}, {52}, {19}}}},
    PublishedRow<7>{"", "16", {{{118}, {109}, {97}, {88}, {69}, {41}, {16}}}},
    PublishedRow<7>{"", "32", {{{47}, {46}, {20}, {42}, {34}, {10}, {6}}}},
    PublishedRow<7>{"", "64", {{{13}, {12}, {14}, {7}, {8}, {11}, {4}}}},
    PublishedRow<7>{"", "128", {{{3}, {4}, {4}, {3}, {3}, {2}, {}}}},
};

}  // namespace rastrum::bench::paper5
