// SPDX-License-Identifier: BSD-3-Clause
#include "document.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include <bench/report.hpp>
#include <rastrum/error.hpp>

namespace rastrum::bench {
namespace {

/// Escapes what would end a cell (a bar) or the table (a newline).
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

/// Pads the columns, so that the table is readable as plain text.
std::string to_markdown(const Grid& grid) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < grid.columns.size(); ++c) {
    std::size_t width = std::max<std::size_t>(characters(cell(grid.columns[c])), 3);
    for (const auto& row : grid.rows)
      if (c < row.size()) width = std::max(width, characters(cell(row[c])));
    widths.push_back(width);
  }
  const auto row_text = [&](const std::vector<std::string>& cells) {
    std::string text = "|";
    for (std::size_t c = 0; c < widths.size(); ++c) {
      const std::string content = c < cells.size() ? cell(cells[c]) : std::string();
      const std::string padding(widths[c] - characters(content), ' ');
      text.append(" ").append(c == 0 ? content + padding : padding + content).append(" |");
    }
    return text.append("\n");
  };
  std::string text = grid.caption.empty() ? std::string() : grid.caption + "\n\n";
  text += row_text(grid.columns) + "|";
  for (std::size_t c = 0; c < widths.size(); ++c)
    text.append(c == 0 ? ":" : "-").append(widths[c], '-').append(c == 0 ? "-|" : ":|");
  text += "\n";
  for (const auto& row : grid.rows) text += row_text(row);
  return text;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw Error(Errc::io, "cannot write " + file.string());
}

}  // namespace

std::string& Grid::cell(const std::string& row, const std::string& column) {
  auto cells = std::ranges::find(
      rows, row, [](const auto& r) -> const auto& { return r[0]; });
  if (cells == rows.end()) cells = rows.insert(cells, {row});
  const auto at = std::ranges::find(columns.begin() + 1, columns.end(), column);
  const auto i = static_cast<std::size_t>(at - columns.begin());
  if (at == columns.end()) columns.push_back(column);
  cells->resize(std::max(cells->size(), i + 1));
  return (*cells)[i];
}

std::string to_markdown(const Document& document) {
  std::string text = "# " + document.title + "\n\n";
  for (const std::string& note : document.notes) text.append(note).append("\n\n");
  for (const Grid& grid : document.grids) text.append(to_markdown(grid)).append("\n");
  std::string machine = machine_text();
  std::ranges::replace(machine, '\n', ' ');
  return text.append(machine).append("\n");
}

nlohmann::json to_json(const Document& document) {
  return {{"benchmark", document.name},
          {"title", document.title},
          {"notes", document.notes},
          {"machine", machine_json()},
          {"figures", document.figures}};
}

void publish(const Document& document, const std::string& folder) {
  const std::string text = to_markdown(document);
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
  if (folder.empty()) return;
  const std::filesystem::path path(folder);
  std::error_code failed;
  std::filesystem::create_directories(path, failed);
  if (failed) throw Error(Errc::io, "cannot make the folder " + folder + ": " + failed.message());
  write_text(path / (document.name + ".md"), text);
  write_json((path / (document.name + ".json")).string(), to_json(document));
  if (document.plot) write_text(path / (document.name + ".svg"), to_svg(*document.plot));
}

void publish(Document document, Grid grid, Plot plot, Panel panel, const std::string& folder) {
  document.grids.push_back(std::move(grid));
  plot.panels = {std::move(panel)};
  document.plot = std::move(plot);
  publish(document, folder);
}

}  // namespace rastrum::bench
