// SPDX-License-Identifier: BSD-3-Clause
// Which scenes and sizes a benchmark of the peers runs over: `--scenes`, `--sizes`, `--quick`.
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
  /// Replaces the defaults by what was asked for. Scenes whose files are absent are left out, each
  /// with a line on stdout; where none of the files is here, the procedural shapes stand in, beside
  /// those that were asked for.
  /// Throws Error{invalid_argument} for a name or size that is none.
  void resolve();

  /// Other defaults than the constructor's.
  void set_sizes(std::vector<Size> sizes) { sizes_ = std::move(sizes); }
  void set_scenes(std::vector<SceneInfo> scenes) { scenes_ = std::move(scenes); }

  [[nodiscard]] const std::vector<SceneInfo>& scenes() const { return scenes_; }
  /// Selected scenes whose data is not here.
  [[nodiscard]] const std::vector<SceneInfo>& absent() const { return absent_; }
  [[nodiscard]] const std::vector<Size>& sizes() const { return sizes_; }

 private:
  std::vector<SceneInfo> scenes_, absent_;
  std::vector<Size> sizes_;
  std::vector<std::string> scene_names_, size_names_;
};

/// The options of a benchmark of the peers.
struct PeerOptions {
  int rounds = 9, threads = 2;
  std::string json;

  /// Adds them and the selection's to `parser`, parses, and resolves the selection. The exit status
  /// where there is nothing to run. Throws as Selection::resolve.
  [[nodiscard]] std::optional<int> read(OptionParser& parser, Selection& selection,
                                        std::span<const std::string_view> arguments);
};

}  // namespace rastrum::bench
