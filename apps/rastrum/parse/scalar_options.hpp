// SPDX-License-Identifier: BSD-3-Clause
// Numbers that become colours, as options: which ones, how, and a bar that says what they mean.
#pragma once

#include <optional>
#include <string>

#include <rastrum/annotate.hpp>
#include <rastrum/color_map.hpp>
#include <rastrum/scene.hpp>

#include "arguments.hpp"

namespace rastrum::cli {

struct ScalarOptions {
  std::string name;  ///< empty: none are shown
  bool name_given = false;
  ScalarMapping mapping;
  bool nan_given = false;  ///< its colour, which the bar then shows
  int isoline_count = 0;   ///< about so many, where the bar has its ticks
  std::optional<std::string> bar_title;
  std::string bar_unit;
  const char* given = nullptr;     ///< an option that needs --scalars
  const char* of_lines = nullptr;  ///< one that needs --isolines

  [[nodiscard]] bool bar() const { return bar_title.has_value(); }
  /// The text in the bar.
  [[nodiscard]] std::string words() const { return bar_title.value_or("") + bar_unit; }
};

enum class NumbersOf { meshes, terrain };
/// With NumbersOf::terrain, options for meshes alone are parsed, too, so that they are refused by
/// name, but --help leaves them out.
void add_scalar_options(Parser app, ScalarOptions& s, NumbersOf of = NumbersOf::meshes);
/// Checks what the parser cannot see by itself. Throws UsageError.
void check_scalars(const ScalarOptions& s, bool has_colors);
/// Makes the scene show them. Throws Error for a name that it has not.
void set_scalars(const ScalarOptions& s, Scene& scene);
/// ScalarOptions::isoline_count of them, for a scene whose numbers have this range.
void add_isolines(const ScalarOptions& s, ScalarRange range, Scene& scene);
/// The words of the bar that --bar asks for; none without it.
[[nodiscard]] std::optional<BarWords> bar_words(const ScalarOptions& s);

}  // namespace rastrum::cli
