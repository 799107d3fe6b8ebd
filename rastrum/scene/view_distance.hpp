// From reversed depth back to world units.
#pragma once

#include <rastrum/scene/camera.hpp>

namespace rastrum {

/// How far from the camera, along its view axis and in world units, a pixel of reversed depth
/// `depth` lies (Targets::depth), by the camera's planes n and f: n f / (d (f − n) + n), n / d
/// where f is infinite, f − d (f − n) for an orthographic camera. Infinity for 0: nothing is there,
/// or it lies at the far plane or beyond. In float64. Requires a camera without a matrix of its
/// own.
[[nodiscard]] double view_distance(const Camera& camera, float depth);

}  // namespace rastrum
