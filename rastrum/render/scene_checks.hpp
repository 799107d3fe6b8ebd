// SPDX-License-Identifier: BSD-3-Clause
// Checks of a scene before a frame of it begins.
#pragma once

#include <string>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/scene/instance_runs.hpp>

namespace rastrum {

/// Throws Error{invalid_argument} that names the instance, the array and the place in it: bad
/// faces, attributes of a wrong number or with indices out of range, a look out of range, a
/// transform that is not finite. Positions' indices are checked where they are read. Cost:
/// O(offsets + indices of attributes) per run, O(instances), shared by the threads.
void check_scene(const InstanceRuns& runs, parallel::Threads* threads);

/// Throws Error{invalid_argument} that names a quadric instance and its array: too few radii,
/// colours or normals, an index or offset out of range, falling offsets, a missing material.
/// O(indices).
void check_surfaces(const InstanceRuns& runs);

/// Why a device leaves a scene to the CPU; empty: it does not. Devices read packed float32 and
/// uint32 of triangle lists. O(instances).
[[nodiscard]] std::string why_not_on_device(const SceneView& scene);

}  // namespace rastrum
