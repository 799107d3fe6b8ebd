// Words and effects as options of the program: colours alone change, and what cannot be meant is
// refused.
#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "program.hpp"

namespace rastrum::test::annotations_test {
namespace {

using Annotations = Program;

const Args kScene{"render", "--look", "plain",    "builtin:gyroid?cells=16",
                  "--eye",  "4,3,5",  "--target", "0,0,0",
                  "--size", "240x180"};

Args with(const Args& more) {
  return kScene + more;
}

TEST_F(Annotations, ChangeColoursAlone) {
  must(with({"-o", "plain.png", "--depth", "d0.npy", "--ids", "i0.npy"}));
  const Image<Rgba8> plain = png("plain.png");
  for (const std::string option :
       {"--axes", "--bounds", "--occlusion", "--edl", "--silhouettes", "--edges"}) {
    must(with({option, "-o", "a.png", "--depth", "d1.npy", "--ids", "i1.npy", "--image",
               "view-depth=v.npy"}));
    EXPECT_FALSE(same_pixels(plain, png("a.png"))) << option;
    EXPECT_EQ(read("d0.npy"), read("d1.npy")) << option;
    EXPECT_EQ(read("i0.npy"), read("i1.npy")) << option;
  }
  must(with({"--title", "α = 3°", "--caption", "one", "--caption", "two", "-o", "a.png"}));
  EXPECT_FALSE(same_pixels(plain, png("a.png")));
  // Thread counts and instruction sets change nothing; timed frames are annotated, too.
  const Args all{"--axes", "--bounds", "--occlusion", "--edl", "--silhouettes", "--edges"};
  std::set<std::string> pictures;
  for (const Args& how :
       std::vector<Args>{{}, {"--threads", "1"}, {"--isa", "scalar"}, {"--frames", "2"}}) {
    Args args = with(all) + how + Args{"-o", "a.png"};
    must(args);
    pictures.insert(read("a.png"));
  }
  EXPECT_EQ(pictures.size(), 1U);
}

TEST_F(Annotations, FloatsAreAnnotatedToo) {
  must(with({"-o", "plain.npy"}));
  must(with({"--title", "Boxes", "--occlusion", "-o", "a.npy"}));
  EXPECT_NE(read("plain.npy"), read("a.npy"));
}

// As large and as small as numbers of a file are: the picture that is drawn unasked has occlusion.
TEST_F(Annotations, OfScenesOfAnySize) {
  for (const std::string size : {"1e-30", "1e30"}) {
    write("size.obj", "v " + size + " 0 0\nv 0 " + size + " 0\nv 0 0 " + size + "\nf 1 2 3\n");
    must({"render", "size.obj", "--size", "40x30", "--bounds", "--axes", "-o", "a.png"});
    EXPECT_GT(png("a.png")(20, 15).a, 0) << size;
  }
}

TEST_F(Annotations, AreInEachPictureOfATurn) {
  must({"render", "--look", "plain", "builtin:teapot", "--size", "80x60", "--bounds", "--turntable",
        "2", "-o", "t_%d.png"});
  EXPECT_FALSE(same_pixels(png("t_0.png"), png("t_1.png")));
}

TEST_F(Annotations, TerrainHasWords) {
  const Args scene{"terrain", "--function", "noise", "--size", "160x120"};
  must(scene + Args{"--title", "Noise", "-o", "t.png"});
  must(scene + Args{"-o", "p.png"});
  EXPECT_FALSE(same_pixels(png("t.png"), png("p.png")));
}

TEST_F(Annotations, SayWhatTheFontHasNot) {
  const std::string said = must(with({"--title", "漢 a", "-o", "a.png"}));
  EXPECT_TRUE(holds(said, "the font has no U+6F22"));
  // Bytes that are no UTF-8, control characters, marks that combine, what is written from the
  // right.
  for (const auto& [text, code] :
       std::initializer_list<std::pair<std::string, std::string>>{{"a\xff", "U+FFFD"},
                                                                  {"\x01", "U+0001"},
                                                                  {"e\xcc\x81", "U+0301"},
                                                                  {"\xd7\xa9", "U+05E9"}}) {
    const std::string of = must(with({"--scalars", "z", "--bar", text, "-o", "a.png"}));
    EXPECT_TRUE(holds(of, "the font has no " + code));
  }
}

TEST_F(Annotations, RefuseWhatCannotBeMeant) {
  refused(with({"--axes", "--depth", "d.npy"}), "--axes");
  refused(with({"--title", "a", "--depth", "d.npy"}), "--title");
  refused(with({"--occlusion-radius", "2", "-o", "a.png"}), "--occlusion-radius");
  refused(with({"--occlusion", "--occlusion-radius", "-2", "-o", "a.png"}), "--occlusion-radius");
  refused(with({"--occlusion", "--occlusion-radius", "0", "-o", "a.png"}), "--occlusion-radius");
  refused(with({"--occlusion", "--occlusion-radius", "nan", "-o", "a.png"}), "--occlusion-radius");
  refused(with({"--occlusion", "--occlusion-strength", "17", "-o", "a.png"}),
          "--occlusion-strength: must lie above 0, up to 16");
  refused(with({"--edl", "--edl-strength", "1e9", "-o", "a.png"}),
          "--edl-strength: must lie above 0, up to 100");
  refused(with({"--edl-strength", "2", "-o", "a.png"}), "--edl-strength");
  refused(with({"--edge-angle", "30", "-o", "a.png"}), "--edge-angle");
  refused(with({"--edges", "--edge-angle", "181", "-o", "a.png"}), "--edge-angle");
  refused(with({"--edges", "--edge-width", "0", "-o", "a.png"}), "--edge-width");
  refused(with({"--edges", "--depth", "d.npy"}), "--edges");
  refused(with({"--text-scale", "2", "-o", "a.png"}), "--text-scale");
  refused(with({"--title", "a", "--text-scale", "0", "-o", "a.png"}), "--text-scale");
  refused({"terrain", "--function", "noise", "--title", "a", "--depth", "d.npy"}, "--title");
}

}  // namespace
}  // namespace rastrum::test::annotations_test
