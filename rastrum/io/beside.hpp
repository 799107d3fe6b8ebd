// Files that a mesh file names: where people who pass it on have put them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace rastrum::io {

struct FoundFile {
  std::filesystem::path path;
  bool as_named = true;  ///< else `path` is a file of another name
};

/// `name` as a file has it, which may be in quotes and have backslashes: where it leads from
/// `folder`; where nothing is there, the file in `folder` that has the longest end of it ("a/b.png"
/// of "C:\\me\\a\\b.png", else "b.png"), if need be by letters of another case. Where there is
/// none, the first, which is not there. O(names in the folders that are looked through).
[[nodiscard]] FoundFile find_beside(const std::filesystem::path& folder, std::string_view name);

/// Adds a name to a list for a message, which does not become longer than can be read.
void note_name(std::string& list, std::string_view name);

/// Without the quotes that stand around it.
[[nodiscard]] std::string_view unquoted(std::string_view name);

}  // namespace rastrum::io
