// SPDX-License-Identifier: BSD-3-Clause
#include "comparison.hpp"

#include <algorithm>

#include <bench/report.hpp>

namespace rastrum::bench {
namespace {

std::string text_of(const Published& p, const std::string& unit) {
  if (p.value <= 0) return "—";
  // In the paper's form: 5.0 ms and 22.0 MB.
  const auto printed = [&](double v) {
    const std::string number = shortest(v);
    return unit == "ms" && number.find('.') == std::string::npos ? number + ".0" : number;
  };
  std::string text = printed(p.value) + " " + unit;
  if (p.mb > 0) text.append(", ").append(printed(p.mb)).append(" MB");
  return text;
}

std::string text_of(const Measured& m, const std::string& unit) {
  if (m.value <= 0) return m.not_run.empty() ? "" : "not run (" + m.not_run + ")";
  std::string text = significant(m.value) + " " + unit;
  if (m.all_bytes > 0)
    text.append(", ")
        .append(megabytes(m.all_bytes))
        .append(" MB (")
        .append(megabytes(m.scratch_bytes))
        .append(")");
  return text;
}

nlohmann::json json_of(const Published& p) {
  if (p.value <= 0) return nullptr;
  nlohmann::json j = {{"value", p.value}};
  if (p.mb > 0) j["mb"] = p.mb;
  return j;
}

nlohmann::json json_of(const Measured& m) {
  if (m.value <= 0) return {{"not_run", m.not_run}};
  nlohmann::json j = {{"value", m.value}, {"spread", m.spread}, {"scratch_bytes", m.scratch_bytes}};
  if (m.all_bytes > 0) j["all_bytes"] = m.all_bytes;
  if (!m.samples_ms.empty()) j["samples_ms"] = m.samples_ms;
  return j;
}

std::string label(const Comparison::Row& row) {
  return row.at.empty()     ? row.name
         : row.name.empty() ? row.at
                            : std::string(row.name).append(" (").append(row.at).append(")");
}

/// The distinct values of a member of the rows, in order.
std::vector<std::string> distinct(const Comparison& c, std::string Comparison::Row::*member) {
  std::vector<std::string> values;
  for (const Comparison::Row& row : c.rows)
    if (std::ranges::find(values, row.*member) == values.end()) values.push_back(row.*member);
  return values;
}

Plot plot_of(const Comparison& c) {
  Plot plot;
  plot.title = c.caption;
  plot.y_title = c.unit;
  return plot;
}

}  // namespace

void add(Document& document, const Comparison& c) {
  Grid grid{c.caption, {c.first_column}, {}};
  grid.columns.insert(grid.columns.end(), c.columns.begin(), c.columns.end());
  for (const Comparison::Row& row : c.rows) {
    std::vector<std::string> paper{label(row) + " — " + c.paper};
    std::vector<std::string> ours{c.us};
    for (std::size_t i = 0; i < c.columns.size(); ++i) {
      const bool measured = i < row.ours.size();
      const bool published = i < row.published.size();
      paper.push_back(published ? text_of(row.published[i], c.unit) : "");
      ours.push_back(measured ? text_of(row.ours[i], c.unit) : "");
      document.figures.push_back(
          {{"table", c.caption},
           {"row", row.name},
           {"at", row.at},
           {"column", c.columns[i]},
           {"unit", c.unit},
           {"published", published ? json_of(row.published[i]) : nlohmann::json()},
           {"here", measured ? json_of(row.ours[i]) : nlohmann::json()}});
    }
    if (!row.published.empty()) {
      grid.rows.push_back(paper);
      ours[0] = "· " + ours[0];
    } else {
      ours[0] = label(row) + " — " + ours[0];
    }
    if (!row.ours.empty()) grid.rows.push_back(ours);
  }
  document.grids.push_back(std::move(grid));
}

Plot lines_of(const Comparison& c, const std::string& x_title) {
  Plot plot = plot_of(c);
  plot.note = "dashed: " + c.paper + "; solid: " + c.us;
  plot.x_title = x_title;
  plot.places = distinct(c, &Comparison::Row::at);
  const std::vector<std::string> names = distinct(c, &Comparison::Row::name);
  for (std::size_t column = 0; column < c.columns.size(); ++column) {
    Panel panel{c.columns[column], {}};
    for (std::size_t n = 0; n < names.size(); ++n) {
      const std::string shown = names[n].empty() ? c.us : names[n];
      Series paper{shown, std::vector<double>(plot.places.size(), kGap), static_cast<int>(n), true};
      Series ours{shown, paper.values, paper.color, false};
      for (const Comparison::Row& row : c.rows) {
        if (row.name != names[n]) continue;
        const auto at =
            static_cast<std::size_t>(std::ranges::find(plot.places, row.at) - plot.places.begin());
        if (column < row.published.size()) paper.values[at] = or_gap(row.published[column].value);
        if (column < row.ours.size()) ours.values[at] = or_gap(row.ours[column].value);
      }
      panel.series.push_back(std::move(paper));
      panel.series.push_back(std::move(ours));
    }
    plot.panels.push_back(std::move(panel));
  }
  return plot;
}

Plot bars_of(const Comparison& c) {
  Plot plot = plot_of(c);
  plot.kind = Plot::Kind::bars;
  plot.note = "pale: " + c.paper + "; full: " + c.us;
  plot.places = c.columns;
  Panel& panel = plot.panels.emplace_back();
  int color = 0;
  for (const Comparison::Row& row : c.rows) {
    const auto add_series = [&](const auto& figures, bool ghost) {
      const bool any = std::ranges::any_of(figures, [](const auto& f) { return f.value > 0; });
      if (!any) return;
      Series s{label(row), {}, color, ghost};
      for (const auto& f : figures) s.values.push_back(or_gap(f.value));
      panel.series.push_back(std::move(s));
    };
    add_series(row.published, true);
    add_series(row.ours, false);
    ++color;
  }
  return plot;
}

}  // namespace rastrum::bench
