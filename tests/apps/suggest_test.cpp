// "Did you mean", and what leads to it on the command line.
#include <rastrum/core/nearest_word.hpp>

#include <vector>

#include "parse/arguments.hpp"
#include "program.hpp"

namespace rastrum::test::suggest_test {
namespace {

constexpr std::string_view kWords[] = {"render", "terrain", "view", "info", "make"};

TEST(NearestWord, IsTheOneThatWasMeant) {
  for (const auto& [given, meant] : std::vector<std::pair<std::string_view, std::string_view>>{
           {"rendr", "render"},    // left out
           {"rrender", "render"},  // added
           {"rendor", "render"},   // changed
           {"redner", "render"},   // swapped
           {"RENDER", "render"},
           {"terr", "terrain"},  // begun
           {"terain", "terrain"},
           {"veiw", "view"},
           {"inof", "info"},
           {"mkae", "make"},
           {"paint", ""},
           {"xx", ""},
           {"", ""},
       })
    EXPECT_EQ(nearest_word(given, kWords), meant) << given;
  EXPECT_EQ(nearest_word("a", {}), "");
  EXPECT_EQ(did_you_mean("rendr", kWords), "; did you mean 'render'?");
  EXPECT_EQ(did_you_mean("paint", kWords), "");
}

class Suggestions : public Program {
 protected:
  void expect(const Args& args, int status, const std::string& says) const {
    refused(args, says, status);
  }
};

TEST_F(Suggestions, OfCommands) {
  expect({"rendr", "a.ply"}, 2, "there is no command 'rendr'; did you mean 'render'?");
  expect({"paint"}, 2, "there is no command 'paint'; there are render, terrain, view, info, make");
  write("a.ply", "");
  expect({"a.ply"}, 2, "'a.ply' is a file, not a command: `rastrum render a.ply -o picture.png`");
}

TEST_F(Suggestions, OfOptions) {
  expect({"render", "a.ply", "--backgroud", "red"}, 2, "did you mean '--background'?");
  expect({"render", "a.ply", "--backgroud=red"}, 2, "did you mean '--background'?");
  expect({"terrain", "--heigth", "a.png"}, 2, "did you mean '--height'?");
  expect({"render", "a.ply", "--zzzzzz"}, 2, "there is no option --zzzzzz\n");
}

TEST_F(Suggestions, OfFilesInAFolder) {
  std::filesystem::create_directory(path("models"));
  const auto folder = [&](const std::string& says) {
    expect({"render", "models", "-o", "p.png"}, 1, "models: is a folder; " + says);
    expect({"info", "models"}, 1, "models: is a folder; " + says);
  };
  folder("no mesh file lies in it");
  write("models/b.ply", "");
  write("models/readme.txt", "");
  folder("give the file in it, models/b.ply");
  write("models/A.STL", "");
  folder("give files in it, such as models/A.STL (of 2)");
  std::filesystem::create_directory(path("folder.ply"));
  expect({"render", "folder.ply", "-o", "p.png"}, 1, "folder.ply: is a folder; ");
}

TEST_F(Suggestions, OfWhatToLeaveOut) {
  expect({"render", "a.ply", "--fit", "--eye", "1,2,3", "-o", "p.png"}, 2,
         "--fit: puts the camera where it sees everything, --eye where you say: leave one");
  expect({"render", "a.ply", "-o", "x.jpg"}, 2,
         "-o: the name of the file must end in .png, .exr, .npy (with --path also .mp4)");
}

TEST_F(Suggestions, OfColours) {
  expect({"render", "a.ply", "-o", "p.png", "--background", "bleu"}, 2,
         "--background: expected a colour such as '#ffcc00', '#ffcc0080', fc0 or gold, got 'bleu'; "
         "did you mean 'blue'?");
}

TEST(ParseColor, AsPeopleWriteThem) {
  const auto color = [](std::string_view text) {
    const Vec4 c = cli::parse_color("--background", text);
    const auto byte = [](float v) { return static_cast<std::uint8_t>(v * 255 + 0.5F); };
    return Rgba8{byte(c.x), byte(c.y), byte(c.z), byte(c.w)};
  };
  for (const char* white :
       {"#ffffff", "ffffff", "#fff", "fff", "FFF", "#ffff", "ffffffff", "white", "White"})
    EXPECT_EQ(color(white), (Rgba8{255, 255, 255, 255})) << white;
  EXPECT_EQ(color("#1a2"), (Rgba8{0x11, 0xAA, 0x22, 255}));
  EXPECT_EQ(color("1a28"), (Rgba8{0x11, 0xAA, 0x22, 0x88}));
  EXPECT_EQ(color("aliceblue"), (Rgba8{0xF0, 0xF8, 0xFF, 255}));      // the first,
  EXPECT_EQ(color("yellowgreen"), (Rgba8{0x9A, 0xCD, 0x32, 255}));    // the last,
  EXPECT_EQ(color("rebeccapurple"), (Rgba8{0x66, 0x33, 0x99, 255}));  // and the newest
  EXPECT_EQ(color("transparent"), (Rgba8{0, 0, 0, 0}));
  for (const char* wrong : {"", "#", "#white", "#12345", "1", "ff", "#gggggg", "+1+2+3", "bluee"})
    EXPECT_THROW((void)color(wrong), cli::UsageError) << wrong;
}

}  // namespace
}  // namespace rastrum::test::suggest_test
