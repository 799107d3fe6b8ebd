// Generated scenes with all that can have a colour: every built-in shader, normals, colours and
// texture coordinates of any kind, materials, textures, layers, samples. Reproducible from a seed,
// by every compiler: numbers are drawn one a statement.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <rastrum/render.hpp>

namespace rastrum::test {

struct ShadedScene {
  std::string kind;
  Scene scene;
  Camera camera;
  FrameOptions frame;

  /// While the scene stays as it is.
  [[nodiscard]] SceneView view() const {
    if (!binding) binding.emplace(scene);
    return binding->view();
  }
  mutable std::optional<SceneBinding> binding{};
};

/// At most 200 triangles, or 4,000 of layers. The picture's size is the seed's, 8 to 64 pixels.
[[nodiscard]] ShadedScene generate_shaded(std::uint64_t seed);

}  // namespace rastrum::test
