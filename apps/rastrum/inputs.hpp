// INPUT…: files and builtin shapes, as one scene in command order.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <rastrum/scene/scene.hpp>

namespace rastrum::cli {

class Progress;
class Timeline;

enum class Normals {
  file,    ///< the file's, computed where it has none
  vertex,  ///< area-weighted, always computed
  face,    ///< one a triangle
};

/// A file, or `builtin:SHAPE[?name=value,…]` where x, y, z and scale place the shape and the rest
/// is the shape's own; `&` separates as well as a comma. `-` is standard input. `format`: what an
/// input is whose name does not say (a name of io::scene_formats, or empty). Throws UsageError for
/// a builtin that does not exist, Error for a file that cannot be read.
[[nodiscard]] Scene load_input(const std::string& input, std::string_view format = {});

/// Throws UsageError for a pipe without a format, and where standard input is asked for twice.
void check_inputs(const std::vector<std::string>& inputs, std::string_view format);

/// All inputs, appended in order, with their normals. Each is an event of `timeline`.
[[nodiscard]] Scene load_inputs(const std::vector<std::string>& inputs, Normals normals,
                                Timeline& timeline, Progress& progress,
                                std::string_view format = {});

}  // namespace rastrum::cli
