// SPDX-License-Identifier: BSD-3-Clause
// Finds files that a mesh file names, even if they were moved or renamed with it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace rastrum::io {

struct FoundFile {
  std::filesystem::path path;
  bool as_named = true;  ///< false: `path` has another name than the mesh file says
};

/// The file that `name`, which may be quoted and contain backslashes, leads to from `folder`. If
/// there is none, the longest end of the name that leads to one counts ("a/b.png" of
/// "C:\\me\\a\\b.png", else "b.png"), if necessary in another case. Else returns `name` in
/// `folder`. O(names in the folders on the way).
[[nodiscard]] FoundFile find_beside(const std::filesystem::path& folder, std::string_view name);

/// Adds a name to a list for a message, and keeps the list short.
void note_name(std::string& list, std::string_view name);

[[nodiscard]] std::string_view unquoted(std::string_view name);

}  // namespace rastrum::io
