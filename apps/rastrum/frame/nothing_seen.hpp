// SPDX-License-Identifier: BSD-3-Clause
// Why a picture is empty, for the person who waited for it.
#pragma once

#include <string>

#include <rastrum/render.hpp>

namespace rastrum::cli {

/// Whether nothing but the background can be seen.
[[nodiscard]] bool is_empty(const FrameStats& frame, const FrameOptions& options);

struct Emptiness {
  std::string reason;  ///< what became of the triangles
  std::string remedy;  ///< which option would show them
};

/// Finds out why a picture is empty: its triangles are behind the camera, outside of its view,
/// culled, seen edge-on, too small, … Requires is_empty(). Cost: O(triangles), in float64.
[[nodiscard]] Emptiness why_empty(const FrameStats& frame, const FrameOptions& options,
                                  const SceneView& scene, const Camera& camera);

}  // namespace rastrum::cli
