// SPDX-License-Identifier: BSD-3-Clause
// The scenes and sizes of a peers' benchmark: `--scenes`, `--sizes`, `--quick`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <bench/options.hpp>
#include <bench/scenes.hpp>

namespace rastrum::bench {

struct Size {
  int width = 0, height = 0;
};

/// Throws Error{invalid_argument} unless `text` is WxH.
[[nodiscard]] Size parse_size(const std::string& text);
[[nodiscard]] std::string size_text(Size size);

class Selection {
 public:
  Selection(std::vector<SceneInfo> scenes, std::vector<Size> sizes)
      : scenes_(std::move(scenes)), sizes_(std::move(sizes)) {}

  /// Adds the options; call `resolve` once they are parsed.
  void add_to(OptionParser& parser);
  /// Replaces the defaults by what was asked for. Leaves out scenes whose files are absent, each
  /// with a line on stdout. If all files are absent, the procedural shapes join the scenes that
  /// were asked for. Throws Error{invalid_argument} for an invalid name or size.
  void resolve();

  /// Replaces the constructor's defaults.
  void set_sizes(std::vector<Size> sizes) { sizes_ = std::move(sizes); }
  void set_scenes(std::vector<SceneInfo> scenes) { scenes_ = std::move(scenes); }

  [[nodiscard]] const std::vector<SceneInfo>& scenes() const { return scenes_; }
  /// Selected scenes whose data is absent.
  [[nodiscard]] const std::vector<SceneInfo>& absent() const { return absent_; }
  [[nodiscard]] const std::vector<Size>& sizes() const { return sizes_; }

 private:
  std::vector<SceneInfo> scenes_, absent_;
  std::vector<Size> sizes_;
  std::vector<std::string> scene_names_, size_names_;
};

/// The options of a peers' benchmark.
struct PeerOptions {
  int rounds = 9, threads = 2;
  std::string json;

  /// Adds these options and the selection's to `parser`, parses, and resolves the selection.
  /// Returns the exit status if there is nothing to run. Throws as Selection::resolve does.
  [[nodiscard]] std::optional<int> read(OptionParser& parser, Selection& selection,
                                        std::span<const std::string_view> arguments);
};

}  // namespace rastrum::bench
