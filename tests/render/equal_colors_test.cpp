// Colours, float32 and 8 bits, are the same bits on every instruction set, for every number of
// threads and on the serial device: over generated scenes of all that can have a colour.
#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <rastrum/render.hpp>

#include "tests/support/shaded_scenes.hpp"
#include "tests/support/test_share.hpp"

namespace rastrum::test::equal_colors_test {
namespace {

struct Picture {
  Image<Rgba8> color8;
  Image<Vec4> color;
  Image<float> depth;
  Image<std::int64_t> ids;
};

Picture take(Renderer& renderer, const ShadedScene& s) {
  const int w = s.frame.width, h = s.frame.height;
  Picture p{Image<Rgba8>(w, h), Image<Vec4>(w, h), Image<float>(w, h), Image<std::int64_t>(w, h)};
  Targets targets;
  targets.color8 = p.color8;
  targets.color = p.color;
  targets.depth = p.depth;
  targets.ids = p.ids;
  const SceneBinding binding(s.scene);
  renderer.render(binding.view(), s.camera, s.frame, targets);
  return p;
}

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}
bool same_bits(const Vec4& a, const Vec4& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z) && same_bits(a.w, b.w);
}

testing::AssertionResult same(const Picture& a, const Picture& b) {
  for (int y = 0; y < a.ids.height(); ++y)
    for (int x = 0; x < a.ids.width(); ++x) {
      const Vec4 p = a.color(x, y), q = b.color(x, y);
      if (a.ids(x, y) == b.ids(x, y) && same_bits(a.depth(x, y), b.depth(x, y)) &&
          same_bits(p, q) && a.color8(x, y) == b.color8(x, y))
        continue;
      return testing::AssertionFailure()
             << "(" << x << ", " << y << "): id " << a.ids(x, y) << " and " << b.ids(x, y)
             << ", colour " << std::hexfloat << p.x << " " << p.y << " " << p.z << " " << p.w
             << " and " << q.x << " " << q.y << " " << q.z << " " << q.w;
    }
  return testing::AssertionSuccess();
}

TEST(EqualColors, OnEveryInstructionSet) {
  struct Way {
    std::string name;
    Renderer renderer;
  };
  std::vector<Way> ways;
  ways.push_back({"serial", Renderer({.device = Device::serial})});
  for (const Isa isa : available_isas())
    ways.push_back({std::string(name(isa)), Renderer({.threads = 1, .isa = isa})});
  ways.push_back({"3 threads", Renderer({.threads = 3})});

  const int scenes = share_of(1000, 60);
  int failures = 0;
  std::uint64_t seen = 0;
  for (int seed = 0; seed < scenes; ++seed) {
    const ShadedScene s = generate_shaded(static_cast<std::uint64_t>(seed));
    const Picture expected = take(ways[0].renderer, s);
    seen += static_cast<std::uint64_t>(
        std::ranges::count_if(expected.ids.pixels(), [](std::int64_t id) { return id >= 0; }));
    for (std::size_t i = 1; i < ways.size(); ++i) {
      const auto equal = same(take(ways[i].renderer, s), expected);
      EXPECT_TRUE(equal) << "scene " << seed << " (" << s.kind << ", " << name(s.frame.shader)
                         << ", " << s.frame.samples << " samples), " << ways[i].name
                         << " and serial";
      if (!equal && ++failures == 10) FAIL() << "ten pictures differed; the rest was not drawn";
    }
  }
  // Scenes that nobody sees compare nothing.
  EXPECT_GT(seen, static_cast<std::uint64_t>(scenes) * 100);
}

}  // namespace
}  // namespace rastrum::test::equal_colors_test
