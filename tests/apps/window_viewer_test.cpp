// SPDX-License-Identifier: BSD-3-Clause
// The session of the window without a window: resolution while moving, screenshots, files, errors.
#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>

#include <rastrum/error.hpp>
#include <rastrum/stop.hpp>

#include "program.hpp"
#include "window/viewer.hpp"

namespace rastrum::test::window_viewer_test {
namespace {

using namespace cli::window;
using Picture = cli::window::Drawn;  // program.hpp also has a Drawn

/// Draws one colour row by row at a chosen speed. A row is its unit of work.
class FakeSubject final : public Subject {
 public:
  void handle(const Event& event) override {
    if (event.kind != Event::Kind::key_down && event.kind != Event::Kind::key_up) return;
    is_moving = event.kind == Event::Kind::key_down;
    ++version_;
  }
  void advance(double) override { version_ += is_moving; }
  void resize(int, int) override {}
  [[nodiscard]] bool moving() const override { return is_moving; }
  [[nodiscard]] std::uint64_t version() const override { return version_; }
  [[nodiscard]] bool has_glances() const override { return glances; }
  [[nodiscard]] std::function<Picture()> draw(int width, int height, bool glance) override {
    return [this, width, height, glance]() -> Picture {
      if (refuse) throw Error(Errc::invalid_argument, "these options do not fit");
      Picture d{Image<Rgba8>(width, height), true, {}};
      for (int row = 0; row < height; ++row) {
        if (width == hold_width && row == kHoldRow) hold();
        throw_if_stopped();
        if (width == hold_width) ++*rows;
      }
      d.figures.frame_ms = ms_a_pixel * width * height * (glances && !glance ? 100 : 1);
      ++pictures;
      seen_glances += glance;
      return d;
    };
  }
  [[nodiscard]] std::function<Picked()> pick(int x, int y, int width, int height) override {
    if (!picks) return {};
    return [=, this]() -> Picked {
      ++looks;
      if (hold_picks) {
        hold();
        throw_if_stopped();
      }
      if (x == 0) return {};
      return {"",
              std::to_string(x) + "," + std::to_string(y) + " of " + std::to_string(width) + "x" +
                  std::to_string(height),
              ""};
    };
  }
  [[nodiscard]] Worker::Job open(const std::filesystem::path& file) override {
    return [this, file]() -> Worker::Done {
      if (file == "bad") throw Error(Errc::bad_format, "bad: is spoilt");
      return [this] { ++version_; };
    };
  }
  void set_options(const std::string& options) override {
    if (options == "bad") throw Error(Errc::invalid_argument, "no such option");
    ++version_;
  }
  void write_camera(const std::filesystem::path& file) const override {
    std::ofstream(file) << "camera";
  }
  void record(const std::filesystem::path&) override {}
  std::pair<double, double> follow(const std::filesystem::path&) override { return {0, 0}; }
  void go_to(double) override {}
  [[nodiscard]] std::string title() const override { return "fake"; }
  [[nodiscard]] std::vector<KeyHelp> keys() const override { return {{"w", "move"}}; }

  bool is_moving = false, refuse = false, picks = true;
  double ms_a_pixel = 1;
  bool glances = false;  ///< glances take a hundredth of the time
  int pictures = 0, seen_glances = 0;
  std::atomic<int> looks = 0;
  std::atomic<bool> hold_picks = false;

  /// Pictures of this width wait in the middle, until they are released or stopped.
  static constexpr int kHoldRow = 2;
  std::atomic<int> hold_width = -1;
  std::atomic<int>* rows = nullptr;  ///< of those pictures; outlives the subject
  std::atomic<bool> held = false, let_go = false;

 private:
  void hold() {
    held = true;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!let_go && !stop_requested() && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    let_go = true;
  }

  std::uint64_t version_ = 1;
};

Event press(const char* name, Event::Kind kind = Event::Kind::key_down) {
  return {.kind = kind, .key = name};
}
Event mouse(Event::Kind kind, double x, double y) {
  return {.kind = kind, .x = x, .y = y};
}

class ViewerTest : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    auto owned = std::make_unique<FakeSubject>();
    subject = owned.get();
    subject->rows = &rows;
    ViewerOptions options{.width = 64,
                          .height = 32,
                          .screenshots = cli::NumberedName("", path("shot_%02d.png").string())};
    viewer = std::make_unique<Viewer>(std::move(owned), options);
  }
  void TearDown() override {
    viewer.reset();
    Program::TearDown();
  }
  /// Runs the window's loop without its clock.
  void run_for(double seconds) {
    constexpr double kStep = 0.01;
    for (double t = 0; t < seconds; t += kStep) {
      viewer->advance(kStep);
      viewer->update();
      for (int i = 0; i < 200 && !viewer->update(); ++i)
        std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  }
  /// The same without waiting for each picture, until all is done.
  void rest_for(double seconds) {
    constexpr double kStep = 0.01;
    const auto step = [&] {
      viewer->advance(kStep);
      viewer->update();
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    };
    for (double t = 0; t < seconds; t += kStep) step();
    for (int i = 0; i < 20000 && viewer->busy(); ++i) step();
  }
  /// Runs until a picture is held in its middle.
  void run_until_held() {
    for (int i = 0; i < 20000 && !subject->held; ++i) run_for(0.01);
    ASSERT_TRUE(subject->held);
    rows = 0;
  }
  /// Updates until the current picture is finished or given up.
  void finish_picture() {
    viewer->update();
    subject->let_go = true;
    while (!viewer->update()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::atomic<int> rows = 0;
  FakeSubject* subject = nullptr;
  std::unique_ptr<Viewer> viewer;
};

TEST_F(ViewerTest, FewerPixelsWhileMovingAllWhenStill) {
  subject->ms_a_pixel = 400.0 / (64 * 32);  // 25 ms with a quarter of the side
  run_for(0.5);
  EXPECT_EQ(viewer->picture()->image.width(), 64);
  viewer->handle(press("w"));
  run_for(0.5);
  EXPECT_EQ(viewer->picture()->image.width(), 16);
  EXPECT_EQ(viewer->picture()->image.height(), 8);
  viewer->handle(press("w", Event::Kind::key_up));
  run_for(0.05);
  EXPECT_EQ(viewer->picture()->image.width(), 16);
  run_for(0.5);
  EXPECT_EQ(viewer->picture()->image.width(), 64);
  EXPECT_FALSE(viewer->busy());
  const int pictures = subject->pictures;
  run_for(0.2);
  EXPECT_EQ(subject->pictures, pictures) << "nothing has changed, nothing is drawn";
}

// A whole picture takes a second, a glance 10 ms: no whole one is drawn while the view moves.
TEST_F(ViewerTest, AMovingViewIsDrawnInGlances) {
  subject->glances = true;
  subject->ms_a_pixel = 10.0 / (64 * 32);
  run_for(0.5);
  EXPECT_TRUE(viewer->is_full());
  const auto whole = [&] { return subject->pictures - subject->seen_glances; };
  EXPECT_EQ(whole(), 1);
  viewer->handle(press("w"));
  run_for(0.5);
  EXPECT_EQ(viewer->picture()->image.width(), 64) << "all pixels can be had";
  EXPECT_FALSE(viewer->is_full());
  EXPECT_EQ(whole(), 1);
  viewer->handle(press("p"));
  run_for(0.1);
  EXPECT_TRUE(files().empty()) << "no picture of a glance";
  viewer->handle(press("w", Event::Kind::key_up));
  run_for(0.5);
  EXPECT_EQ(whole(), 2);
  EXPECT_TRUE(viewer->is_full());
  EXPECT_EQ(files().size(), 2U);
  EXPECT_FALSE(viewer->busy());
  viewer->set_adaptive(false);
  const int glances = subject->seen_glances;
  viewer->handle(press("w"));
  run_for(0.2);
  EXPECT_EQ(subject->seen_glances, glances);
}

TEST_F(ViewerTest, WithoutAdaptionEveryPictureIsFull) {
  subject->ms_a_pixel = 1;
  viewer->set_adaptive(false);
  viewer->handle(press("w"));
  for (int i = 0; i < 20; ++i) {
    run_for(0.01);
    if (viewer->picture() != nullptr) {
      EXPECT_EQ(viewer->picture()->image.width(), 64);
    }
  }
  EXPECT_NE(viewer->picture(), nullptr);
}

TEST_F(ViewerTest, AResizeIsANewPicture) {
  run_for(0.5);
  viewer->resize(100, 50);
  run_for(0.5);
  EXPECT_EQ(viewer->picture()->image.width(), 100);
  EXPECT_EQ(viewer->picture()->image.height(), 50);
}

TEST_F(ViewerTest, ErrorsAreShownAndThePictureStays) {
  run_for(0.5);
  const Picture* const before = viewer->picture();
  viewer->open("bad");
  viewer->settle();
  EXPECT_EQ(viewer->error(), "bad: is spoilt");
  EXPECT_EQ(viewer->picture(), before);
  viewer->set_options("bad");
  EXPECT_EQ(viewer->error(), "no such option");
  subject->refuse = true;
  viewer->set_options("refused");
  viewer->settle();
  EXPECT_EQ(viewer->error(), "these options do not fit");
  EXPECT_EQ(viewer->picture(), before);
  run_for(0.2);
  EXPECT_FALSE(viewer->busy()) << "tried again without end";
  subject->refuse = false;
  viewer->set_options("good");
  viewer->settle();
  EXPECT_EQ(viewer->error(), "");
  EXPECT_NE(viewer->picture(), before);
}

TEST_F(ViewerTest, ScreenshotsAreFullAndNumbered) {
  subject->ms_a_pixel = 1;
  run_for(0.5);
  viewer->handle(press("w"));
  run_for(0.3);
  ASSERT_LT(viewer->picture()->image.width(), 64);
  viewer->handle(press("p"));
  viewer->handle(press("p"));
  run_for(0.1);
  EXPECT_TRUE(files().empty()) << "no picture of a moving view with fewer pixels";
  viewer->handle(press("w", Event::Kind::key_up));
  run_for(1);
  EXPECT_EQ(files(), (Args("shot_00.json shot_00.png shot_01.json shot_01.png")));
  EXPECT_EQ(png("shot_01.png").width(), 64);
  EXPECT_FALSE(viewer->busy());
}

TEST_F(ViewerTest, AScreenshotThatCannotBeWrittenIsAnError) {
  viewer->screenshot(path("no/such/folder.png"));
  viewer->settle();
  EXPECT_NE(viewer->error(), "");
  subject->refuse = true;
  viewer->set_options("refused");
  viewer->screenshot(path("a.png"));
  viewer->settle();
  EXPECT_TRUE(files().empty());
  EXPECT_TRUE(holds(viewer->notice(), "a.png is not written"));
}

// The bound is in work: the full picture gets no further row, and the preview's rows come next.
TEST_F(ViewerTest, AFullPictureIsGivenUpWhenTheViewMoves) {
  subject->hold_width = 64;
  run_until_held();
  EXPECT_LT(viewer->picture()->image.width(), 64) << "a coarse one is there already";
  const std::uint64_t serial = viewer->serial();
  viewer->handle(press("w"));
  finish_picture();
  EXPECT_EQ(rows, 0) << "of the full picture, after the key";
  EXPECT_EQ(viewer->serial(), serial);
  subject->hold_width = -1;
  run_for(0.05);
  EXPECT_GT(viewer->serial(), serial);
  EXPECT_EQ(viewer->picture()->image.width(), 8);
  viewer->handle(press("w", Event::Kind::key_up));
  run_for(1);
  EXPECT_EQ(viewer->picture()->image.width(), 64) << "and it is drawn once the view rests";
  EXPECT_EQ(viewer->error(), "");
}

TEST_F(ViewerTest, AFullPictureIsGivenUpForAFile) {
  subject->hold_width = 64;
  run_until_held();
  viewer->open("bad");
  finish_picture();
  EXPECT_EQ(rows, 0);
  subject->hold_width = -1;
  run_for(1);
  EXPECT_EQ(viewer->error(), "bad: is spoilt");
  EXPECT_EQ(viewer->picture()->image.width(), 64) << "the view has not changed after all";
}

TEST_F(ViewerTest, PicturesOfAMovingViewAreFinished) {
  run_for(0.5);
  viewer->handle(press("w"));
  run_for(0.1);
  subject->hold_width = viewer->picture()->image.width();
  run_until_held();
  const std::uint64_t serial = viewer->serial();
  viewer->advance(0.01);  // the view has moved on
  finish_picture();
  EXPECT_EQ(viewer->serial(), serial + 1) << "else there would be none while it moves";
}

TEST_F(ViewerTest, TheEndGivesUpWhatIsDrawn) {
  subject->hold_width = 64;
  run_until_held();
  viewer.reset();
  EXPECT_EQ(rows, 0) << "after the window was closed";
}

TEST_F(ViewerTest, AClickNamesWhatIsThere) {
  const auto from_to = [&](Event press, const Event& release) {
    press.kind = Event::Kind::button_down;
    viewer->handle(press);
    viewer->handle(mouse(Event::Kind::move, release.x, release.y));
    viewer->handle(release);
    viewer->settle();
  };
  const auto up = [](double x, double y) { return mouse(Event::Kind::button_up, x, y); };
  EXPECT_EQ(viewer->title(), "fake");
  from_to(up(20, 30), up(21, 29));
  EXPECT_EQ(viewer->title(), "fake: 20,30 of 64x32");
  from_to(up(5, 5), up(20, 5));  // a drag
  Event shifted = up(9, 9), right = up(9, 9);
  shifted.shift = true;
  right.button = Button::right;
  from_to(shifted, up(9, 9));
  from_to(right, right);
  viewer->handle(up(9, 9));       // of a press on the panel
  from_to(up(9, 32), up(9, 31));  // out of the picture
  viewer->settle();
  EXPECT_EQ(viewer->title(), "fake: 20,30 of 64x32");
  viewer->open("good");
  viewer->settle();
  EXPECT_EQ(viewer->title(), "fake");
  subject->picks = false;
  from_to(up(1, 1), up(1, 1));
  EXPECT_EQ(viewer->title(), "fake");
}

TEST_F(ViewerTest, AnythingUnderAPointerThatRestsIsNamed) {
  const auto seen = [&] { return viewer->hovered() == nullptr ? "" : viewer->hovered()->what; };
  const auto move = [&](double x, double y) { viewer->handle(mouse(Event::Kind::move, x, y)); };
  rest_for(0.5);
  move(20, 30);
  EXPECT_TRUE(viewer->busy());
  run_for(0.1);
  EXPECT_EQ(subject->looks, 0) << "it may go on";
  rest_for(0.5);
  EXPECT_EQ(seen(), "20,30 of 64x32");
  EXPECT_EQ(subject->looks, 1);
  EXPECT_FALSE(viewer->busy());
  move(20.4, 30.3);
  EXPECT_EQ(seen(), "20,30 of 64x32") << "the same pixel";
  move(21, 30);
  EXPECT_EQ(seen(), "");
  rest_for(0.5);
  EXPECT_EQ(seen(), "21,30 of 64x32");

  // Never while a picture is wanted.
  viewer->handle(press("w"));
  EXPECT_EQ(seen(), "");
  run_for(0.3);
  EXPECT_EQ(subject->looks, 2);
  viewer->handle(press("w", Event::Kind::key_up));
  rest_for(1);
  EXPECT_EQ(seen(), "21,30 of 64x32");
  EXPECT_EQ(subject->looks, 3);

  viewer->handle(mouse(Event::Kind::button_down, 21, 30));
  rest_for(1);
  EXPECT_EQ(seen(), "") << "a drag";
  viewer->handle(mouse(Event::Kind::button_up, 21, 30));
  rest_for(1);
  EXPECT_EQ(seen(), "21,30 of 64x32");
  for (const auto& [x, y] : {std::pair{0, 5}, {-1, 5}, {64, 5}, {5, 32}}) {
    move(x, y);
    rest_for(1);
    EXPECT_EQ(seen(), "") << "nothing is at " << x << ", " << y;
    EXPECT_FALSE(viewer->busy());
  }
  move(5, 5);
  viewer->point_nowhere();
  rest_for(0.5);
  EXPECT_EQ(seen(), "");
  move(5, 5);
  viewer->set_hovers(false);
  rest_for(0.5);
  EXPECT_EQ(seen(), "");
  subject->picks = false;
  viewer->set_hovers(true);
  rest_for(0.5);
  EXPECT_EQ(seen(), "");
  EXPECT_FALSE(viewer->busy()) << "asked again without end";
}

TEST_F(ViewerTest, ALookIsGivenUpWhenTheViewMoves) {
  rest_for(0.5);
  subject->hold_picks = true;
  viewer->handle(mouse(Event::Kind::move, 20, 30));
  for (int i = 0; i < 20000 && !subject->held; ++i) {
    viewer->advance(0.01);
    viewer->update();
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
  ASSERT_TRUE(subject->held);
  const std::uint64_t serial = viewer->serial();
  viewer->handle(press("w"));
  viewer->update();
  // Nobody releases it: it waits until it is stopped.
  while (!viewer->update()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  subject->hold_picks = false;
  run_for(0.05);
  EXPECT_GT(viewer->serial(), serial);
  EXPECT_EQ(viewer->hovered(), nullptr);
  viewer->handle(press("w", Event::Kind::key_up));
  rest_for(1);
  EXPECT_NE(viewer->hovered(), nullptr) << "and it is looked up once the view rests";
  EXPECT_EQ(viewer->error(), "");
}

TEST_F(ViewerTest, EndsWhileAPictureIsDrawn) {
  viewer->advance(0);
  viewer->update();
  viewer.reset();  // waits for the thread and ignores the picture
}

}  // namespace
}  // namespace rastrum::test::window_viewer_test
