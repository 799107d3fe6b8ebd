// What the drawing functions of this floor have in common beside the public header.
#pragma once

#include <rastrum/overlay.hpp>

namespace rastrum::overlay {

/// Throws Error{invalid_argument} where the views differ in size or have rows that overlap.
void check(const Canvas& canvas);

}  // namespace rastrum::overlay
