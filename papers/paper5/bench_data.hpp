// SPDX-License-Identifier: BSD-3-Clause
// Stand-ins for paper 5's data sets, with the triangles, resolution and fragments of its section
// 4.3.
#pragma once

#include <string>

#include <bench/contest.hpp>
#include <bench/stand_ins.hpp>
#include <bench/tables/options.hpp>
#include <papers/paper5/published.hpp>

namespace rastrum::bench {

struct Paper5Scene {
  Mesh mesh;
  Camera camera;
  int width = 0, height = 0;
  std::uint64_t fragments = 0;  ///< counted at this size
  std::uint64_t wanted = 0;     ///< the paper's at scale 1 times the square of the scale

  [[nodiscard]] Subject subject() const {
    return {mesh.view(), camera, width, height, &triangle_colors()};
  }
};

/// `data` at `scale` times its resolution. The camera stands where the fragments a pixel are the
/// paper's. A smoke test has fewer triangles and a smaller scale.
[[nodiscard]] Paper5Scene paper5_scene(const paper5::DataSet& data, int scale,
                                       const TableOptions& options);

/// The note on stand-ins under every table.
[[nodiscard]] std::string paper5_note(const TableOptions& options);
/// "Bunny: 112402 triangles, 1080 × 880, 1420700 fragments (paper: 1420700)".
[[nodiscard]] std::string describe(const paper5::DataSet& data, const Paper5Scene& scene);

}  // namespace rastrum::bench
