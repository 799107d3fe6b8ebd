// SPDX-License-Identifier: BSD-3-Clause
// From the options of the camera to a camera.
#pragma once

#include <rastrum/fit.hpp>
#include <rastrum/scene.hpp>

#include "parse/camera_options.hpp"

namespace rastrum::cli {

/// The near plane of a camera of one's own is as far from the box as the fit camera's would be.
/// `picture`: its size, which the tight fit fills. Throws UsageError where the file has no such
/// camera or the parts do not fit each other. `ranks`: who has the rest of the scene; what turns is
/// not theirs.
[[nodiscard]] Camera choose_camera(const ViewOptions& options, const Scene& scene,
                                   const SceneView& view, Size picture, FitRanks* ranks = nullptr);

}  // namespace rastrum::cli
