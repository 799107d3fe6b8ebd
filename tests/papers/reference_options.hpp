// Options of the pictures that the rows are compared with; options of the rows begin from them.
#pragma once

#include "tests/support/painter.hpp"

namespace rastrum::test {

/// One thread, plain C++, triangles told apart by colour.
[[nodiscard]] inline RenderOptions reference_options(int width, int height) {
  RenderOptions o;
  o.width = width;
  o.height = height;
  o.device = Device::serial;
  o.shader = Shader::id;
  return o;
}

}  // namespace rastrum::test
