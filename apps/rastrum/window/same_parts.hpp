// What a command line and Python say alike of the picture of a window.
#pragma once

#include <string>

#include "same_picture.hpp"

namespace rastrum::cli::window {

/// Whether an option of the command line is said again, as it was given.
[[nodiscard]] bool is_repeated(const std::string& option, const MeshSettings& s);
[[nodiscard]] std::string transparency_name(const TransparencyOptions& t);
[[nodiscard]] std::string tone_name(Tone tone);
/// As --lights has it; empty: what --light says, or nothing.
[[nodiscard]] std::string lights_name(const ShownPicture& shown);

}  // namespace rastrum::cli::window
