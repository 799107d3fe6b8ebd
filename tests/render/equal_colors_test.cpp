// Colours, float32 and 8 bits, are the same bits on every instruction set, for every number of
// threads and on the serial device: over generated scenes of all that can have a colour.
#include <algorithm>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/every_way.hpp"
#include "tests/support/shaded_scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::equal_colors_test {
namespace {

TEST(EqualColors, OnEveryInstructionSet) {
  EveryWay ways{{.threads = 1}, {.threads = 3, .isa = available_isas().back()}};
  const int scenes = share_of(1000, 60);
  std::uint64_t seen = 0;
  for (int seed = 0; seed < scenes && !HasFailure(); ++seed) {
    const ShadedScene s = generate_shaded(static_cast<std::uint64_t>(seed));
    SCOPED_TRACE(testing::Message()
                 << "scene " << seed << " (" << s.kind << ", " << name(s.frame.shader) << ", "
                 << s.frame.samples << " samples)");
    const Frame expected =
        ways.same([&](Renderer& renderer) { return draw(renderer, s.view(), s.camera, s.frame); });
    seen += static_cast<std::uint64_t>(
        std::ranges::count_if(expected.ids.pixels(), [](std::int64_t id) { return id >= 0; }));
  }
  // Scenes that nobody sees compare nothing.
  EXPECT_GT(seen, static_cast<std::uint64_t>(scenes) * 100);
}

}  // namespace
}  // namespace rastrum::test::equal_colors_test
