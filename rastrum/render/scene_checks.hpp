// SPDX-License-Identifier: BSD-3-Clause
// Checks of a scene before a frame of it begins.
#pragma once

#include <string>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/scene/instance_runs.hpp>

namespace rastrum {

/// Throws Error{invalid_argument} naming the instance, the array and the place in it: faces that
/// are none, attributes of a wrong number or whose indices are out of range, a look that is out of
/// range, a transform that is not finite. The indices of positions are checked where they are read.
/// Cost: O(offsets + indices of attributes) for each run, and O(instances). The given threads share
/// the work.
void check_scene(const InstanceRuns& runs, parallel::Threads* threads);

/// Throws Error{invalid_argument} that names the instance and its array, for instances of quadrics:
/// too few radii, colours or normals, an index or offset out of range, offsets that do not rise, a
/// material that does not exist. O(indices).
void check_surfaces(const InstanceRuns& runs);

/// Why a device, which reads packed float32 and uint32 of triangle lists, leaves a scene to the
/// CPU; empty where it does not. O(instances).
[[nodiscard]] std::string why_not_on_device(const SceneView& scene);

}  // namespace rastrum
