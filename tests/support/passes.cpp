// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/passes.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

#include <rastrum/shapes.hpp>

#include "tests/support/frame.hpp"
#include "tests/support/scenes.hpp"

namespace rastrum::test {
namespace {

using testing::AssertionFailure;
using testing::AssertionResult;

struct Passes {
  Frame frame;
  Image<std::uint64_t> keys;
};

enum class By { load, over };

Passes draw_in_passes(Painter& renderer, const SceneView& scene, const Camera& camera,
                      std::size_t passes, By by) {
  const int w = renderer.options().width, h = renderer.options().height;
  Passes p{Frame(w, h, kCounted), Image<std::uint64_t>(w, h)};
  std::ranges::fill(p.keys.pixels(), ~std::uint64_t{0});
  Targets targets = p.frame.targets();
  targets.keys = p.keys.view();
  const InstanceView& whole = scene.instances[0];
  const MeshView& whole_mesh = *whole.mesh();
  const std::size_t triangles = whole_mesh.triangle_count();
  std::size_t first = 0;
  for (std::size_t pass = 0; pass < passes; ++pass) {
    const std::size_t last = triangles * (pass + 1) * (pass + 1) / (passes * passes);
    MeshView mesh = whole_mesh;
    mesh.indices = whole_mesh.indices.subview(first * 3, (last - first) * 3);
    for (IndexView* const corners :
         {&mesh.normals.indices, &mesh.texcoords.indices, &mesh.colors.indices})
      if (!corners->empty()) *corners = corners->subview(first * 3, (last - first) * 3);
    InstanceView part = whole;
    part.geometry = mesh;
    p.frame.stats = renderer.render({{&part, 1}, scene.materials, scene.textures}, camera, targets,
                                    {.load = pass != 0 && by == By::load,
                                     .first_id = first,
                                     .over = pass != 0 && by == By::over});
    first = last;
  }
  return p;
}

}  // namespace

AssertionResult passes_equal_one_draw(Painter& renderer, std::string_view shape) {
  const Fitted scene(indexed(shapes::from_spec(std::string(shape))));
  const Passes once = draw_in_passes(renderer, scene.view, scene.camera, 1, By::load);
  if (once.frame.stats.pixels_covered < 1000) return AssertionFailure() << "hardly anything seen";
  for (const By by : {By::load, By::over})
    for (const std::size_t passes : {std::size_t{2}, std::size_t{5}}) {
      Passes p = draw_in_passes(renderer, scene.view, scene.camera, passes, by);
      const auto failed = [&](AssertionResult why) {
        return why << ", " << shape << " in " << passes << " passes by "
                   << (by == By::load ? "load" : "over");
      };
      // In a pass over a picture, overdraw counts only that pass.
      if (by == By::over)
        std::ranges::copy(once.frame.overdraw.pixels(), p.frame.overdraw.pixels().begin());
      if (AssertionResult r = same_images(p.frame, once.frame); !r) return failed(r);
      if (!std::ranges::equal(p.keys.pixels(), once.keys.pixels()))
        return failed(AssertionFailure() << "keys differ");
    }
  return testing::AssertionSuccess();
}

}  // namespace rastrum::test
