// SPDX-License-Identifier: BSD-3-Clause
// Numbers that become colours, and their bar, as options.
#pragma once

#include <optional>
#include <string>

#include <rastrum/annotate.hpp>
#include <rastrum/color_map.hpp>
#include <rastrum/scene.hpp>

#include "arguments.hpp"

namespace rastrum::cli {

struct ScalarOptions {
  std::string name;  ///< empty: no numbers are shown
  bool name_given = false;
  ScalarMapping mapping;
  bool nan_given = false;  ///< its colour was given, so the bar shows it
  int isoline_count = 0;   ///< about so many, at the bar's ticks
  std::optional<std::string> bar_title;
  std::string bar_unit;
  const char* given = nullptr;     ///< an option that needs --scalars
  const char* of_lines = nullptr;  ///< an option that needs --isolines

  [[nodiscard]] bool bar() const { return bar_title.has_value(); }
  [[nodiscard]] std::string words() const { return bar_title.value_or("") + bar_unit; }
};

enum class NumbersOf { meshes, terrain };
/// With NumbersOf::terrain, options for meshes alone are parsed, so that errors name them, but
/// --help leaves them out.
void add_scalar_options(Parser app, ScalarOptions& s, NumbersOf of = NumbersOf::meshes);
/// Checks what the parser cannot check. Throws UsageError.
void check_scalars(const ScalarOptions& s, bool has_colors);
/// Throws Error for a name that the scene lacks.
void set_scalars(const ScalarOptions& s, Scene& scene);
/// About ScalarOptions::isoline_count of them, for numbers in this range.
void add_isolines(const ScalarOptions& s, ScalarRange range, Scene& scene);
/// For --bar; none without it.
[[nodiscard]] std::optional<BarWords> bar_words(const ScalarOptions& s);

}  // namespace rastrum::cli
