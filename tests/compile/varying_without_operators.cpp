// SPDX-License-Identifier: BSD-3-Clause
// A mistake of many first shaders: the varying cannot be added and scaled. The compiler must say
// only that, once (compile_test.cmake).
#include <rastrum/program.hpp>

namespace {
struct Shade {
  float value = 0;
};
}  // namespace

int main() {
  using namespace rastrum;
  Program program(
      [](std::uint32_t) {
        return VertexOutput<Shade>{{0, 0, 0, 1}, {1}};
      },
      [](const Shade& s, const Fragment&) {
        return Vec4{s.value, s.value, s.value, 1};
      },
      [](const Shade& s, const Fragment&) { return s.value > 0; });
  const ProgramDraw draw = program.draw(3);
  return static_cast<int>(draw.primitive_count);
}
