// What a command line and Python say alike of the picture of a window.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "same_picture.hpp"

namespace rastrum::cli::window {

/// Whether an option of the command line is said again, as it was given.
[[nodiscard]] bool is_repeated(const std::string& option, const MeshSettings& s);
[[nodiscard]] std::string transparency_name(const TransparencyOptions& t);
[[nodiscard]] std::string tone_name(Tone tone);
/// What the panel's choice is, else what --lights has; empty: neither.
[[nodiscard]] std::string lights_said(const std::string& chosen,
                                      std::span<const Parser::Given> given);
/// As --lights has it; empty: what --light says, or nothing.
[[nodiscard]] std::string lights_name(const ShownPicture& shown);

/// What stands behind Python's `lights=`, in the order in which they are added up; empty: nothing.
/// `name`: of --lights; `as_given`: those of --light are among `lights`, the last of them.
[[nodiscard]] std::string python_lights(const std::string& name, bool as_given,
                                        const std::vector<Light>& lights,
                                        const std::vector<Parser::Given>& given);
/// What stands behind `cmap=`; `map`: as --cmap has it.
[[nodiscard]] std::string python_mapping(const std::string& map, const ScalarOptions& scalars);
/// What stands behind `annotate=`; empty: nothing.
[[nodiscard]] std::string python_notes(const AnnotationOptions& a);

}  // namespace rastrum::cli::window
