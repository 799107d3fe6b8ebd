// The properties of each built-in shader, beside how it draws.
#pragma once

#include <rastrum/frame.hpp>

namespace rastrum {

/// Throws Error{invalid_argument} for a value that is none.
void check(Shader shader);
/// Whether lights of the frame fall on what it draws.
[[nodiscard]] bool takes_lights(Shader shader);
/// Whether it draws arrays that are memory of a device.
[[nodiscard]] bool draws_in_place(Shader shader);

}  // namespace rastrum
