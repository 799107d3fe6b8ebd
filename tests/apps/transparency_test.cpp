// SPDX-License-Identifier: BSD-3-Clause
// --opacity, --transparency, --alpha-threshold, --samples and --show-errors, by their effects.
#include "frame/heatmap.hpp"
#include "parse/scene_options.hpp"

#include <rastrum/family.hpp>
#include <rastrum/shapes.hpp>

#include "parse/arguments.hpp"
#include "program.hpp"

#include "tests/support/painter.hpp"

namespace rastrum::test::transparency_test {
namespace {

class TransparencyOption : public Program {
 protected:
  /// Expects that the program's picture with these options equals the library's with `render_`.
  Image<Rgba8> expect(const Args& options) const {
    const Scene scene = scene_of(shapes::boxes(3));
    Image<Rgba8> picture =
        drawn("render --look plain builtin:boxes?count=3 --size 72x56 --opacity 0.25" + options);
    EXPECT_TRUE(same_pixels(picture, draw(scene, fit(scene, render_), render_).color8)) << options;
    return picture;
  }
  RenderOptions render_{{.width = 72, .height = 56, .opacity = 0.25F}};
};

TEST_F(TransparencyOption, Methods) {
  const Image<Rgba8> exact = expect({});
  EXPECT_LT(exact(36, 28).a, 255);
  for (const auto& [word, method] :
       {std::pair{"unsorted", TransparencyOptions{Transparency::unsorted}},
        {"wboit", family::wboit()},
        {"mboit4", family::mboit4()},
        {"mboit6", family::mboit6()},
        {"none", {Transparency::none}}}) {
    render_.transparency = method;
    EXPECT_FALSE(same_pixels(expect(Args("--transparency") + word), exact)) << word;
  }
  // Four layers are enough for these boxes.
  render_.transparency = family::mlab4();
  (void)expect("--transparency mlab4");
  render_.transparency = {};
  EXPECT_TRUE(same_pixels(expect("--transparency exact"), exact));
  render_.transparency = family::filtered(5);
  (void)expect("--transparency filter:5");
}

TEST_F(TransparencyOption, AlphaThresholdWithAndWithoutValue) {
  const Image<Rgba8> all = expect({});
  render_.transparency.alpha_threshold = 0.25F;
  EXPECT_FALSE(same_pixels(expect("--alpha-threshold 0.25"), all));
  render_.transparency.alpha_threshold = 1 - 1 / 128.0F;
  (void)expect("--alpha-threshold");
  (void)expect("--alpha-threshold 0.9921875");
}

TEST_F(TransparencyOption, Samples) {
  const Image<Rgba8> one = expect({});
  for (const int samples : {4, 8, 16}) {
    render_.samples = samples;
    EXPECT_FALSE(same_pixels(expect({"--samples", std::to_string(samples)}), one));
  }
  render_.samples = 1;
  EXPECT_TRUE(same_pixels(expect("--samples 1"), one));
}

TEST_F(TransparencyOption, WordsOfTheParser) {
  TransparencyOptions options;
  cli::parse_transparency("filter:64", options);
  EXPECT_EQ(options, family::filtered(64));
  EXPECT_EQ(cli::transparency_name(options), "filter:64");
  for (const char* wrong : {"", "filter", "filter:", "filter:0", "filter:65", "filter:3x", "Exact"})
    EXPECT_THROW(cli::parse_transparency(wrong, options), cli::UsageError) << wrong;
  EXPECT_EQ(cli::parse_alpha_threshold(""), 0.9921875F);
  EXPECT_EQ(cli::parse_alpha_threshold("1"), 1);
  for (const char* wrong : {"0", "-1", "1.01", "nan", "x"})
    EXPECT_THROW((void)cli::parse_alpha_threshold(wrong), cli::UsageError) << wrong;
}

TEST_F(TransparencyOption, StatisticsCountLayers) {
  must("render --look plain builtin:boxes?count=3 --opacity 0.5 --stats s.json --size 72x56");
  const auto counters = json("s.json")["counters"];
  EXPECT_GT(counters["translucent fragments"], 0);
  EXPECT_GT(counters["layer blocks"], 0);
  EXPECT_GT(counters["deepest"], 2);
  EXPECT_TRUE(counters.contains("repaired pixels"));
  EXPECT_EQ(json("s.json")["visibility"], "layers");
  must(
      "render --look plain builtin:boxes?count=3 --opacity 0.5 --stats s.json --size 72x56 "
      "--transparency filter:1");
  EXPECT_TRUE(json("s.json")["counters"].contains("wrong pixels"));
}

TEST_F(TransparencyOption, ErrorsArePaintedRedOverTheGreyPicture) {
  // A soup's triangles cross each other: a filter of one fragment must fail somewhere.
  const Args base("render --look plain builtin:soup --size 160x120 --opacity 0.5 --transparency");
  const auto red_of = [&](const std::string& method, bool timed) {
    Args args = base + Args{method, "--show-errors", "e.png", "-o", "p.png"};
    if (timed) args = args + "--stats s.json";
    const std::string said = must(args);
    std::uint64_t red = 0;
    const Image<Rgba8> picture = png("e.png");
    for (const Rgba8 c : picture.pixels()) {
      red += c == Rgba8{255, 0, 0, 255};
      EXPECT_TRUE((c == Rgba8{255, 0, 0, 255}) || (c.r == c.g && c.g == c.b && c.r < 129));
    }
    EXPECT_TRUE(holds(said, "e.png: " + std::to_string(red) + " of 19200 pixels are red"));
    if (timed) {
      const auto counters = json("s.json")["counters"];
      EXPECT_EQ(counters[method == "exact" ? "repaired pixels" : "wrong pixels"], red);
    }
    return red;
  };
  const std::uint64_t wrong = red_of("filter:1", false);
  EXPECT_GT(wrong, 0U);
  EXPECT_EQ(red_of("filter:1", true), wrong);
  (void)red_of("exact", true);
  EXPECT_EQ(red_of("unsorted", false), 0U);
}

TEST(ErrorPicture, GreyIsTheLumaOverBlack) {
  Image<Rgba8> picture(3, 1);
  picture(0, 0) = {255, 255, 255, 255};
  picture(1, 0) = {255, 255, 255, 128};
  picture(2, 0) = {10, 200, 30, 255};
  Image<std::uint8_t> errors(3, 1);
  errors(2, 0) = 255;
  const cli::ErrorPicture p = cli::make_error_picture(picture.view(), errors.view());
  EXPECT_EQ(p.image(0, 0), (Rgba8{127, 127, 127, 255}));
  EXPECT_EQ(p.image(1, 0), (Rgba8{64, 64, 64, 255}));
  EXPECT_EQ(p.image(2, 0), (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(p.wrong, 1U);
}

TEST_F(TransparencyOption, BlendMaterialsAreBlendedAndOnlyNoneWarns) {
  write("m.mtl", "newmtl glass\nKd 1 0 0\nd 0.5\n");
  write("t.obj", "mtllib m.mtl\nusemtl glass\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Args args("render --look plain t.obj -o p.png --size 33x33");
  EXPECT_FALSE(holds(must(args), "BLEND"));
  EXPECT_EQ(png("p.png")(14, 18).a, 128);
  EXPECT_TRUE(holds(must(args + "--transparency none"),
                    "1 of 1 materials ask for blending (alphaMode BLEND)"));
  EXPECT_EQ(png("p.png")(14, 18).a, 255);
}

}  // namespace
}  // namespace rastrum::test::transparency_test
