// SPDX-License-Identifier: BSD-3-Clause
// The ranks that the program was started as (mpirun, srun).
#pragma once

#include <memory>
#include <string>

#include "job/ranks_of_program.hpp"

namespace rastrum::cli {

/// Whether a launcher started this as another than the first rank.
[[nodiscard]] bool started_as_further_rank();

/// Throws Error{unsupported} if this is one of several ranks, which would all write the same files.
void refuse_ranks(const std::string& why);

/// For StartRanks (commands.hpp): MPI ends with the returned object. Without MPI it calls
/// refuse_ranks.
[[nodiscard]] std::unique_ptr<RanksOfProgram> start_ranks(double timeout_s);

}  // namespace rastrum::cli
