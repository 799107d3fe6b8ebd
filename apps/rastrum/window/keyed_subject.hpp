// SPDX-License-Identifier: BSD-3-Clause
// The base of subjects: a control moves the camera, a panel changes the settings, and path files
// hold the camera in keys.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "job/camera_path.hpp"
#include "job/terrain_path.hpp"
#include "subject.hpp"

namespace rastrum::cli::window {

/// `Key`: of a path (read_path, write_path).
template <class Control, class SettingsOfPanel, class Key>
class KeyedSubject : public Subject {
 public:
  using Settings = SettingsOfPanel;

  [[nodiscard]] const Settings& settings() const { return settings_; }
  void set(Settings settings) {
    settings_ = std::move(settings);
    ++settings_version_;
  }
  [[nodiscard]] Control& control() { return control_; }

  void resize(int width, int height) override {
    width_ = width;
    height_ = height;
    control_.resize(width, height);
  }
  [[nodiscard]] bool moving() const override { return control_.moving(); }
  [[nodiscard]] std::uint64_t version() const override {
    return settings_version_ + control_.version();
  }
  void write_camera(const std::filesystem::path& file) const override {
    const Key key = key_now();
    write_path(file, {&key, 1});
  }
  void record(const std::filesystem::path& file) override {
    std::vector<Key> keys = recorded_;
    keys.push_back(key_of_path(static_cast<double>(keys.size()) * kRecordStep_s));
    write_path(file, keys);
    recorded_ = std::move(keys);
  }
  std::pair<double, double> follow(const std::filesystem::path& file) override {
    path_ = read_path(file, key_now().camera);
    return {path_->first_s(), path_->last_s()};
  }
  [[nodiscard]] std::vector<KeyHelp> keys() const override {
    std::vector<KeyHelp> all(Control::keys().begin(), Control::keys().end());
    all.insert(all.end(), commands_.begin(), commands_.end());
    return all;
  }

 protected:
  /// `commands`: the keys that change settings; of static storage.
  KeyedSubject(Control control, Settings settings, std::span<const KeyHelp> commands)
      : control_(std::move(control)), settings_(std::move(settings)), commands_(commands) {}

  /// The camera as it is: by itself, to be drawn again bit by bit, and as a key of a path.
  [[nodiscard]] virtual Key key_now() const = 0;
  [[nodiscard]] virtual Key key_of_path(double time_s) const = 0;
  [[nodiscard]] bool is_command(const Event& event) const {
    return event.kind == Event::Kind::key_down && !event.ctrl &&
           std::ranges::any_of(commands_, [&](const KeyHelp& k) { return k.has(event.key); });
  }

  Control control_;
  Settings settings_;
  int width_ = 1, height_ = 1;  ///< of the window, px
  std::uint64_t settings_version_ = 1;
  std::optional<KeyedPath<Key>> path_;

 private:
  std::span<const KeyHelp> commands_;
  std::vector<Key> recorded_;
};

}  // namespace rastrum::cli::window
