// SPDX-License-Identifier: BSD-3-Clause
// "Did you mean", and the typing errors that lead to it.
#include <rastrum/core/nearest_word.hpp>

#include <vector>

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
           {"terr", "terrain"},  // an abbreviation
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

using Suggestions = Program;

TEST_F(Suggestions, OfCommands) {
  refused({"rendr", "a.ply"}, "there is no command 'rendr'; did you mean 'render'?");
  refused({"paint"}, "there is no command 'paint'; there are render, terrain, view, info, make");
  write("a.ply", "");
  refused({"a.ply"}, "'a.ply' is a file, not a command: `rastrum render a.ply -o picture.png`");
}

TEST_F(Suggestions, OfOptions) {
  refused("render a.ply --backgroud red", "did you mean '--background'?");
  refused("render a.ply --backgroud=red", "did you mean '--background'?");
  refused("terrain --heigth a.png", "did you mean '--height'?");
  refused("render a.ply --zzzzzz", "there is no option --zzzzzz\n");
}

TEST_F(Suggestions, OfFilesInAFolder) {
  std::filesystem::create_directory(path("models"));
  const auto folder = [&](const std::string& says) {
    refused("render models -o p.png", "models: is a folder; " + says, 1);
    refused("info models", "models: is a folder; " + says, 1);
  };
  folder("no mesh file lies in it");
  write("models/b.ply", "");
  write("models/readme.txt", "");
  folder("give the file in it, models/b.ply");
  write("models/A.STL", "");
  folder("give files in it, such as models/A.STL (of 2)");
  std::filesystem::create_directory(path("folder.ply"));
  refused("render folder.ply -o p.png", "folder.ply: is a folder; ", 1);
}

TEST_F(Suggestions, OfWhatToLeaveOut) {
  refused("render a.ply --fit --eye 1,2,3 -o p.png",
          "--fit: shows the whole scene, but --eye places the camera: leave one");
  refused("render a.ply -o x.jpg",
          "-o: the name of the file must end in .png, .exr, .npy (with --path also .mp4)");
}

TEST_F(Suggestions, OfColours) {
  refused(
      "render a.ply -o p.png --background bleu",
      "--background: expected a colour such as '#ffcc00', '#ffcc0080', fc0 or gold, got 'bleu'; "
      "did you mean 'blue'?");
}

}  // namespace
}  // namespace rastrum::test::suggest_test
