// Meshes in the window: the scene, its options and its camera.
#pragma once

#include <memory>
#include <vector>

#include <rastrum/family.hpp>

#include "camera_path.hpp"
#include "mesh_control.hpp"
#include "scene_options.hpp"
#include "subject.hpp"

namespace rastrum::cli::window {

/// A scene with what is known about it; stays where it is, since the binding points into it.
struct LoadedScene {
  explicit LoadedScene(Inputs inputs)
      : scene(std::move(inputs.scene)),
        has_materials(inputs.has_materials),
        binding(scene),
        sphere(bounding_sphere(binding.view())) {}
  LoadedScene(const LoadedScene&) = delete;
  LoadedScene& operator=(const LoadedScene&) = delete;

  Scene scene;
  bool has_materials;  ///< of files
  SceneBinding binding;
  BoundingSphere sphere;
};

/// Reads the inputs of `a`, with their normals. Throws Error, UsageError.
[[nodiscard]] std::shared_ptr<const LoadedScene> load_scene(const SceneArguments& a);

class MeshSubject final : public Subject {
 public:
  /// What the panel changes. Width, height and whatever it does not show stay as the command line
  /// had them.
  struct Settings {
    family::Options render;
    bool heat_map = false;  ///< fragments at each pixel instead of the picture
  };

  /// Throws UsageError where the camera options do not fit the scene.
  MeshSubject(SceneArguments arguments, std::shared_ptr<const LoadedScene> scene);
  ~MeshSubject() override;

  [[nodiscard]] const Settings& settings() const { return settings_; }
  void set(Settings settings);
  [[nodiscard]] MeshControl& control() { return control_; }

  void handle(const Event& event) override;
  void advance(double dt_s) override { control_.advance(dt_s); }
  void resize(int width, int height) override;
  [[nodiscard]] bool moving() const override { return control_.moving(); }
  [[nodiscard]] std::uint64_t version() const override;
  [[nodiscard]] std::function<Drawn()> draw(int width, int height) override;
  [[nodiscard]] std::function<std::string()> pick(int x, int y, int width, int height) override;
  [[nodiscard]] Worker::Job open(const std::filesystem::path& file) override;
  void set_options(const std::string& options) override;
  void write_camera(const std::filesystem::path& file) const override;
  void record(const std::filesystem::path& file) override;
  std::pair<double, double> follow(const std::filesystem::path& file) override;
  void go_to(double time_s) override;
  [[nodiscard]] std::string title() const override;
  [[nodiscard]] std::vector<KeyHelp> keys() const override;
  /// The keys that change options.
  [[nodiscard]] static std::span<const KeyHelp> command_keys();

 private:
  class Painter;  // of the worker's thread
  /// The options of a picture.
  [[nodiscard]] family::Options options_for(int width, int height) const;
  void show(SceneArguments arguments, std::shared_ptr<const LoadedScene> scene);
  /// What `key` stands for becomes the next one, with `back` the one before.
  void change(char key, bool back);

  SceneArguments arguments_;
  std::shared_ptr<const LoadedScene> scene_;
  MeshControl control_;
  int width_ = 1, height_ = 1;  ///< of the window
  Settings settings_;
  std::uint64_t settings_version_ = 1;
  std::uint64_t base_version_ = 0;  ///< so that a new control's versions are new numbers, too
  std::shared_ptr<Painter> painter_;
  std::optional<CameraPath> path_;
  std::vector<PathKey> recorded_;
};

}  // namespace rastrum::cli::window
