// SPDX-License-Identifier: BSD-3-Clause
#include "script.hpp"

#include <algorithm>

#include <rastrum/error.hpp>

#include "job/json_file.hpp"

namespace rastrum::cli::window {
namespace {

Button read_button(const JsonFields& fields, const char* name, const std::string& text) {
  if (text == "left") return Button::left;
  if (text == "middle") return Button::middle;
  if (text == "right") return Button::right;
  fields.fail(name, "expected left, middle or right, got '" + text + "'");
}

void check_key(const JsonFields& fields, const char* name, const std::string& key,
               std::span<const KeyHelp> keys) {
  std::string known;
  for (const KeyHelp& help : keys) {
    if (help.has(key)) return;
    known.append(known.empty() ? "" : ", ").append(help.keys);
  }
  fields.fail(name, "there is no key '" + key + "' here; known: " + known);
}

/// One object may hold several actions, in the order below.
void read_step(const JsonFields::Element& element, std::span<const KeyHelp> keys, Script& script) {
  JsonFields fields(*element.value, element.place);
  const double before = script.steps.empty() ? 0 : script.steps.back().time_s;
  const double time_s = fields.number("time").value_or(before);
  if (time_s < before) fields.fail("time", "must not be less than the time of the step before");
  const std::size_t first = script.steps.size();
  const auto add = [&](auto action) { script.steps.push_back({time_s, std::move(action)}); };

  Event event;
  event.shift = fields.boolean("shift").value_or(false);
  event.ctrl = fields.boolean("ctrl").value_or(false);
  if (const auto at = fields.numbers("at", 2)) {
    event.x = (*at)[0];
    event.y = (*at)[1];
  }
  const auto key = [&](const char* name, bool down, bool up) {
    const auto k = fields.text(name);
    if (!k) return;
    check_key(fields, name, *k, keys);
    event.key = *k;
    event.kind = Event::Kind::key_down;
    if (down) add(event);
    event.kind = Event::Kind::key_up;
    if (up) add(event);
  };
  const auto button = [&](const char* name, Event::Kind kind) {
    const auto b = fields.text(name);
    if (!b) return;
    event.button = read_button(fields, name, *b);
    event.kind = kind;
    add(event);
  };
  key("key", true, true);
  key("key_down", true, false);
  key("key_up", false, true);
  button("button_down", Event::Kind::button_down);
  if (const auto to = fields.numbers("move", 2)) {
    event.kind = Event::Kind::move;
    event.x = (*to)[0];
    event.y = (*to)[1];
    add(event);
  }
  button("button_up", Event::Kind::button_up);
  if (const auto notches = fields.number("wheel")) {
    event.kind = Event::Kind::wheel;
    event.y = *notches;
    add(event);
  }
  if (const auto line = fields.text("options")) add(Script::Options{*line});
  if (const auto file = fields.text("open")) add(Script::Open{*file});
  if (const auto size = fields.numbers("size", 2)) {
    for (const double s : *size)
      if (!(s >= 1 && s <= kMaxImageSize))
        fields.fail("size", "expected [width, height] from 1 to 32768");
    add(Script::Size{static_cast<int>((*size)[0]), static_cast<int>((*size)[1])});
  }
  if (const auto file = fields.text("screenshot")) add(Script::Screenshot{*file});
  if (fields.boolean("quit").value_or(false)) add(Script::Quit{});
  fields.finish();
  if (script.steps.size() == first) fields.fail("the step does nothing");
}

}  // namespace

Script read_script(const std::filesystem::path& file, std::span<const KeyHelp> keys) {
  const nlohmann::ordered_json json = read_json(file);
  JsonFields fields(json, file.string());
  Script script;
  script.fps = fields.number("fps").value_or(script.fps);
  if (!(script.fps > 0 && script.fps <= 1000)) fields.fail("fps", "must lie in 0 to 1000");
  if (fields.has("keys")) script.path = file;
  static_cast<void>(fields.has("interpolation"));
  for (const JsonFields::Element& element : fields.array("events"))
    read_step(element, keys, script);
  fields.finish();
  if (!script.path && script.steps.empty())
    fields.fail("needs keys (a camera path), events, or both");
  return script;
}

Replay::Replay(Script script, Viewer& viewer) : script_(std::move(script)), viewer_(viewer) {
  if (script_.path) path_s_ = viewer_.subject().follow(*script_.path);
}

bool Replay::finished() const {
  const double now = static_cast<double>(frame_) / script_.fps;
  return quit_ ||
         (next_ == script_.steps.size() && (!path_s_ || now > path_s_->second - path_s_->first));
}

void Replay::perform(const Script::Step& step) {
  // Each action settles before the next, so that a screenshot shows the earlier ones.
  if (const auto* event = std::get_if<Event>(&step.action)) return viewer_.handle(*event);
  if (const auto* options = std::get_if<Script::Options>(&step.action))
    viewer_.set_options(options->line);
  else if (const auto* open = std::get_if<Script::Open>(&step.action))
    viewer_.open(open->file);
  else if (const auto* shot = std::get_if<Script::Screenshot>(&step.action))
    viewer_.screenshot(shot->file);
  else if (const auto* size = std::get_if<Script::Size>(&step.action))
    resize(size->width, size->height);
  else
    quit_ = true;
  viewer_.settle();
}

void Replay::resize(int width, int height) {
  viewer_.resize(width, height);
  size_.emplace(width, height);
}

void Replay::step() {
  const double now = static_cast<double>(frame_) / script_.fps;
  if (path_s_) viewer_.subject().go_to(std::min(path_s_->first + now, path_s_->second));
  // Rounding of frame times: a step at 0.1 s is frame 6 of sixty per second.
  const double due = now + 1e-9;
  while (!quit_ && next_ < script_.steps.size() && script_.steps[next_].time_s <= due)
    perform(script_.steps[next_++]);
  viewer_.settle();
  if (quit_) return;
  viewer_.advance(1 / script_.fps);
  ++frame_;
}

}  // namespace rastrum::cli::window
