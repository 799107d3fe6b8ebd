// SPDX-License-Identifier: BSD-3-Clause
// Words for the picture of a window that a command line and Python have in common.
#pragma once

#include <string>
#include <vector>

#include "picture_text.hpp"
#include "same_picture.hpp"

namespace rastrum::cli::window {

/// Whether an option of the command line is said again, as it was given.
[[nodiscard]] bool is_repeated(const std::string& option, const MeshSettings& s);
/// Says an option again, as it was given.
void say_given(Words& say, const Parser::Given& given);
/// Says --tone and --exposure, where they change something.
void say_tone(Words& say, const ToneMapping& tone);
void say_tone(Call& say, const ToneMapping& tone);
/// The lights in the words of --lights; empty: --light gives them, or nothing does.
[[nodiscard]] std::string lights_name(const ShownPicture& shown);

/// The value of Python's `lights=`, in the order in which lights are added up; empty: none. `name`:
/// the value of --lights; `as_given`: lights of --light are among `lights`, the last of them.
[[nodiscard]] std::string python_lights(const std::string& name, bool as_given,
                                        const std::vector<Light>& lights,
                                        const std::vector<Parser::Given>& given);
/// The value of `cmap=`; `map`: as --cmap has it.
[[nodiscard]] std::string python_mapping(const std::string& map, const ScalarOptions& scalars);
/// The value of `annotate=`; empty: none.
[[nodiscard]] std::string python_notes(const AnnotationOptions& a);

}  // namespace rastrum::cli::window
