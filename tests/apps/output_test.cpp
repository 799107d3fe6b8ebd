// SPDX-License-Identifier: BSD-3-Clause
// The three formats of one picture agree, and depth and ids are the library's.
#include <algorithm>
#include <cmath>

#include <rastrum/digest.hpp>
#include <rastrum/shapes.hpp>

#include "program.hpp"

#include "tests/support/painter.hpp"

namespace rastrum::test::output_test {
namespace {

const Args kTeapot("render --look plain builtin:teapot?n=4 --size 96x64 --background #3366cc80");

class Output : public Program {
 protected:
  void render(const Args& outputs) const { must(kTeapot + outputs); }
  static Drawn expected() {
    RenderOptions options(
        {.width = 96, .height = 64, .background = {0.2F, 0.4F, 0.8F, 128 / 255.0F}});
    const Scene scene = scene_of(shapes::teapot(4));
    return draw(scene, fit(scene, options), options);
  }
};

TEST_F(Output, PngNpyAndExrAgree) {
  render("-o p.png");
  render("-o p.npy");
  const Image<Rgba8> picture = png("p.png");
  const Npy array = npy("p.npy");
  EXPECT_TRUE(holds(array.header, "'<f4'"));
  EXPECT_TRUE(holds(array.header, "(64, 96, 4)"));
  const std::vector<float> rgba = array.values<float>();
  ASSERT_EQ(rgba.size(), 96U * 64 * 4);
  for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
    const Rgba8 c = picture.pixels()[i];
    const float alpha = rgba[4 * i + 3];
    EXPECT_EQ(std::nearbyint(alpha * 255), c.a);
    const std::uint8_t straight[3] = {c.r, c.g, c.b};
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_LE(std::abs(rgba[4 * i + k] / alpha * 255 - static_cast<float>(straight[k])), 0.501F);
  }
#ifdef RASTRUM_HAS_OPENEXR
  render("-o p.exr");
  const auto planes = exr("p.exr", {"R", "G", "B", "A"});
  for (std::size_t i = 0; i < picture.pixels().size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) ASSERT_EQ(planes[k][i], rgba[4 * i + k]);
#else
  GTEST_SKIP() << "built without OpenEXR: .exr is not tested";
#endif
}

TEST_F(Output, AreTheLibrarysImages) {
  const Drawn e = expected();
  // One pass, and with statistics the timed pass and the next one, give the same.
  for (const Args& timing : {Args{}, Args("--frames 2")}) {
    Args outputs = "-o p.npy --depth d.npy --ids i.npy" + timing;
    render(outputs);
    EXPECT_TRUE(npy("p.npy").holds(e.color));
    EXPECT_TRUE(npy("d.npy").holds(e.depth));
    EXPECT_TRUE(npy("i.npy").holds(e.ids));
    outputs[1] = "p.png";
    render(outputs);
    EXPECT_TRUE(same_pixels(png("p.png"), e.color8));
  }
  EXPECT_TRUE(holds(npy("i.npy").header, "'<i8'"));
  EXPECT_TRUE(holds(npy("i.npy").header, "(64, 96)"));
  EXPECT_TRUE(holds(npy("d.npy").header, "(64, 96)"));
  EXPECT_EQ(std::ranges::count(e.ids.pixels(), -1), std::ranges::count(e.depth.pixels(), 0.0F));
}

// A line for each written picture, or only for the 8-bit colours.
TEST_F(Output, HashesAreTheLibrarysDigests) {
  const Drawn e = expected();
  const auto lines = [&](Args more) {
    const Outcome o = run(kTeapot + "--hash" + more);
    EXPECT_EQ(o.status, 0) << o.err;
    return o.out;
  };
  EXPECT_EQ(lines({}), digest(e.color8).hex() + "  color\n");
  EXPECT_EQ(lines("-o p.npy --depth d.npy --ids i.npy"), digest(e.color).hex() + "  color\n" +
                                                             digest(e.depth).hex() + "  depth\n" +
                                                             digest(e.ids).hex() + "  ids\n");
  EXPECT_TRUE(holds(lines("--turntable 2"), "  color 1\n"));
  refused("render --look plain builtin:teapot --hash -o -", "--hash");
}

TEST_F(Output, DepthAsExr) {
#ifdef RASTRUM_HAS_OPENEXR
  render("--depth d.exr");
  EXPECT_TRUE(std::ranges::equal(exr("d.exr", {"Z"})[0], expected().depth.pixels()));
  EXPECT_EQ(files(), Args("d.exr"));
#else
  GTEST_SKIP() << "built without OpenEXR";
#endif
}

TEST_F(Output, ExtensionsInAnyCase) {
  render("-o P.PNG --depth D.Npy");
  EXPECT_EQ(png("P.PNG").width(), 96);
  EXPECT_EQ(npy("D.Npy").values<float>().size(), 96U * 64);
}

}  // namespace
}  // namespace rastrum::test::output_test
