// SPDX-License-Identifier: BSD-3-Clause
// Many pictures of one scene: along a camera path, or of a full turn.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include <rastrum/scene.hpp>

#include "camera.hpp"

namespace rastrum::cli {

struct Sequence {
  struct Shot {
    SceneView scene;
    Camera camera;
  };
  std::size_t count = 0;
  std::function<Shot(std::size_t)> shot;  ///< its scene lasts until the next call
};

/// A moving scene at a moment; the view lasts until the next call.
using SceneAt = std::function<SceneView(double seconds)>;

/// Pictures at 1/`fps` along the path of `file`. `options` say whether the near plane was given,
/// `base` has what the first key leaves out. `moving`: the scene at a time of the path if it moves,
/// else `scene` counts. Both must outlive it. Throws as read_path.
[[nodiscard]] Sequence along_path(const std::filesystem::path& file, double fps,
                                  const SceneView& scene, const SceneAt& moving,
                                  const ViewOptions& options, const Camera& base);

/// `count` pictures of a full turn. The scene turns counter-clockwise as seen from above, about the
/// axis through the camera's target along its up; camera and light stay. The first picture shows
/// the scene as it is. All have one camera, planes included, so that depths can be compared.
/// `scene` must outlive it.
[[nodiscard]] Sequence on_turntable(int count, const SceneView& scene, const ViewOptions& options,
                                    Camera camera);

}  // namespace rastrum::cli
