// Lights as options of the program.
#include <string>
#include <vector>

#include "program.hpp"

namespace rastrum::test::lights_test {
namespace {

using LightOptions = Program;

const Args kScene{"render", "--look", "plain", "builtin:teapot", "--size", "120x90"};

Args with(const Args& more) {
  return kScene + more;
}

TEST_F(LightOptions, LightThePictureAndNothingElse) {
  must(with({"-o", "plain.png", "--depth", "d0.npy"}));
  const Image<Rgba8> plain = png("plain.png");
  for (const std::string light :
       {"ambient:intensity=0.5", "hemisphere:0,0,1:below=#402000:color=skyblue",
        "directional:0,-1,-1", "point:2,2,2:intensity=4:range=9",
        "spot:0,3,3:towards=0,-1,-1:inner=5:outer=20:intensity=9", "headlight:intensity=0.7"}) {
    must(with({"--light", light, "-o", "lit.png", "--depth", "d1.npy"}));
    EXPECT_FALSE(same_pixels(plain, png("lit.png"))) << light;
    EXPECT_EQ(read("d0.npy"), read("d1.npy")) << light;
  }
  must(with({"--lights", "studio", "-o", "open.png"}));
  must(with({"--lights", "studio", "--shadows", "-o", "shadowed.png"}));
  EXPECT_FALSE(same_pixels(png("open.png"), png("shadowed.png")));
  must(with({"--lights", "default", "-o", "same.png"}));
  EXPECT_TRUE(same_pixels(plain, png("same.png")));
  must(with({"--lights", "headlight", "-o", "head.png"}));
  must(with({"--light", "directional:of=camera", "-o", "same.png"}));
  EXPECT_TRUE(same_pixels(png("head.png"), png("same.png")));
}

TEST_F(LightOptions, EnvironmentsAreFilesOrOurOwn) {
  // A picture of one grey, of the size that the format's runs begin with.
  std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n";
  for (int i = 0; i < 32 * 64; ++i) hdr += "\x60\x60\x60\x80";
  write("grey.hdr", hdr);
  must(with({"--light", "environment:grey.hdr", "--shader", "lambert", "-o", "grey.png"}));
  must(with({"--light", "ambient:intensity=0.375", "--shader", "lambert", "-o", "ambient.png"}));
  const Image<Rgba8> grey = png("grey.png"), ambient = png("ambient.png");
  for (std::size_t i = 0; i < grey.pixels().size(); ++i)
    ASSERT_NEAR(grey.pixels()[i].r, ambient.pixels()[i].r, 1);
  const auto corner = [&](const Args& options) {
    Args all = with(options) + Args{"-o", "behind.png"};
    must(all);
    return png("behind.png")(0, 0);
  };
  EXPECT_EQ(corner({"--light", "environment:grey.hdr"}).a, 0);
  EXPECT_EQ(corner({"--light", "environment:grey.hdr", "--environment-behind"}),
            (Rgba8{165, 165, 165, 255}));
  const Rgba8 seen =
      corner({"--light", "environment:room:turn=90:up=0,0,1", "--environment-behind"});
  EXPECT_NE(seen, corner({"--light", "environment:room", "--environment-behind"}));
}

TEST_F(LightOptions, StudioIsWhatItSays) {
  const auto draw = [&](Args args, const std::string& file) {
    args.insert(args.begin(), {"render", "builtin:teapot", "--size", "120x90", "-o", file});
    must(args);
    return png(file);
  };
  const auto said =
      draw({"--view", "iso", "--fov", "30", "--lights", "studio", "--occlusion", "--samples", "4"},
           "said.png");
  EXPECT_TRUE(same_pixels(draw({"--look", "studio"}, "studio.png"), said));
  // A command line that asks for nothing but a picture gets the studio look, too …
  EXPECT_TRUE(same_pixels(draw({}, "alone.png"), said));
  EXPECT_FALSE(same_pixels(draw({"--look", "plain"}, "plain.png"), said));
  // … except for options that say otherwise.
  EXPECT_TRUE(same_pixels(
      draw({"--look", "studio", "--view", "top", "--samples", "1", "--lights", "headlight"},
           "studio.png"),
      draw({"--look", "plain", "--view", "top", "--lights", "headlight", "--occlusion"},
           "said.png")));
  EXPECT_TRUE(same_pixels(
      draw({"--shader", "phong"}, "phong.png"),
      draw({"--look", "plain", "--view", "iso", "--fov", "30", "--samples", "4"}, "said.png")));
  EXPECT_TRUE(same_pixels(draw({"--lights", "default"}, "default.png"), png("said.png")));
  // The picture of before, by name.
  EXPECT_TRUE(same_pixels(
      draw({"--fit", "sphere", "--view", "front", "--samples", "1", "--shader", "phong"},
           "before.png"),
      draw({"--look", "plain", "--fit", "sphere"}, "said.png")));
}

// The default pictures of the time before there were lights to choose. Their digests were printed
// by `rastrum render builtin:SHAPE --size 120x90 --hash` of 9d2794e (2026-11-23), with and without
// `--fit sphere`; those of spheres and tube by the program of 2026-11-28, since when a fit is not
// rounded to float32.
TEST_F(LightOptions, ThePictureOfBeforeIsThereByItsName) {
  const struct {
    std::string shape, sphere, tight;
  } kBefore[] = {
      {"teapot", "f9e3b6772bb9c951db7c0bc8e60841c0bad4011b3d3a38590ee6793a8469d69f",
       "78639677292b44ce32e4e9a6c3095beb0f995e5cf9744dad321dca49523030f8"},
      {"torus_knot", "9ecb00886e9c84c090206de0684f1b20df5feab51bcd09cf176e1c0b1bd9aa67",
       "b1a68bef41efbb8785189068ca7534ece3413178683d7720584d2ec78b213ac6"},
      {"gyroid?cells=24", "28116e9fbc9c6c11d9b280592096358d41270c212ea49dc85183e3a0601f5e3c",
       "1a32ca10780b4d0bae7a8268fb0a3b999f06c52910e28bc51ad115db8bb35aab"},
      {"spheres", "2f28d2cb460351d02fa9dc48b3413a3afb51cc7bf4516390460d5bee0d1a13ef",
       "14abe0e1f21fe86e9f477decac5715cd76046b2889ef91f74570326fadd33e83"},
      {"tube", "49e7dd6fe776d957df6a9de411c626a86842b14f0f90a1e068d814f5d3c2b6f2",
       "2e87bc8e9ff7d217464b9b201c005de33a10bdf99cbff0d8e915e59a80e82923"}};
  const auto hash = [&](const std::string& shape, Args how) {
    how.insert(how.begin(),
               {"render", "builtin:" + shape, "--size", "120x90", "--hash", "-o", "b.png"});
    const Outcome outcome = run(how);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out.substr(0, 64);
  };
  for (const auto& before : kBefore) {
    EXPECT_EQ(hash(before.shape,
                   {"--fit", "sphere", "--view", "front", "--samples", "1", "--shader", "phong"}),
              before.sphere)
        << before.shape;
    EXPECT_EQ(hash(before.shape, {"--look", "plain"}), before.tight) << before.shape;
  }
}

// Numbers, and frames that are compared, have one sample and the fixed light.
TEST_F(LightOptions, MoreThanAPictureIsPlain) {
  const std::vector<Args> more{{"--ids", "i.npy"},
                               {"--depth", "d.npy"},
                               {"--image", "normals=n.npy"},
                               {"--heatmap", "h.png"},
                               {"--rasterizer", "tiled"}};
  must({"render", "builtin:teapot", "--look", "plain", "--view", "iso", "--fov", "30", "--size",
        "120x90", "-o", "plain.png"});
  for (const Args& options : more) {
    must(Args{"render", "builtin:teapot", "--size", "120x90", "-o", "p.png"} + options);
    EXPECT_TRUE(same_pixels(png("p.png"), png("plain.png"))) << options[0];
  }
}

TEST_F(LightOptions, OfFilesAreAskedFor) {
  write("lit.gltf",
        R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],)"
        R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":9}]}},)"
        R"("nodes":[{"translation":[0,2,3],"extensions":{"KHR_lights_punctual":{"light":0}}}]})");
  must({"render", "--look", "plain", "builtin:teapot", "lit.gltf", "--shader", "phong", "--eye",
        "0,2,5", "--target", "0,0,0", "--size", "120x90", "--lights", "file", "-o", "file.png"});
  must({"render", "--look", "plain", "builtin:teapot", "lit.gltf", "--shader", "phong", "--eye",
        "0,2,5", "--target", "0,0,0", "--size", "120x90", "--light",
        "point:0,2,3:intensity=2.86478886", "-o", "said.png"});
  EXPECT_TRUE(same_pixels(png("file.png"), png("said.png")));
}

TEST_F(LightOptions, RefuseWhatCannotBeMeant) {
  const auto refused = [&](const Args& args, const std::string& part) {
    Program::refused(with(args), part);
  };
  refused({"--light", "laser:1,2,3", "-o", "a.png"}, "--light: expected ambient, hemisphere");
  refused({"--light", "point:1,2", "-o", "a.png"}, "--light");
  refused({"--light", "environment", "-o", "a.png"}, "its environment has no picture");
  refused({"--light", "environment:none.hdr", "-o", "a.png"}, "none.hdr");
  refused({"--light", "environment:room:range=2", "-o", "a.png"}, "has no 'range=2'");
  refused({"--light", "headlight", "--environment-behind", "-o", "a.png"},
          "--environment-behind: is of --light environment");
  refused({"--light", "ambient:1,2,3", "-o", "a.png"}, "has no place");
  refused({"--light", "point:1,2,3:outer=4", "-o", "a.png"}, "has no 'outer=4'");
  refused({"--light", "point:1,2,3:range=-4", "-o", "a.png"}, "its range");
  refused({"--light", "directional:0,0,0", "-o", "a.png"}, "its direction");
  refused({"--light", "headlight:intensity=-1", "-o", "a.png"}, "its intensity");
  refused({"--light", "headlight:intensity=nan", "-o", "a.png"}, "--light");
  refused({"--light", "spot:0,0,1:inner=30:outer=20", "-o", "a.png"}, "its cone");
  refused({"--light", "headlight:of=me", "-o", "a.png"}, "of= is camera or world");
  refused({"--shadows", "-o", "a.png"}, "--shadows: is of --lights and --light");
  refused({"--lights", "studio", "--shadow-size", "512", "-o", "a.png"},
          "--shadow-size: needs --shadows");
  refused({"--lights", "disco", "-o", "a.png"}, "--lights");
  refused({"--lights", "file", "-o", "a.png"}, "have no lights");
}

}  // namespace
}  // namespace rastrum::test::lights_test
