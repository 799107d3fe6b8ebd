// SPDX-License-Identifier: BSD-3-Clause
// The surface that a pixel's key names.
#pragma once

#include <cstdint>

#include <rastrum/pick.hpp>
#include <rastrum/render.hpp>

namespace rastrum {

/// `key`: not empty, of a primitive of the scene. Throws as barycentrics().
[[nodiscard]] Pick surface_of_key(const SceneView& scene, const Camera& camera,
                                  const FrameOptions& frame, std::uint64_t key, int x, int y);

}  // namespace rastrum
