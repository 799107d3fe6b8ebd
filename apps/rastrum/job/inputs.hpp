// SPDX-License-Identifier: BSD-3-Clause
// INPUT…: files and builtin shapes, as one scene in command order.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <rastrum/image.hpp>
#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene.hpp>

#include "parse/input_spec.hpp"

namespace rastrum::cli {

class Progress;
class Timeline;

/// Points and segments of lines have ids like triangles.
struct InputPart {
  std::string name;  ///< as given
  std::uint64_t first_id = 0, triangles = 0;
};

struct Inputs {
  Scene scene;
  std::vector<InputPart> parts;  ///< in command order; their ids follow each other
  bool has_materials = false;    ///< of files, not by a given colour
};

/// Replaces `auto` by `material` for materials of a file, else by `phong`. The library would take a
/// given colour for a material.
[[nodiscard]] inline Shader shader_of(Shader asked, bool has_materials) {
  if (asked != Shader::automatic) return asked;
  return has_materials ? Shader::material : Shader::phong;
}

/// The scene of an INPUT (input_spec.hpp), placed and painted; `-` is standard input. Throws
/// UsageError for an unknown builtin, Error for a file that cannot be read.
[[nodiscard]] Scene load_input(const std::string& input, const InputReading& reading = {});

/// Places and paints the scene of one INPUT, and makes its normals.
void finish_input(Scene& scene, const std::string& input, const NormalOptions& normals);

/// Appends all inputs in order, with their normals. Each is an event of `timeline`.
[[nodiscard]] Inputs load_inputs(const std::vector<std::string>& inputs,
                                 const NormalOptions& normals, Timeline& timeline,
                                 Progress& progress, const InputReading& reading = {});

void set_sizes(Scene& scene, const PixelSizes& sizes);

/// The most that one input has.
[[nodiscard]] std::size_t animation_count(const Scene& scene);
/// rastrum::pose; makes missing normals again. Requires that the animation exists.
void pose_inputs(Inputs& inputs, const NormalOptions& normals, double seconds,
                 std::size_t animation);

/// The input's number at each pixel, −1 where `ids` is −1.
[[nodiscard]] Image<std::int32_t> inputs_of_ids(ImageView<const std::int64_t> ids,
                                                std::span<const InputPart> parts);

}  // namespace rastrum::cli
