// SPDX-License-Identifier: BSD-3-Clause
// The output of a paper's table: Markdown tables for people, figures as JSON, a plot as SVG.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "plot.hpp"

namespace rastrum::bench {

/// A table of text. All columns but the first are numbers, right-aligned.
struct Grid {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< shorter rows are filled up with empty cells

  /// The cell of a row and a column. Makes those that do not exist.
  std::string& cell(const std::string& row, const std::string& column);
};

struct Document {
  std::string name;  ///< of the benchmark, and of the files without their endings
  std::string title;
  std::vector<std::string> notes = {};  ///< a sentence or two each: what is compared, and how
  std::vector<Grid> grids = {};
  std::optional<Plot> plot = {};
  nlohmann::json figures = nlohmann::json::array();  ///< an object per figure, published or ours
};

[[nodiscard]] std::string to_markdown(const Document& document);
/// {"benchmark", "title", "notes", "machine", "figures"}.
[[nodiscard]] nlohmann::json to_json(const Document& document);

/// Prints the Markdown. Unless `folder` is empty, writes NAME.md, NAME.json and NAME.svg there and
/// makes the folder if needed. Throws Error{io}.
void publish(const Document& document, const std::string& folder);
/// The same with one more table, and a plot of one panel.
void publish(Document document, Grid grid, Plot plot, Panel panel, const std::string& folder);

}  // namespace rastrum::bench
