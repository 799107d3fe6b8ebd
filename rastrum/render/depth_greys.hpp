// Shader::depth: greys by the range of depths of a whole picture, once that is known.
#pragma once

#include <rastrum/frame.hpp>
#include <rastrum/vec.hpp>

namespace rastrum {

/// Fills color8 and color of `targets`. Nearest white, farthest black; one depth alone is white. A
/// surface at depth 0 is left to the background, from which its depth does not tell it.
void stretch_depth(ImageView<float> depth, Vec4 background, const Targets& targets);

}  // namespace rastrum
