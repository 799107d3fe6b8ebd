// SPDX-License-Identifier: BSD-3-Clause
// Words for a window's picture, for both a command line and Python.
#pragma once

#include <string>
#include <vector>

#include "picture_text.hpp"
#include "same_picture.hpp"

namespace rastrum::cli::window {

/// Whether an option of the command line is repeated as given.
[[nodiscard]] bool is_repeated(const std::string& option, const MeshSettings& s);
void say_given(Words& say, const Parser::Given& given);
/// If they change something.
void say_tone(Words& say, const ToneMapping& tone);
void say_tone(Call& say, const ToneMapping& tone);
/// The value of --lights; empty if --light gives the lights, or nothing does.
[[nodiscard]] std::string lights_name(const ShownPicture& shown);

/// The value of Python's `lights=`, in the order in which lights add up; empty: none. `name`: the
/// value of --lights; `as_given`: the last of `lights` are those of --light.
[[nodiscard]] std::string python_lights(const std::string& name, bool as_given,
                                        const std::vector<Light>& lights,
                                        const std::vector<Parser::Given>& given);
/// The value of `cmap=`; `map`: as for --cmap.
[[nodiscard]] std::string python_mapping(const std::string& map, const ScalarOptions& scalars);
/// The value of `annotate=`; empty: none.
[[nodiscard]] std::string python_notes(const AnnotationOptions& a);

}  // namespace rastrum::cli::window
