// SPDX-License-Identifier: BSD-3-Clause
// Paper 2: L. E. Ioannis, "Software rasterization of large triangles", section 3. GTX 1070 Ti. The
// paper gives neither the image's size nor the triangles: "large" is 4,000 to 40,000 fragments,
// "very large" anything above.
#pragma once

#include <bench/tables/published.hpp>

namespace rastrum::bench::paper2 {

/// Columns: fewer than 10 large triangles, more than 30, very large ones.
inline constexpr std::array<std::string_view, 3> kScenes{"large, < 10", "large, > 30",
                                                         "very large"};
inline constexpr std::array kTable{
    PublishedRow<3>{"persistent", "", {{{0.991}, {1.521}, {2.126}}}},
    PublishedRow<3>{"two-stage: store bins", "", {{{0.22}, {0.22}, {0.22}}}},
    PublishedRow<3>{"two-stage: rasterize bins", "", {{{0.746}, {1.041}, {1.357}}}},
    PublishedRow<3>{"two-stage: both", "", {{{0.966}, {1.26}, {1.577}}}},
};
/// The least and the most fragments of a large triangle.
inline constexpr int kLargeFragments = 4000, kVeryLargeFragments = 40000;

}  // namespace rastrum::bench::paper2
