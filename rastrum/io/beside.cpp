// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/beside.hpp>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <rastrum/core/lower.hpp>

namespace rastrum::io {
namespace {

namespace fs = std::filesystem;

/// The entry `name` of a folder, else the alphabetically first that differs by case alone.
std::optional<fs::path> entry(const fs::path& folder, const std::string& name) {
  std::error_code ignored;
  if (fs::exists(folder / name, ignored)) return folder / name;
  std::optional<std::string> best;
  const fs::path listed = folder.empty() ? fs::path(".") : folder;
  for (fs::directory_iterator at(listed, ignored), end; !ignored && at != end;
       at.increment(ignored)) {
    std::string other = at->path().filename().string();
    if (equal_but_for_case(other, name) && (!best || other < *best)) best = std::move(other);
  }
  if (!best) return {};
  return folder / *best;
}

}  // namespace

void note_name(std::string& list, std::string_view name) {
  constexpr std::size_t kMostList = 300, kMostName = 100;
  constexpr std::string_view kMore = ", …";
  if (list.size() < kMostList)
    (list += list.empty() ? "" : ", ") += name.substr(0, kMostName);
  else if (!list.ends_with(kMore))
    list += kMore;
}

std::string_view unquoted(std::string_view name) {
  if (name.size() >= 2 && (name.front() == '"' || name.front() == '\'') &&
      name.back() == name.front())
    return name.substr(1, name.size() - 2);
  return name;
}

FoundFile find_beside(const fs::path& folder, std::string_view name) {
  std::string slashes(unquoted(name));
  std::error_code ignored;
  // A file's name may contain a backslash.
  if (fs::exists(folder / slashes, ignored)) return {folder / slashes};
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  const fs::path named = folder / slashes;
  if (fs::exists(named, ignored)) return {named};
  std::vector<std::string> parts;
  for (const fs::path& part : fs::path(slashes))
    if (std::string text = part.string(); !text.empty() && text != "/" && text != ".")
      parts.push_back(std::move(text));
  for (std::size_t first = 0; first < parts.size(); ++first) {
    if (parts[first] == ".." || parts[first].back() == ':') continue;
    std::optional<fs::path> at = folder;
    for (std::size_t i = first; at && i < parts.size(); ++i) at = entry(*at, parts[i]);
    if (at && fs::is_regular_file(*at, ignored)) return {*at, false};
  }
  return {named};
}

}  // namespace rastrum::io
