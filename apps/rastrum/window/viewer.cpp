// SPDX-License-Identifier: BSD-3-Clause
#include "viewer.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/stop.hpp>

#include "parse/arguments.hpp"

namespace rastrum::cli::window {
namespace {

constexpr double kRest_s = 0.15;       ///< without change, before the full picture is drawn
constexpr std::size_t kHistory = 120;  ///< frame times that are kept
constexpr double kHover_s = 0.2;       ///< of a resting pointer, before its pixel is looked up
constexpr double kClick_px = 3;        ///< of shaking between press and release

constexpr KeyHelp kViewerKeys[] = {{"p", "screenshot, with its camera as a path file"},
                                   {"k", "add the camera to a path that render --path draws"},
                                   {"ctrl+c", "copy the command line that draws this picture"},
                                   {"shift+ctrl+c", "copy the Python code that draws this picture"},
                                   {"tab", "hide or show the panel"},
                                   {"ctrl+q", "quit"}};

int scaled(int size, std::size_t step) {
  return std::max(static_cast<int>(size * kScales[step] + 0.5), 1);
}

}  // namespace

Viewer::Viewer(std::unique_ptr<Subject> subject, ViewerOptions options)
    : subject_(std::move(subject)), options_(std::move(options)), resolution_(options_.target_ms) {
  subject_->resize(options_.width, options_.height);
}

Viewer::~Viewer() {
  drawing_.request_stop();
  look_stop_.request_stop();
}

std::string Viewer::title() const {
  return picked_.empty() ? subject_->title() : subject_->title() + ": " + picked_;
}

std::vector<KeyHelp> Viewer::keys() {
  return {std::begin(kViewerKeys), std::end(kViewerKeys)};
}

void Viewer::set_target(double ms) {
  options_.target_ms = ms;
  resolution_.set_target(ms);
}

void Viewer::handle(const Event& event) {
  if (event.kind == Event::Kind::key_down && !event.ctrl && event.key == "p")
    screenshot(free_name());
  else if (event.kind == Event::Kind::key_down && !event.ctrl && event.key == "k")
    record();
  else
    subject_->handle(event);
  follow_pointer(event);
  if (const auto at = clicked(event))
    pick(static_cast<int>(at->first), static_cast<int>(at->second));
}

std::optional<std::pair<double, double>> Viewer::clicked(const Event& event) {
  switch (event.kind) {
    case Event::Kind::button_down:
      press_.reset();
      if (event.button == Button::left && !event.shift) press_ = {event.x, event.y};
      break;
    case Event::Kind::move:
      if (press_ && std::max(std::abs(event.x - press_->first),
                             std::abs(event.y - press_->second)) > kClick_px)
        press_.reset();
      break;
    case Event::Kind::button_up:
      if (event.button == Button::left) return std::exchange(press_, std::nullopt);
      break;
    case Event::Kind::leave:
      press_.reset();
      break;
    default:
      break;
  }
  return std::nullopt;
}

void Viewer::pick(int x, int y) {
  if (x >= 0 && x < options_.width && y >= 0 && y < options_.height) pick_ = {x, y};
}

void Viewer::follow_pointer(const Event& event) {
  switch (event.kind) {
    case Event::Kind::move: {
      const std::pair at{static_cast<int>(std::floor(event.x)),
                         static_cast<int>(std::floor(event.y))};
      if (pointer_ == at) return;
      pointer_ = at;
      break;
    }
    case Event::Kind::button_down:
      pressed_ = true;
      break;
    case Event::Kind::button_up:
      pressed_ = false;
      break;
    case Event::Kind::leave:
      pressed_ = false;
      pointer_.reset();
      break;
    default:
      return;
  }
  rested_s_ = 0;
}

bool Viewer::is_under_pointer(const Look& look) const {
  return pointer_ && look.x == pointer_->first && look.y == pointer_->second &&
         look.view.same_view(now());
}

const Picked* Viewer::hovered() const {
  return hovers_ && !pressed_ && looked_ && is_under_pointer(*looked_) && looked_->picked.any()
             ? &looked_->picked
             : nullptr;
}

bool Viewer::has_pointer_news() const {
  return hovers_ && pointer_ && !pressed_ && !failed_ && pointer_->first >= 0 &&
         pointer_->first < options_.width && pointer_->second >= 0 &&
         pointer_->second < options_.height && !(looked_ && is_under_pointer(*looked_));
}

bool Viewer::wants_look() const {
  return has_pointer_news() && rested_s_ >= kHover_s && shown_.is_full() && shown_.same_view(now());
}

/// Cheap beside a frame, but it reads the whole scene. Any picture to draw stops it.
void Viewer::look() {
  looking_ = Look{now(), pointer_->first, pointer_->second};
  auto job = subject_->pick(looking_->x, looking_->y, options_.width, options_.height);
  if (!job) {
    looked_ = std::exchange(looking_, std::nullopt);
    return;
  }
  look_stop_ = {};
  submit(
      [this, job = std::move(job), stop = look_stop_.get_token()]() -> Worker::Done {
        try {
          const StopScope scope(stop);
          return [this, picked = job()] {
            looked_ = std::exchange(looking_, std::nullopt);
            looked_->picked = picked;
          };
        } catch (const Stopped&) {
          return [this] { looking_.reset(); };
        }
      },
      // The picture's own errors are shown; a second one would hide them.
      [this](const std::string&) { looked_ = std::exchange(looking_, std::nullopt); });
}

void Viewer::resize(int width, int height) {
  options_.width = std::clamp(width, 1, kMaxImageSize);
  options_.height = std::clamp(height, 1, kMaxImageSize);
  subject_->resize(options_.width, options_.height);
}

void Viewer::open(const std::filesystem::path& file) {
  opens_.push_back(file);
}

void Viewer::screenshot(const std::filesystem::path& file) {
  screenshots_.push_back(file);
}

void Viewer::set_options(const std::string& options) {
  try {
    subject_->set_options(options);
    error_.clear();
  } catch (const std::exception& e) {
    error_ = e.what();
  }
}

void Viewer::record() {
  try {
    if (recording_.empty()) recording_ = free_name().replace_extension(".path.json");
    subject_->record(recording_);
    notice_ = "key added to " + recording_.string();
  } catch (const std::exception& e) {
    error_ = e.what();
  }
}

std::string Viewer::copy(const std::string& ending) {
  for (const auto& [of, text] :
       subject_->same_picture(options_.width, options_.height, "picture.png"))
    if (of == ending) {
      notice_ = (ending == ".py" ? "copied Python" : "copied a command line") +
                std::string(" that draws this picture");
      return text;
    }
  return "";
}

std::filesystem::path Viewer::free_name() const {
  constexpr std::size_t kMost = 1000000;
  std::error_code ignored;
  for (std::size_t i = 0; i < kMost; ++i) {
    std::filesystem::path name = options_.screenshots.at(i);
    const bool asked =
        std::find(screenshots_.begin(), screenshots_.end(), name) != screenshots_.end();
    std::filesystem::path path_name = name;
    path_name.replace_extension(".path.json");
    if (!options_.screenshots.has_number() || (!asked && !std::filesystem::exists(name, ignored) &&
                                               !std::filesystem::exists(path_name, ignored)))
      return name;
  }
  return options_.screenshots.at(kMost);
}

void Viewer::advance(double dt_s) {
  subject_->advance(dt_s);
  const std::uint64_t version = subject_->version();
  const bool changed = version != seen_version_;
  seen_version_ = version;
  rested_s_ = changed ? 0 : rested_s_ + dt_s;
  still_s_ = changed || subject_->moving() ? 0 : still_s_ + dt_s;
}

Viewer::State Viewer::now() const {
  return {subject_->version(), options_.width, options_.height, 0, false};
}

bool Viewer::resting() const {
  return !options_.adaptive || (still_s_ >= kRest_s && seen_version_ == subject_->version());
}

std::optional<Viewer::State> Viewer::next() const {
  State wanted = now();
  if (!wanted.same_view(shown_)) {
    if (!options_.adaptive) return wanted;
    // With nothing drawn yet, a small one, which also measures this scene.
    wanted.step = resolution_.expected_ms(0) == 0 ? kScales.size() - 1 : resolution_.moving_step();
    wanted.glance = subject_->has_glances();
    return wanted;
  }
  if (shown_.is_full() || !resting()) return std::nullopt;
  if (options_.adaptive && shown_.step != 0) wanted.step = resolution_.still_step(shown_.step);
  wanted.glance = wanted.step != 0 && subject_->has_glances();
  return wanted;
}

bool Viewer::busy() const {
  return worker_.busy() || pick_ || !screenshots_.empty() || !opens_.empty() ||
         subject_->moving() || has_pointer_news() || next().has_value() ||
         (!shown_.is_full() && !resting());
}

void Viewer::submit(Worker::Job job, std::function<void(const std::string&)> failed) {
  worker_.submit([job = std::move(job), failed = std::move(failed)]() -> Worker::Done {
    std::string what;
    try {
      return job();
    } catch (const std::bad_alloc&) {
      what = "out of memory; try a smaller window or fewer samples";
    } catch (const std::exception& e) {
      what = e.what();
    }
    return [what, failed] { failed(what); };
  });
}

void Viewer::draw(const State& state) {
  std::function<Drawn()> drawing;
  const auto show_nothing_new = [this, state](const std::string& what) {
    draw_error_ = what;
    shown_ = state;  // not tried again until something changes
    shown_.step = 0;
    shown_.glance = false;
    failed_ = true;
  };
  try {
    drawing = subject_->draw(scaled(state.width, state.step), scaled(state.height, state.step),
                             state.glance);
  } catch (const std::exception& e) {
    show_nothing_new(e.what());
    return;
  }
  refining_.reset();
  if (state.same_view(shown_)) refining_ = state;
  drawing_ = {};
  // A whole picture's time says nothing about the glances of a moving view.
  const bool counts = state.glance || !subject_->has_glances();
  submit(
      [this, drawing = std::move(drawing), state, counts,
       stop = drawing_.get_token()]() -> Worker::Done {
        std::shared_ptr<const Drawn> drawn;
        try {
          const StopScope scope(stop);
          drawn = std::make_shared<const Drawn>(drawing());
        } catch (const Stopped&) {
          return [] {};
        }
        return [this, drawn, state, counts] {
          picture_ = drawn;
          shown_ = state;
          ++serial_;
          failed_ = false;
          draw_error_.clear();
          if (counts) resolution_.add(state.step, drawn->figures.frame_ms);
          if (history_ms_.size() == kHistory) history_ms_.erase(history_ms_.begin());
          history_ms_.push_back(static_cast<float>(drawn->figures.frame_ms));
        };
      },
      show_nothing_new);
}

void Viewer::write_screenshot(const std::filesystem::path& file) {
  try {
    subject_->write_camera(std::filesystem::path(file).replace_extension(".json"));
    for (const auto& [ending, text] :
         subject_->same_picture(options_.width, options_.height, file.filename().string())) {
      io::AtomicFile out(std::filesystem::path(file).replace_extension(ending));
      out.write(text.data(), text.size());
      out.commit();
    }
  } catch (const std::exception& e) {
    error_ = e.what();
    return;
  }
  submit(
      [this, file, picture = picture_]() -> Worker::Done {
        io::write_png(file, picture->image.view());
        return [this, file] { notice_ = "wrote " + file.string(); };
      },
      [this](const std::string& what) { error_ = what; });
}

bool Viewer::update() {
  const bool news = worker_.poll();
  if (worker_.busy()) {
    if (refining_ && (!refining_->same_view(now()) || !opens_.empty())) drawing_.request_stop();
    if (looking_ && (pressed_ || !opens_.empty() || pick_ || !is_under_pointer(*looking_)))
      look_stop_.request_stop();
    return news;
  }
  if (!opens_.empty()) {
    const std::filesystem::path file = opens_.front();
    opens_.erase(opens_.begin());
    notice_ = "reading " + file.string();
    submit(
        [this, file, job = subject_->open(file)]() -> Worker::Done {
          return [this, file, done = job()] {
            done();
            resolution_.forget();
            error_.clear();
            picked_.clear();
            notice_ = "showing " + file.string();
          };
        },
        [this](const std::string& what) { error_ = what; });
    return true;
  }
  if (const auto state = next()) {
    draw(*state);
    return true;
  }
  if (pick_) {
    const auto [x, y] = *std::exchange(pick_, std::nullopt);
    if (auto job = subject_->pick(x, y, options_.width, options_.height))
      submit(
          [this, job = std::move(job)]() -> Worker::Done {
            return [this, what = job().line()] { picked_ = what; };
          },
          [this](const std::string& what) { error_ = what; });
    return true;
  }
  if (!screenshots_.empty() && shown_.is_full()) {
    const std::filesystem::path file = screenshots_.front();
    screenshots_.erase(screenshots_.begin());
    if (failed_)
      notice_ = file.string() + " is not written: these options draw no picture";
    else
      write_screenshot(file);
    return true;
  }
  if (wants_look()) look();
  return news;
}

void Viewer::settle() {
  const bool adaptive = std::exchange(options_.adaptive, false);
  while (worker_.busy() || next() || pick_ || !opens_.empty() || !screenshots_.empty() ||
         wants_look()) {
    worker_.wait();
    update();
  }
  options_.adaptive = adaptive;
}

}  // namespace rastrum::cli::window
