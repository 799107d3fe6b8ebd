// SPDX-License-Identifier: BSD-3-Clause
// Ranks in Python: an object with the functions of a Communicator, over mpi4py or by itself.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <rastrum/ranks.hpp>
#include <rastrum/stop.hpp>

#include "bindings.hpp"

namespace rastrum::python {

/// A Communicator of a Python object's functions (rastrum/mpi.py). So the module links no MPI, and
/// any MPI of that object will do. The functions are called under the GIL, which the rest of a
/// frame does without. Buffers are memoryviews of the frame's memory, which end with the call.
class PythonRanks final : public Communicator {
 public:
  explicit PythonRanks(nb::object ranks);
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return size_; }
  void begin_phase(std::string_view name) override;
  [[nodiscard]] std::uint64_t max(std::uint64_t value) override;
  void broadcast(std::span<std::byte> bytes, int root) override;
  void exchange_sizes(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) override;
  void exchange(std::span<const std::span<const std::byte>> to,
                std::span<const std::span<std::byte>> from) override;

 private:
  nb::object ranks_;
  int rank_ = 0, size_ = 1;
};

/// Ctrl-C while a frame of ranks is drawn: it is noted and asks the frame to stop. Python's own
/// handler runs only in raise(), or at the end. So no exception interrupts an exchange, where other
/// ranks would wait for ever. Works on the main thread only.
class DeferredInterrupt {
 public:
  void enter();
  void exit();
  /// If Ctrl-C came, calls the earlier handler and throws what it raises.
  void raise();
  [[nodiscard]] StopToken token() const;

 private:
  bool installed_ = false;
};

}  // namespace rastrum::python
