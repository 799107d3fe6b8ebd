// SPDX-License-Identifier: BSD-3-Clause
// Lights as options.
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

struct LightChoice {
  bool of_files = false;  ///< the lights of the inputs count
  bool given = false;     ///< even if only the fixed light was
};

/// Adds options that fill the frame's lights. --lights and --light add up. `of_files`: lights of
/// the inputs count, too.
void add_light_options(Parser app, FrameOptions& frame, LightChoice& choice);
/// For ground, which has other --shadows. Objects on it use the same `frame`.
void add_ground_lights(Parser app, FrameOptions& frame, LightChoice& choice);
/// Throws UsageError if the inputs have no lights.
void add_file_lights(const Scene& scene, std::vector<Light>& lights);

inline const Choices<Tone> kTones{{"none", Tone::none},
                                  {"reinhard", Tone::reinhard},
                                  {"aces", Tone::aces},
                                  {"neutral", Tone::neutral}};

[[nodiscard]] bool has_environment(const std::vector<Light>& lights);

/// The text of an option if it was given, else `otherwise`.
[[nodiscard]] std::string said(std::span<const Parser::Given> given, std::string_view option,
                               const std::string& otherwise);
/// Adds options to `given`. A repeated option replaces its earlier text, and lights replace all
/// earlier lights.
void say_again(std::vector<Parser::Given> options, const LightChoice& lights,
               std::vector<Parser::Given>& given);

/// KIND[:PLACE][:NAME=VALUE]…, as --light takes it. Throws UsageError.
[[nodiscard]] Light parse_light(const std::string& text);

}  // namespace rastrum::cli
