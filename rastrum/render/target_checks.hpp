// SPDX-License-Identifier: BSD-3-Clause
// Checks of a frame's targets before it, and values set in them after it.
#pragma once

#include <span>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/draws/draw.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene/instance_runs.hpp>

namespace rastrum {

/// Throws Error{invalid_argument} that names a target of another size, or two that overlap.
/// `whole`: false if targets have only some rows of the frame.
void check_targets(const Targets& targets, const FrameOptions& frame, bool whole = true);

/// Throws Error{invalid_argument} where no picture can be drawn in bands of `rows` rows (0: whole).
void check_band_rows(int rows);
/// The same where a frame of `height` rows has several bands and nobody takes them.
void check_bands_taken(int rows, int height, bool taken);

/// Throws Error{invalid_argument} where a target overlaps an array that the scene is read from.
/// O(runs).
void check_apart(const Targets& targets, const InstanceRuns& runs);

/// Throws Error{invalid_argument} if a key's primitive is not before `first_id`. O(pixels), on
/// `threads` if given.
void check_loaded(ImageView<const std::uint64_t> held, std::uint64_t first_id,
                  parallel::Threads* threads);

/// Throws Error{invalid_argument} if ids do not fit into a target of 32 bits.
void check_ids(const Targets& targets, std::uint64_t first_id, std::span<const raster::Draw> draws);
void check_instance_ids(const Targets& targets, const SceneView& scene);

/// Throws Error{unsupported} for surface targets without a scene, and for linear light without the
/// shader `material`.
void check_outputs(const Targets& targets, bool has_scene, bool shades_materials);

/// Throws Error{unsupported} if the host would have to access arrays in a device's memory.
void check_in_place(const SceneView& scene, const Targets& targets, Shader shader,
                    const FrameOptions& frame);

/// Throws Error{invalid_argument} without a picture to draw into.
void check_annotated(const Targets& targets);

/// The frame with an infinite no_distance, as effects expect it.
[[nodiscard]] FrameOptions with_infinity(FrameOptions frame);
/// Replaces infinite distances in `targets` by the caller's FrameOptions::no_distance.
void set_no_distance(const Targets& targets, float no_distance);

/// Throws Error{invalid_argument} if the picture cannot be drawn over (Pass::over).
void check_over(const Targets& targets, const Pass& pass, const FrameOptions& frame);

}  // namespace rastrum
