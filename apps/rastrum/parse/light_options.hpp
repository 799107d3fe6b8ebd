// SPDX-License-Identifier: BSD-3-Clause
// Lights as options of the commands that draw meshes and terrains.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/light.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene.hpp>

#include "arguments.hpp"

namespace rastrum::cli {

/// Choices of the light options besides the lights in the frame.
struct LightChoice {
  bool of_files = false;  ///< those of the inputs are added
  bool given = false;     ///< something was said, be it the fixed light
};

/// Adds options that fill the frame's lights. Both --lights and --light may be given, and add up.
/// `of_files`: lights of the inputs count, too.
void add_light_options(Parser app, FrameOptions& frame, LightChoice& choice);
/// The same over ground, whose --shadows are of another kind. Objects on it use the same `frame`.
void add_ground_lights(Parser app, FrameOptions& frame, LightChoice& choice);
/// Adds those of the inputs. Throws UsageError where they have none.
void add_file_lights(const Scene& scene, std::vector<Light>& lights);

/// The words of --tone.
inline const Choices<Tone> kTones{{"none", Tone::none},
                                  {"reinhard", Tone::reinhard},
                                  {"aces", Tone::aces},
                                  {"neutral", Tone::neutral}};

/// Whether one of them is an environment.
[[nodiscard]] bool has_environment(const std::vector<Light>& lights);

/// The text of an option that was given; of another `otherwise`.
[[nodiscard]] std::string said(std::span<const Parser::Given> given, std::string_view option,
                               const std::string& otherwise);
/// Adds options to those that were `given`. Said once more, an option stands for what it said
/// before, and lights stand for all lights before.
void say_again(std::vector<Parser::Given> options, const LightChoice& lights,
               std::vector<Parser::Given>& given);

/// KIND[:PLACE][:NAME=VALUE]…, as --light has it. Throws UsageError.
[[nodiscard]] Light parse_light(const std::string& text);

}  // namespace rastrum::cli
