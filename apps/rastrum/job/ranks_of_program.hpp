// SPDX-License-Identifier: BSD-3-Clause
// The ranks that the program was started as one of: what `rastrum render` sees of MPI.
#pragma once

#include <rastrum/ranks.hpp>

namespace rastrum::cli {

/// The ranks that the program was started as, until it ends.
class RanksOfProgram {
 public:
  virtual ~RanksOfProgram() = default;
  [[nodiscard]] virtual Communicator& ranks() = 0;
  /// How many of them are on this machine.
  [[nodiscard]] virtual int neighbours() const = 0;
  /// Ends the job: this rank has failed in a way that the others do not know of.
  virtual void give_up() = 0;
};

}  // namespace rastrum::cli
