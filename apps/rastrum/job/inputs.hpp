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

/// An input's part of the scene. Points and segments of lines have ids as triangles do.
struct InputPart {
  std::string name;  ///< as it was given
  std::uint64_t first_id = 0, triangles = 0;
};

struct Inputs {
  Scene scene;
  std::vector<InputPart> parts;  ///< in command order; their ids follow each other
  bool has_materials = false;    ///< of files: a colour given by hand is none
};

/// Replaces `auto` by `material` for the materials of a file, else by `phong`. The library's own
/// choice would take a colour given by hand for a material.
[[nodiscard]] inline Shader shader_of(Shader asked, bool has_materials) {
  if (asked != Shader::automatic) return asked;
  return has_materials ? Shader::material : Shader::phong;
}

/// The scene of an INPUT (input_spec.hpp), placed and painted; `-` is standard input. Throws
/// UsageError for a builtin that does not exist, Error for a file that cannot be read.
[[nodiscard]] Scene load_input(const std::string& input, const InputReading& reading = {});

/// Places and paints the scene that was read for one INPUT, and makes normals, as load_inputs does.
void finish_input(Scene& scene, const std::string& input, const NormalOptions& normals);

/// All inputs, appended in order, with their normals. Each is an event of `timeline`.
[[nodiscard]] Inputs load_inputs(const std::vector<std::string>& inputs,
                                 const NormalOptions& normals, Timeline& timeline,
                                 Progress& progress, const InputReading& reading = {});

void set_sizes(Scene& scene, const PixelSizes& sizes);

/// How many animations the input with the most has.
[[nodiscard]] std::size_t animation_count(const Scene& scene);
/// rastrum::pose; normals that the files do not have are made again. There is such an animation.
void pose_inputs(Inputs& inputs, const NormalOptions& normals, double seconds,
                 std::size_t animation);

/// The number of the input that each pixel shows, −1 where `ids` is: a search among the parts.
[[nodiscard]] Image<std::int32_t> inputs_of_ids(ImageView<const std::int64_t> ids,
                                                std::span<const InputPart> parts);

}  // namespace rastrum::cli
