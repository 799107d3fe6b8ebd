// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rastrum/fit.hpp>
#include <rastrum/scene.hpp>

#include "parse/camera_options.hpp"

namespace rastrum::cli {

/// With a given eye or target the near plane is as far from the box as the fit camera's would be.
/// `picture`: its size, which the tight fit fills. Throws UsageError if the file has no such camera
/// or the parts do not fit each other. `ranks` have the rest of a scene that does not turn.
[[nodiscard]] Camera choose_camera(const ViewOptions& options, const Scene& scene,
                                   const SceneView& view, Size picture, FitRanks* ranks = nullptr);

}  // namespace rastrum::cli
