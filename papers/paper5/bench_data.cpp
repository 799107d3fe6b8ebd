// SPDX-License-Identifier: BSD-3-Clause
#include <papers/paper5/bench_data.hpp>

#include <cmath>
#include <numbers>

#include <bench/scenes.hpp>
#include <rastrum/io.hpp>

namespace rastrum::bench {

Paper5Scene paper5_scene(const paper5::DataSet& data, int scale, const TableOptions& options) {
  if (options.quick) scale = std::max(1, scale / 8);
  Paper5Scene scene;
  scene.width = data.width * scale;
  scene.height = data.height * scale;
  scene.wanted =
      data.fragments * static_cast<std::uint64_t>(scale) * static_cast<std::uint64_t>(scale);
  const std::size_t triangles = options.triangles(data.triangles);
  if (options.mesh.empty()) {
    // A ball that fills the picture's width and height covers π/4 of it twice.
    const double a_pixel =
        static_cast<double>(data.fragments) / (static_cast<double>(data.width) * data.height);
    const int shells = static_cast<int>(std::ceil(a_pixel / (std::numbers::pi / 2)));
    scene.mesh =
        ball(triangles, static_cast<float>(data.width) / static_cast<float>(data.height), shells);
  } else {
    scene.mesh = with_triangles(flatten(io::read_scene(options.mesh)), triangles);
  }
  const FragmentMatch match =
      match_fragments(scene.mesh, scene.width, scene.height, scene.wanted, options.threads);
  scene.camera = match.camera;
  scene.fragments = match.found;
  return scene;
}

std::string paper5_note(const TableOptions& options) {
  return std::string("Meshes: ") +
         (options.mesh.empty() ? "closed, wavy balls (nested where the paper has more fragments a "
                                 "pixel than one gives)"
                               : "`" + options.mesh + "`, subdivided or decimated,") +
         " of the data set's number of triangles, seen from where they have as many fragments; one "
         "colour a triangle, as there. A frame goes from the caller's vertices to finished pixels. "
         "Ids were compared before timing.";
}

std::string describe(const paper5::DataSet& data, const Paper5Scene& scene) {
  return std::string(data.name) + ": " + std::to_string(scene.mesh.triangle_count()) +
         " triangles, " + std::to_string(scene.width) + " × " + std::to_string(scene.height) +
         ", " + std::to_string(scene.fragments) +
         " fragments (paper: " + std::to_string(scene.wanted) + ")";
}

}  // namespace rastrum::bench
