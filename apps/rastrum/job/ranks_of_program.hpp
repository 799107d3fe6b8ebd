// SPDX-License-Identifier: BSD-3-Clause
// The view of `rastrum render` on MPI.
#pragma once

#include <rastrum/ranks.hpp>

namespace rastrum::cli {

/// The ranks of the program, until it ends.
class RanksOfProgram {
 public:
  virtual ~RanksOfProgram() = default;
  [[nodiscard]] virtual Communicator& ranks() = 0;
  /// How many ranks are on this machine.
  [[nodiscard]] virtual int neighbours() const = 0;
  /// Ends the job after a failure that the other ranks do not know of.
  virtual void give_up() = 0;
};

}  // namespace rastrum::cli
