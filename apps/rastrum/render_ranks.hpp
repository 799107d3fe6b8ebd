// `rastrum render` as one of several ranks: each reads its own inputs, the root writes the files
// that one process with all inputs would have written.
#pragma once

#include <functional>

#include "ranks_of_program.hpp"
#include "render_arguments.hpp"

namespace rastrum::cli {

/// Returns the exit status. If one rank fails, all do, and the first rank reports it. `check_files`
/// is called on the first rank alone. Options that are not for ranks are refused by name.
[[nodiscard]] int render_with_ranks(RenderArguments& a, RanksOfProgram& program,
                                    const std::function<void()>& check_files);

}  // namespace rastrum::cli
