// SPDX-License-Identifier: BSD-3-Clause
// Whether the program was started as one of several ranks (mpirun, srun), and these ranks where it
// was built with MPI.
#pragma once

#include <memory>
#include <string>

#include "job/ranks_of_program.hpp"

namespace rastrum::cli {

/// Whether a launcher says that this is not the first of its ranks.
[[nodiscard]] bool started_as_further_rank();

/// Throws Error{unsupported} where it is one of several, each of which would write the same files.
void refuse_ranks(const std::string& why);

/// As StartRanks (commands.hpp) has it: MPI begins here and ends with what is returned. Without MPI
/// it refuses as refuse_ranks does.
[[nodiscard]] std::unique_ptr<RanksOfProgram> start_ranks(double timeout_s);

}  // namespace rastrum::cli
