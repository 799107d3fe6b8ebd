// SPDX-License-Identifier: BSD-3-Clause
// Paper 1: S. Siddique, "Tile-based software rasterization in Futhark", 2026, section 4.2. Laptop
// GPU (Quadro M2000M, 4 GB) unless a line says otherwise; one depth-shaded frame of 1024 × 1024. MB
// is the peak that `futhark profile` reports.
#pragma once

#include <bench/tables/published.hpp>

namespace rastrum::bench::paper1 {

inline constexpr std::array<Model, 6> kModels{{{"Bunny", 4968},
                                               {"Monkey", 3936},
                                               {"Penger", 1144},
                                               {"Dragon", 249881},
                                               {"Lucy", 99970},
                                               {"Armadillo", 99976}}};
/// The edge of the picture, in px.
inline constexpr int kImage = 1024;

// One line a line of the paper.
// clang-format off

/// Table 1: immediate Pineda on three machines. Columns: kModels.
inline constexpr std::array kTable1{
    PublishedRow<6>{"i7-6820HQ (multicore)", "", {{{30.5}, {36.5}, {20.5}, {71.8}, {26.2}, {35.9}}}},
    PublishedRow<6>{"Vega 8 (HIP)", "", {{{10.9}, {15.7}, {9.7}, {37.9}, {16.1}, {20.8}}}},
    PublishedRow<6>{"M2000M (CUDA)", "", {{{4.6}, {6.0}, {4.3}, {13.6}, {5.9}, {6.7}}}},
};

/// Table 2: the first 25, 50 and 100 % of each model's triangles. Columns: kModels.
inline constexpr std::array kTable2{
    PublishedRow<6>{"immediate scanline", "25 %", {{{3.7, 18.9}, {3.7, 22.0}, {2.8, 17.4}, {5.6, 37.2}, {3.5, 21.2}, {3.9, 22.3}}}},
    PublishedRow<6>{"immediate scanline", "50 %", {{{4.3, 22.1}, {3.9, 26.0}, {2.8, 19.5}, {7.6, 47.1}, {4.3, 25.9}, {4.1, 27.1}}}},
    PublishedRow<6>{"immediate scanline", "100 %", {{{4.9, 24.8}, {5.1, 33.0}, {4.3, 25.7}, {11.0, 77.3}, {4.9, 34.1}, {5.8, 35.7}}}},
    PublishedRow<6>{"immediate pineda", "25 %", {{{4.2, 18.8}, {4.4, 22.0}, {3.1, 17.5}, {6.7, 33.7}, {3.9, 21.2}, {4.3, 21.3}}}},
    PublishedRow<6>{"immediate pineda", "50 %", {{{5.4, 21.8}, {4.6, 25.7}, {3.8, 19.5}, {10.0, 40.9}, {4.6, 23.9}, {5.7, 25.0}}}},
    PublishedRow<6>{"immediate pineda", "100 %", {{{6.4, 24.4}, {6.0, 32.5}, {4.4, 25.8}, {13.9, 63.7}, {5.6, 30.7}, {7.5, 32.4}}}},
    PublishedRow<6>{"tiled pineda", "25 %", {{{3.5, 9.2}, {3.8, 9.3}, {2.9, 9.0}, {10.9, 22.2}, {4.7, 13.1}, {5.6, 13.4}}}},
    PublishedRow<6>{"tiled pineda", "50 %", {{{4.1, 9.3}, {4.6, 9.3}, {3.3, 9.1}, {17.4, 28.3}, {7.8, 14.0}, {8.3, 14.1}}}},
    PublishedRow<6>{"tiled pineda", "100 %", {{{4.6, 9.4}, {6.1, 9.5}, {3.7, 9.1}, {29.3, 52.4}, {12.2, 21.2}, {13.1, 21.5}}}},
    PublishedRow<6>{"hybrid pineda", "25 %", {{{4.6, 17.7}, {4.8, 17.7}, {3.4, 17.5}, {7.4, 33.7}, {4.6, 21.2}, {4.7, 21.2}}}},
    PublishedRow<6>{"hybrid pineda", "50 %", {{{4.9, 17.8}, {5.9, 17.8}, {3.8, 17.5}, {10.3, 40.9}, {6.1, 23.9}, {5.8, 25.0}}}},
    PublishedRow<6>{"hybrid pineda", "100 %", {{{5.4, 17.9}, {6.4, 20.0}, {4.8, 17.6}, {15.5, 63.6}, {7.6, 30.6}, {8.6, 32.3}}}},
};

/// Table 3: the edge of the picture. Columns: kModels. (8192 with immediate Pineda: bins of 64².)
inline constexpr std::array kTable3{
    PublishedRow<6>{"immediate scanline", "1024", {{{3.7}, {4.9}, {3.2}, {11.0}, {5.2}, {5.8}}}},
    PublishedRow<6>{"immediate scanline", "2048", {{{10.2}, {13.8}, {9.2}, {23.1}, {11.0}, {12.5}}}},
    PublishedRow<6>{"immediate scanline", "4096", {{{34.3}, {47.0}, {31.0}, {66.7}, {30.0}, {35.3}}}},
    PublishedRow<6>{"immediate scanline", "8192", {{{126.0}, {174.1}, {114.2}, {219.3}, {97.5}, {112.7}}}},
    PublishedRow<6>{"immediate pineda", "1024", {{{4.5}, {5.7}, {4.1}, {13.2}, {5.8}, {6.8}}}},
    PublishedRow<6>{"immediate pineda", "2048", {{{12.0}, {17.1}, {11.5}, {29.2}, {12.2}, {14.0}}}},
    PublishedRow<6>{"immediate pineda", "4096", {{{41.4}, {57.2}, {39.1}, {82.8}, {32.2}, {37.4}}}},
    PublishedRow<6>{"immediate pineda", "8192", {{{156.0}, {222.8}, {147.4}, {280.9}, {107.7}, {128.8}}}},
    PublishedRow<6>{"tiled pineda", "1024", {{{4.3}, {5.4}, {3.4}, {29.4}, {12.0}, {12.8}}}},
    PublishedRow<6>{"tiled pineda", "2048", {{{10.3}, {13.5}, {8.0}, {43.7}, {17.2}, {19.1}}}},
    PublishedRow<6>{"tiled pineda", "4096", {{{32.3}, {44.1}, {25.6}, {88.6}, {34.2}, {40.3}}}},
    PublishedRow<6>{"tiled pineda", "8192", {{{114.1}, {158.9}, {94.1}, {237.3}, {94.0}, {113.1}}}},
    PublishedRow<6>{"hybrid pineda", "1024", {{{5.1}, {6.0}, {3.9}, {15.3}, {7.2}, {7.9}}}},
    PublishedRow<6>{"hybrid pineda", "2048", {{{11.7}, {15.7}, {10.0}, {35.2}, {13.1}, {15.5}}}},
    PublishedRow<6>{"hybrid pineda", "4096", {{{38.0}, {50.6}, {31.1}, {96.6}, {37.2}, {44.5}}}},
    PublishedRow<6>{"hybrid pineda", "8192", {{{136.0}, {183.4}, {113.2}, {267.8}, {110.8}, {130.3}}}},
};

/// The edges of fine tiles in tables 4 and 6, in px.
inline constexpr std::array<int, 3> kFineTiles{4, 8, 16};

/// Table 4: edge of a bin × edge of a fine tile, Dragon, without the small-triangle stage.
inline constexpr std::array kTable4{
    PublishedRow<3>{"immediate pineda, no small stage", "16", {{{14.4, 85.6}, {}, {}}}},
    PublishedRow<3>{"immediate pineda, no small stage", "32", {{{16.0, 91.2}, {18.3, 79.0}, {}}}},
    PublishedRow<3>{"immediate pineda, no small stage", "64", {{{21.4, 98.4}, {20.7, 85.4}, {37.7, 84.9}}}},
    PublishedRow<3>{"immediate pineda, no small stage", "128", {{{}, {26.9, 92.2}, {45.6, 93.4}}}},
};

/// Table 5: the bounding box up to which a triangle is small, in px. Columns: kModels.
inline constexpr std::array kTable5{
    PublishedRow<6>{"immediate pineda", "32", {{{6.2}, {8.2}, {5.4}, {26.0}, {6.5}, {8.6}}}},
    PublishedRow<6>{"immediate pineda", "64", {{{6.3}, {8.3}, {5.4}, {15.1}, {5.7}, {6.7}}}},
    PublishedRow<6>{"immediate pineda", "128", {{{6.3}, {8.2}, {5.4}, {13.1}, {5.7}, {6.7}}}},
    PublishedRow<6>{"immediate pineda", "256", {{{6.0}, {8.3}, {5.5}, {13.6}, {5.5}, {6.4}}}},
};

/// Table 6: edge of a bin × edge of a fine tile, Dragon, tiled.
inline constexpr std::array kTable6{
    PublishedRow<3>{"tiled pineda", "16", {{{32.2, 59.22}, {}, {}}}},
    PublishedRow<3>{"tiled pineda", "32", {{{37.4, 63.3}, {29.4, 52.4}, {}}}},
    PublishedRow<3>{"tiled pineda", "64", {{{45.3, 68.8}, {35.0, 57.2}, {55.2, 49.8}}}},
    PublishedRow<3>{"tiled pineda", "128", {{{}, {43.8, 61.1}, {67.3, 54.6}}}},
};

// clang-format on

}  // namespace rastrum::bench::paper1
