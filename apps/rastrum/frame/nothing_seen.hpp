// SPDX-License-Identifier: BSD-3-Clause
// Why a picture is empty.
#pragma once

#include <string>

#include <rastrum/render.hpp>

namespace rastrum::cli {

/// Whether nothing but the background is visible.
[[nodiscard]] bool is_empty(const FrameStats& frame, const FrameOptions& options);

struct Emptiness {
  std::string reason;  ///< what became of the triangles
  std::string remedy;  ///< an option that would show them
};

/// Tests the triangles: behind the camera, outside of its view, culled, edge-on, too small, …
/// Requires is_empty(). Cost: O(triangles), in float64.
[[nodiscard]] Emptiness why_empty(const FrameStats& frame, const FrameOptions& options,
                                  const SceneView& scene, const Camera& camera);

}  // namespace rastrum::cli
