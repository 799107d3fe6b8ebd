// SPDX-License-Identifier: BSD-3-Clause
// Meshes in the window's code without a window: replayed scripts, the panel's settings, and command
// lines that draw the same picture.

#include <rastrum/error.hpp>

#include "parse/arguments.hpp"
#include "program.hpp"
#include "window/mesh_subject.hpp"
#include "window/script.hpp"
#include "window/viewer.hpp"

namespace rastrum::test::window_mesh_test {
namespace {

using namespace cli::window;

constexpr int kWidth = 60, kHeight = 40;

/// A mesh in a small window.
class Shown {
 public:
  explicit Shown(const cli::SceneArguments& a) : Shown(a, load_scene(a)) {}
  Shown(const cli::SceneArguments& a, std::shared_ptr<LoadedScene> scene)
      : subject_(a, std::move(scene)) {
    subject_.resize(kWidth, kHeight);
  }
  MeshSubject* operator->() { return &subject_; }

  template <class Change>
  void change(const Change& what) {
    MeshSubject::Settings s = subject_.settings();
    what(s);
    subject_.set(s);
  }
  [[nodiscard]] Image<Rgba8> image() { return subject_.draw(kWidth, kHeight, false)().image; }
  /// The command line and the Python code that draw it into a.png.
  [[nodiscard]] std::string line() { return texts().front().second; }
  [[nodiscard]] std::string python() { return texts().back().second; }

 private:
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> texts() {
    return subject_.same_picture(kWidth, kHeight, "a.png");
  }
  MeshSubject subject_;
};

cli::SceneArguments arguments(const std::string& input) {
  cli::SceneArguments a;
  a.inputs = {input};
  return a;
}

class MeshViewerTest : public Program {
 protected:
  /// Replays `script` on `input` and returns the viewer's last error.
  std::string replay(const std::string& input, const std::string& script) {
    write("script.json", script);
    cli::SceneArguments a = arguments(input);
    a.render.background = cli::parse_color("", "#1a334d");
    auto subject = std::make_unique<MeshSubject>(a, load_scene(a));
    std::vector<KeyHelp> keys = subject->keys();
    ViewerOptions options{.width = 120, .height = 90};
    Viewer viewer(std::move(subject), options);
    Replay replay(read_script(path("script.json"), keys), viewer);
    while (!replay.finished()) replay.step();
    title = viewer.title();
    if (viewer.hovered() != nullptr) hovered = *viewer.hovered();
    return viewer.error();
  }
  [[nodiscard]] std::string shot(const std::string& name) const {
    return R"("screenshot": ")" + path(name).string() + "\"";
  }
  /// Draws the picture with `rastrum render` and a screenshot's camera file.
  Image<Rgba8> rendered(const std::string& input, const std::string& name, const std::string& size,
                        const Args& more = {}) {
    return drawn(Args("render --look plain --background #1a334d " + input + " --path " + name +
                      ".json --size " + size) +
                 more);
  }
  /// Expects that the subject's command line draws its picture.
  void expect_said(Shown& subject) const {
    const std::string line = subject.line();
    run_line(line);
    EXPECT_TRUE(same_pixels(subject.image(), png("a.png"))) << line;
  }
  std::string title;
  Picked hovered;
};

TEST_F(MeshViewerTest, ScreenshotsAreWhatRenderDraws) {
  EXPECT_EQ(replay("builtin:teapot", R"({"fps": 50, "events": [
      {)" + shot("a.png") + R"(},
      {"time": 0.1, "key_down": "right"}, {"time": 0.1, "key_down": "w"},
      {"time": 0.5, "key_up": "right"}, {"time": 0.5, "key_up": "w"},
      {"time": 0.6, )" + shot("b.png") + R"(},
      {"time": 0.7, "options": "--shader normal --opacity 0.5 --samples 4", )" +
                                         shot("c.png") + R"(},
      {"time": 0.8, "size": [50, 70], )" +
                                         shot("d.png") + R"(},
      {"time": 0.9, "key": "h", )" + shot("e.png") +
                                         R"(}]})"),
            "");
  const std::string t = "builtin:teapot";
  EXPECT_TRUE(same_pixels(png("a.png"), rendered(t, "a", "120x90")));
  EXPECT_TRUE(same_pixels(png("b.png"), rendered(t, "b", "120x90")));
  EXPECT_FALSE(same_pixels(png("a.png"), png("b.png")));
  const Args glass("--shader normal --opacity 0.5 --samples 4");
  EXPECT_TRUE(same_pixels(png("c.png"), rendered(t, "c", "120x90", glass)));
  EXPECT_TRUE(same_pixels(png("d.png"), rendered(t, "d", "50x70", glass)));
  static_cast<void>(rendered(t, "e", "50x70", glass + "--heatmap heat.png"));
  EXPECT_TRUE(same_pixels(png("e.png"), png("heat.png")));
}

constexpr const char* kHeights =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\nproperty float heat\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 1\n1 0 0 2\n1 1 0.5 3\n0 1 0 4\n4 0 1 2 3\n";

// A file beside each screenshot draws it again.
TEST_F(MeshViewerTest, ACommandLineDrawsTheSamePicture) {
  write("heights.ply", kHeights);
  const std::string file = path("heights.ply").string();
  const Args options{"--shader phong --opacity 0.5 --samples 4",
                     "--scalars heat --cmap plasma --range 1.5,3 --bar Heat --axes",
                     "--lights studio --occlusion --silhouettes",
                     "--lights headlight --shadows --edges --edge-angle 20 --background white",
                     "--scalars z --cmap '#ff0000,#0000ff' --steps 5 --isolines 4 --samples 8",
                     "--shader material --light point:1,1,3:intensity=4 --tone aces --exposure 1"};
  std::string events =
      R"({"fps": 50, "events": [{"time": 0.1, "key_down": "right"}, {"time": 0.4, "key_up": "right"})";
  for (std::size_t i = 0; i < options.size(); ++i)
    events +=
        R"(, {"options": ")" + options[i] + "\", " + shot("p" + std::to_string(i) + ".png") + "}";
  EXPECT_EQ(replay(file, events + "]}"), "");
  for (std::size_t i = 0; i < options.size(); ++i) {
    const std::string stem = "p" + std::to_string(i);
    const Image<Rgba8> shown = png(stem + ".png");
    std::filesystem::remove(path(stem + ".png"));
    const std::string line = read(stem + ".sh");
    ASSERT_TRUE(line.starts_with("rastrum render ")) << line;
    run_line(line);
    EXPECT_TRUE(same_pixels(shown, png(stem + ".png"))) << line;
  }
}

TEST_F(MeshViewerTest, SectionsAreClipPlanes) {
  Shown subject(arguments("builtin:sphere"));
  subject.change([](auto& s) {
    s.sections[0] = {true, 0.25, true};
    s.sections[2] = {true, -0.5, false};
    s.lights = "studio";
  });
  EXPECT_TRUE(holds(subject.line(), "--clip-plane -1,0,0,0.25 "));
  EXPECT_TRUE(holds(subject.line(), "--clip-plane 0,0,1,0.5 "));
  expect_said(subject);
}

// The numbers have the same bits in both texts, for any direction.
TEST_F(MeshViewerTest, ASectionAcrossTheViewIsAClipPlane) {
  Shown subject(arguments("builtin:torus_knot"));
  for (const char* name : {"right", "up"})
    subject->handle({.kind = Event::Kind::key_down, .key = name});
  subject->advance(0.37);
  const Image<Rgba8> whole = subject.image();
  const Camera camera = subject->control().camera();
  MeshSubject::Settings s = subject->settings();
  s.view_section = section_of_view(camera, subject->scene().box);
  const Vec3d d = s.view_section.direction;
  EXPECT_NEAR(length(d), 1, 1e-15);
  EXPECT_NEAR(dot(d, camera.target - camera.eye), length(camera.target - camera.eye), 1e-12);
  const auto cut = [&](double part, bool below) {
    const ScalarRange all = reach(subject->scene().box, d);
    s.view_section.at = all.low + part * (all.high - all.low);
    s.view_section.below = below;
    subject->set(s);
    expect_said(subject);
    const std::string line = subject.line(), python = subject.python();
    const std::size_t begin = line.find("--clip-plane ") + 13;
    std::string plane = line.substr(begin, line.find(' ', begin) - begin);
    for (std::size_t i = 0; (i = plane.find(',', i)) != std::string::npos; i += 2)
      plane.replace(i, 1, ", ");
    EXPECT_TRUE(holds(python, "clip_planes=[(" + plane + ")]"));
    return subject.image();
  };
  const Image<Rgba8> back = cut(0.5, false), front = cut(0.5, true);
  EXPECT_FALSE(same_pixels(back, whole));
  EXPECT_FALSE(same_pixels(back, front));
  EXPECT_TRUE(same_pixels(cut(0, false), whole)) << "nothing lies before the box";
}

TEST_F(MeshViewerTest, AFileWithoutTheNumbersIsShownWithoutThem) {
  write("heat.ply", kHeights);
  write("plain.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  cli::SceneArguments a = arguments(path("heat.ply").string());
  a.annotations.scalars.name = "heat";
  a.annotations.scalars.bar_title = "Heat";
  Shown subject(a);
  subject.change([](auto& s) { s.sections[0] = {true, 0.5, true}; });
  (void)subject.image();
  const auto open = [&](const char* name) {
    subject->open(path(name))()();
    (void)subject.image();
    EXPECT_FALSE(subject->settings().sections[0].on);
    return subject.line();
  };
  EXPECT_TRUE(holds(open("heat.ply"), "--scalars heat"));
  const std::string line = open("plain.obj");
  EXPECT_FALSE(holds(line, "--scalars"));
  EXPECT_FALSE(holds(line, "--bar"));
}

// The command line also has settings that only the panel can change.
TEST_F(MeshViewerTest, ToneAndLightsOfThePanelAreSaid) {
  Shown subject(arguments("builtin:sphere"));
  subject.change([](auto& s) {
    s.render.shader = Shader::material;
    s.render.tone = {Tone::aces, 1.5F};
    s.lights = "headlight";
  });
  EXPECT_TRUE(holds(subject.line(), "--tone aces --exposure 1.5"));
  EXPECT_TRUE(holds(subject.python(), "tone=\"aces\", exposure=1.5"));
  expect_said(subject);
  EXPECT_TRUE(subject->has_glances() == (subject->settings().render.samples != 1));
}

TEST_F(MeshViewerTest, LightsOfFilesAreShown) {
  EXPECT_TRUE(holds(replay("builtin:sphere", R"({"events": [{"options": "--lights file"}]})"),
                    "no lights of their own"));
  const cli::SceneArguments a = arguments("builtin:sphere");
  const auto scene = load_scene(a);
  scene->scene.lights = {headlight()};  // as in a file
  Shown subject(a, scene);
  const auto under = [&](const char* lights) {
    subject.change([&](auto& s) { s.lights = lights; });
    return subject.image();
  };
  const Image<Rgba8> head = under("headlight");
  EXPECT_FALSE(same_pixels(under(""), head));
  EXPECT_TRUE(same_pixels(under("file"), head));
  EXPECT_TRUE(holds(subject.line(), "--lights file"));
  EXPECT_TRUE(holds(subject.python(), ", lights=\"file\""));
}

TEST_F(MeshViewerTest, AClickSaysTheNumberThere) {
  EXPECT_EQ(replay("builtin:sphere", R"({"events": [{"options": "--scalars z --bar z --bar-unit m"},
      {"time": 0.1, "button_down": "left", "at": [60, 45]}, {"time": 0.2, "button_up": "left"}]})"),
            "");
  EXPECT_TRUE(holds(title, ", z = 0.99"));
  EXPECT_TRUE(title.ends_with(" m")) << title;
  EXPECT_TRUE(
      holds(replay("builtin:sphere", R"({"events": [{"options": "--scalars heat"}]})"), "heat"));
}

TEST_F(MeshViewerTest, APointerThatRestsSaysTheNumberThere) {
  EXPECT_EQ(replay("builtin:sphere", R"({"events": [{"options": "--scalars z --bar z --bar-unit m"},
      {"time": 0.1, "move": [60, 45]}, {"time": 0.5, "move": [60, 45]}]})"),
            "");
  EXPECT_EQ(title, "builtin:sphere") << "that is for clicks";
  EXPECT_TRUE(hovered.value.starts_with("z = 0.99")) << hovered.value;
  EXPECT_TRUE(hovered.value.ends_with(" m")) << hovered.value;
  EXPECT_TRUE(hovered.what.starts_with("instance 0, primitive ")) << hovered.what;
  EXPECT_TRUE(hovered.where.starts_with("(")) << hovered.where;
}

TEST_F(MeshViewerTest, AClickOnAMeshNamesItsPrimitive) {
  const auto click = [&](const std::string& at) {
    EXPECT_EQ(replay("builtin:sphere", R"({"events": [{"button_down": "left", "at": )" + at +
                                           R"(}, {"time": 0.1, "button_up": "left"}]})"),
              "");
  };
  click("[60, 45]");
  EXPECT_TRUE(title.starts_with("builtin:sphere: instance 0, primitive ")) << title;
  EXPECT_TRUE(holds(title, " at ("));
  click("[1, 1]");
  EXPECT_EQ(title, "builtin:sphere: nothing is there");
}

TEST_F(MeshViewerTest, TwoReplaysAreTheSame) {
  const auto pictures = [&](const char* a, const char* b) {
    EXPECT_EQ(replay("builtin:gyroid", R"({"keys": [{"eye": [3, 2, 3], "target": [0, 0, 0]},
                                                    {"time": 1, "eye": [-3, 1, 3]}],
        "fps": 10, "events": [{"time": 0.3, )" +
                                           shot(a) + R"(}, {"time": 1, )" + shot(b) + "}]}"),
              "");
  };
  pictures("a1.png", "b1.png");
  pictures("a2.png", "b2.png");
  EXPECT_TRUE(read("a1.png") == read("a2.png"));
  EXPECT_TRUE(read("b1.png") == read("b2.png"));
  EXPECT_FALSE(read("a1.png") == read("b1.png"));
  // The path's too: picture 3 at ten a second is the one at 0.3 s.
  must(
      "render --look plain builtin:gyroid --path script.json --fps 10 --size 120x90 --background "
      "#1a334d -o f%d.png");
  EXPECT_TRUE(same_pixels(png("a1.png"), png("f3.png")));
  EXPECT_TRUE(same_pixels(png("b1.png"), png("f10.png")));
}

TEST_F(MeshViewerTest, OpensFilesAndSurvivesBadOnes) {
  must("make torus_knot -o knot.ply");
  write("bad.ply", "ply\nnonsense");
  EXPECT_TRUE(
      holds(replay("builtin:sphere", R"({"events": [{"open": ")" + path("bad.ply").string() +
                                         R"("}, {"time": 0.1, )" + shot("a.png") + "}]}"),
            "bad.ply"));
  EXPECT_TRUE(same_pixels(png("a.png"), rendered("builtin:sphere", "a", "120x90")));
  EXPECT_EQ(title, "builtin:sphere");
  EXPECT_EQ(replay("builtin:sphere", R"({"events": [{"open": ")" + path("knot.ply").string() +
                                         R"("}, {"time": 0.1, )" + shot("b.png") + "}]}"),
            "");
  EXPECT_TRUE(same_pixels(png("b.png"), rendered("knot.ply", "b", "120x90")));
  EXPECT_EQ(title, path("knot.ply").string());
}

TEST_F(MeshViewerTest, RefusedOptionsLeaveThePicture) {
  EXPECT_TRUE(holds(replay("builtin:sphere", R"({"events": [{"options": "--shader nonsense"},
      {"time": 0.1, )" + shot("a.png") + "}]}"),
                    "nonsense"));
  EXPECT_TRUE(same_pixels(png("a.png"), rendered("builtin:sphere", "a", "120x90")));
}

TEST_F(MeshViewerTest, RecordedKeysAreAPath) {
  EXPECT_EQ(replay("builtin:teapot", R"({"events": [{"key": "right"}]})"), "");
  Shown subject(arguments("builtin:teapot"));
  subject->record(path("p.json"));
  subject->handle({.kind = Event::Kind::key_down, .key = "d"});
  subject->advance(1);
  subject->record(path("p.json"));
  const auto p = cli::read_path(path("p.json"), Camera{});
  EXPECT_EQ(p.last_s(), 2);
  EXPECT_EQ(p.at(2).eye, subject->control().camera().eye);
  EXPECT_NE(p.at(0).eye, p.at(2).eye);
}

TEST_F(MeshViewerTest, ScriptsWithMistakesNameThePlace) {
  const auto expect = [&](const std::string& script, const std::string& words) {
    SCOPED_TRACE(script);
    const std::string said =
        refusal_of([&] { replay("builtin:sphere", script); }, Errc::bad_format);
    EXPECT_TRUE(holds(said, "script.json"));
    EXPECT_TRUE(holds(said, words));
  };
  expect("{}", "needs keys");
  expect(R"({"events": [{"key": "hyper"}]})", "events[0]: key: there is no key 'hyper'");
  expect(R"({"events": [{"time": 1}]})", "events[0]: the step does nothing");
  expect(R"({"events": [{"time": 1, "key": "w"}, {"time": 0, "key": "w"}]})", "events[1]: time");
  expect(R"({"events": [{"button_down": "fourth"}]})", "expected left, middle or right");
  expect(R"({"events": [{"size": [0, 5]}]})", "events[0]: size");
  expect(R"({"events": [{"presss": "w"}]})", "unknown name 'presss'");
  expect(R"({"fps": 0, "events": [{"key": "w"}]})", "fps");
  expect(R"({"keys": [{"fov": 999}]})", "keys[0]: fov");
}

}  // namespace
}  // namespace rastrum::test::window_mesh_test
