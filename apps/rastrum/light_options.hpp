// Lights as options of the commands that draw meshes.
#pragma once

#include <string>
#include <vector>

#include <rastrum/light.hpp>

#include "option.hpp"

namespace rastrum::cli {

/// Fills `lights`; both options may be given, and add up.
void add_light_options(Parser& app, std::vector<Light>& lights, const char* group);

/// KIND[:PLACE][:NAME=VALUE]…, as --light has it. Throws UsageError.
[[nodiscard]] Light parse_light(const std::string& text);

}  // namespace rastrum::cli
