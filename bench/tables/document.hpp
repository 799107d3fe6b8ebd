// SPDX-License-Identifier: BSD-3-Clause
// The output of a bench of a paper's table: tables for people as Markdown, the figures as JSON, a
// plot as SVG. One form, three renderers.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "plot.hpp"

namespace rastrum::bench {

/// A table of text. Numbers stand right: every column but the first.
struct Grid {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< shorter rows are filled up with empty cells

  /// The cell of a row and a column, which are made where there are none of these names.
  std::string& cell(const std::string& row, const std::string& column);
};

struct Document {
  std::string name;  ///< the benchmark's, and the files' without their endings
  std::string title;
  std::vector<std::string> notes = {};  ///< a sentence or two each: what is compared, and how
  std::vector<Grid> grids = {};
  std::optional<Plot> plot = {};
  nlohmann::json figures = nlohmann::json::array();  ///< an object a figure, published or ours
};

[[nodiscard]] std::string to_markdown(const Document& document);
/// {"benchmark", "title", "notes", "machine", "figures"}.
[[nodiscard]] nlohmann::json to_json(const Document& document);

/// Prints the Markdown and, where `folder` is not empty, writes NAME.md, NAME.json and NAME.svg
/// there (the folder is made). Throws Error{io}.
void publish(const Document& document, const std::string& folder);
/// The same with one more table, and a plot of one panel.
void publish(Document document, Grid grid, Plot plot, Panel panel, const std::string& folder);

}  // namespace rastrum::bench
