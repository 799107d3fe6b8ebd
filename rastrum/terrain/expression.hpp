// Terrains that are formulas in a text. Of the target Rastrum::io, as all that reads with a library
// of others; Rastrum::rastrum alone has everything else of this folder.
#pragma once

#include <string>

#include <rastrum/terrain/light.hpp>

namespace rastrum::terrain {

/// A formula of x and y in the language of muParser, such as `40*sin(x/30)*cos(y/50)`.
/// Throws Error{invalid_argument} with the place of the mistake, Error{unsupported} where the
/// library was built without muParser.
[[nodiscard]] HeightFunction expression_function(const std::string& expression);

}  // namespace rastrum::terrain
