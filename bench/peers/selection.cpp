// SPDX-License-Identifier: BSD-3-Clause
#include "selection.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include <rastrum/error.hpp>

namespace rastrum::bench {

Size parse_size(const std::string& text) {
  Size size;
  const char* const end = text.data() + text.size();
  const auto [x, first] = std::from_chars(text.data(), end, size.width);
  if (first == std::errc{} && x != end && *x == 'x') {
    const auto [rest, second] = std::from_chars(x + 1, end, size.height);
    if (second == std::errc{} && rest == end && size.width > 0 && size.height > 0) return size;
  }
  throw Error(Errc::invalid_argument, "\"" + text + "\" is no size; one is 1920x1080");
}

std::string size_text(Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

void Selection::add_to(OptionParser& parser) {
  std::string known;
  for (const SceneInfo& scene : scenes_)
    known += (known.empty() ? "" : ",") + std::string(scene.name);
  std::string sizes;
  for (const Size size : sizes_) sizes += (sizes.empty() ? "" : ",") + size_text(size);
  parser
      .add_option("--scenes", scene_names_, "scenes, separated by commas (default: " + known + ")")
      ->delimiter(',')
      ->type_name("NAMES");
  parser
      .add_option("--sizes", size_names_,
                  "image sizes, separated by commas (default: " + sizes + ")")
      ->delimiter(',')
      ->type_name("WxH");
}

void Selection::resolve() {
  if (!size_names_.empty()) {
    sizes_.clear();
    for (const std::string& text : size_names_) sizes_.push_back(parse_size(text));
  }
  if (!scene_names_.empty()) {
    scenes_.clear();
    for (const std::string& name : scene_names_) scenes_.push_back(scene_by_name(name));
  }
  const auto is_file = [](const SceneInfo& s) { return !s.file.empty(); };
  const bool any_file_wanted = std::ranges::any_of(scenes_, is_file);
  std::erase_if(scenes_, [this](const SceneInfo& scene) {
    if (available(scene)) return false;
    absent_.push_back(scene);
    std::printf("skipped: %.*s (no %.*s in the shared data)\n", static_cast<int>(scene.name.size()),
                scene.name.data(), static_cast<int>(scene.file.size()), scene.file.data());
    return true;
  });
  if (any_file_wanted && std::ranges::none_of(scenes_, is_file)) {
    std::printf("procedural shapes stand in\n");
    for (const SceneInfo& shape : procedural_scenes())
      if (std::ranges::find(scenes_, shape.name, &SceneInfo::name) == scenes_.end())
        scenes_.push_back(shape);
  }
}

std::optional<int> PeerOptions::read(OptionParser& parser, Selection& selection,
                                     std::span<const std::string_view> arguments) {
  bool quick = false;
  selection.add_to(parser);
  parser.add_option("--rounds", rounds, "rounds of A B C … (default: 9)")->range(1, 1000);
  parser.add_option("--threads", threads, "threads of each contender (default: 2)")->range(1, 1024);
  parser.add_flag("--quick", quick, "3 rounds, at 1024x1024 unless --sizes says otherwise");
  parser.add_option("--json", json, "write all samples to FILE")->type_name("FILE");
  if (const auto status = parser.parse(arguments)) return status;
  if (quick) {
    if (!parser.given("--rounds")) rounds = 3;
    selection.set_sizes({{1024, 1024}});
  }
  selection.resolve();
  return {};
}

}  // namespace rastrum::bench
