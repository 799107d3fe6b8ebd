// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <rastrum/terrain.hpp>

#include "job/terrain_path.hpp"
#include "keyed_subject.hpp"
#include "parse/ground_options.hpp"
#include "parse/terrain_options.hpp"
#include "terrain_control.hpp"

namespace rastrum::cli::window {

/// Settings of the panel, beside the pose.
struct TerrainSettings {
  TerrainLook options;
  terrain::Light light;
  bool sky_dims = true;
  GroundShown shown{};
  /// sun, headlight or studio; empty: as on the command line.
  std::string lights{};
  std::uint64_t said = 0;  ///< changes with the words of `shown`

  /// `shown.frame` with these lights; without any the sun shines.
  [[nodiscard]] FrameOptions frame() const;
};

class TerrainSubject final : public KeyedSubject<TerrainControl, TerrainSettings, TerrainPathKey> {
 public:
  /// F1 goes through `maps`, at least one; the first is read here. `arguments.input` is not used.
  /// Throws Error, UsageError.
  TerrainSubject(const TerrainSceneArguments& arguments, const GroundShown& shown,
                 std::vector<TerrainInput> maps);
  ~TerrainSubject() override;

  void next_map();

  void handle(const Event& event) override;
  void advance(double dt_s) override;
  /// Places the camera at angles that a command line can express.
  void place(const TerrainPose& pose);
  [[nodiscard]] Texts same_picture(int width, int height, const std::string& png) const override;
  [[nodiscard]] std::function<Drawn()> draw(int width, int height, bool glance) override;
  [[nodiscard]] std::function<Picked()> pick(int, int, int, int) override { return {}; }
  [[nodiscard]] Worker::Job open(const std::filesystem::path& file) override;
  void set_options(const std::string& options) override;
  void go_to(double time_s) override;
  [[nodiscard]] std::string title() const override;
  [[nodiscard]] static std::span<const KeyHelp> command_keys();

 private:
  class Stage;  // of the worker's thread
  [[nodiscard]] TerrainPathKey key_now() const override { return key_of_path(0); }
  [[nodiscard]] TerrainPathKey key_of_path(double time_s) const override {
    return {time_s, control_.pose().camera};
  }
  void change(std::string_view key, bool back);

  std::vector<TerrainInput> maps_;
  std::size_t map_ = 0;
  std::shared_ptr<Stage> stage_;
};

}  // namespace rastrum::cli::window
