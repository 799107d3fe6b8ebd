// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <rastrum/family.hpp>

#include "job/camera_path.hpp"
#include "job/inputs.hpp"
#include "keyed_subject.hpp"
#include "mesh_control.hpp"
#include "mesh_settings.hpp"
#include "parse/scene_options.hpp"

namespace rastrum::cli::window {

/// A scene and its properties. It cannot move, because the binding points into it.
struct LoadedScene {
  explicit LoadedScene(Inputs inputs);
  LoadedScene(const LoadedScene&) = delete;
  LoadedScene& operator=(const LoadedScene&) = delete;

  /// Shows these numbers, or none. `version` must change with `scalars`. Call it on the thread that
  /// draws. Throws Error for a name that the scene lacks.
  void show(const ScalarOptions& scalars, std::uint64_t version);

  Scene scene;
  bool has_materials;  ///< of files
  SceneBinding binding;
  BoundingSphere sphere;
  Bounds box;
  std::vector<ScalarSummary> scalars;  ///< that can be shown; those of every scene last

 private:
  std::uint64_t shown_ = 0;
};

/// Throws Error, UsageError.
[[nodiscard]] std::shared_ptr<LoadedScene> load_scene(const SceneArguments& a);

class MeshSubject final : public KeyedSubject<MeshControl, MeshSettings, PathKey> {
 public:
  /// Throws UsageError if the camera options do not fit the scene.
  MeshSubject(SceneArguments arguments, std::shared_ptr<LoadedScene> scene);
  ~MeshSubject() override;

  [[nodiscard]] const LoadedScene& scene() const { return *scene_; }
  [[nodiscard]] Texts same_picture(int width, int height, const std::string& png) const override;

  void handle(const Event& event) override;
  void advance(double dt_s) override { control_.advance(dt_s); }
  [[nodiscard]] std::uint64_t version() const override;
  [[nodiscard]] std::function<Drawn()> draw(int width, int height, bool glance) override;
  [[nodiscard]] bool has_glances() const override;
  [[nodiscard]] std::function<Picked()> pick(int x, int y, int width, int height) override;
  [[nodiscard]] Worker::Job open(const std::filesystem::path& file) override;
  void set_options(const std::string& options) override;
  void go_to(double time_s) override;
  [[nodiscard]] std::string title() const override;
  [[nodiscard]] static std::span<const KeyHelp> command_keys();

 private:
  class Painter;  // of the worker's thread
  [[nodiscard]] PathKey key_now() const override { return {0, control_.camera(), true}; }
  /// Planes between the keys are found for each picture.
  [[nodiscard]] PathKey key_of_path(double time_s) const override {
    return {time_s, control_.camera(), false};
  }
  [[nodiscard]] family::Options options_for(int width, int height) const;
  void show(SceneArguments arguments, std::shared_ptr<LoadedScene> scene);
  /// Switches the option of `key` to its next value, or with `back` to the one before.
  void change(char key, bool back);

  SceneArguments arguments_;
  std::shared_ptr<LoadedScene> scene_;
  std::uint64_t base_version_ = 0;  ///< so that a new control's versions are new, too
  std::shared_ptr<Painter> painter_;
};

}  // namespace rastrum::cli::window
