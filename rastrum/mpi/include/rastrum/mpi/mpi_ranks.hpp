// SPDX-License-Identifier: BSD-3-Clause
// The ranks of an MPI program, for render_parts (rastrum/ranks.hpp). Link Rastrum::mpi, which
// exists if CMake has found MPI.
#pragma once

#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mpi.h>

#include <rastrum/ranks.hpp>

namespace RASTRUM_API rastrum {
namespace mpi {

/// The ranks of a caller's communicator. It uses a duplicate, so the original's messages and error
/// handler stay untouched. All ranks make and destroy it together, between MPI_Init and
/// MPI_Finalize. On each rank only the thread that may call MPI (MPI_THREAD_FUNNELED) uses it. An
/// MPI error ends the job (MPI_Abort) with a message that says what failed, because MPI 3 cannot go
/// on without a rank.
class MpiRanks final : public Communicator {
 public:
  /// `timeout_s`: a rank that waits longer for others, because one has died or hangs, ends the job
  /// and prints its rank and phase. It must exceed the longest phase of a frame; 0: wait for ever.
  /// `before_abort` is called before this rank ends the job, which runs no destructors: for
  /// cleaning up what is half done (io::abandon_files). `shares`: whether ranks on one machine
  /// share memory (share); its windows cost the first frame some milliseconds. Throws
  /// Error{invalid_argument} unless MPI runs.
  explicit MpiRanks(MPI_Comm comm, double timeout_s = 0, Function<void()> before_abort = {},
                    bool shares = true);
  ~MpiRanks() override;
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return size_; }
  void begin_phase(std::string_view name) override { phase_ = name; }
  [[nodiscard]] std::uint64_t max(std::uint64_t value) override;
  void max_of_each(std::span<std::uint64_t> values) override;
  void broadcast(std::span<std::byte> bytes, int root) override;
  void exchange_sizes(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) override;
  /// Exchanges in pairs, in pieces of at most 1 GiB, because MPI 3 counts in int.
  void exchange(std::span<const std::span<const std::byte>> to,
                std::span<const std::span<std::byte>> from) override;
  /// A window on the first rank, if all ranks are on one machine (MPI_COMM_TYPE_SHARED). It is kept
  /// while it is large enough. If one rank cannot have it, none has, and this size is not tried
  /// again.
  [[nodiscard]] std::span<std::uint64_t> share(std::size_t count) override;

 private:
  /// Whether all ranks are on one machine; found out once.
  [[nodiscard]] bool is_one_node();
  void free_window();
  void check(int code, const char* what) const;
  /// Ends the job and does not return.
  void end_job() const;
  void wait(std::span<MPI_Request> requests, const char* what) const;

  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
  const int exceptions_ = std::uncaught_exceptions();
  bool shares_ = true;
  MPI_Comm node_ = MPI_COMM_NULL;  ///< the ranks of this machine; null until needed
  bool one_node_ = false;
  MPI_Win window_ = MPI_WIN_NULL;
  std::span<std::uint64_t> shared_{};
  std::size_t too_much_ = 0;  ///< this many numbers could not be shared; 0: none failed yet
  double timeout_s_ = 0;
  Function<void()> before_abort_;
  std::string phase_ = "begin";
};

/// Calls render_parts with the ranks of `comm`, for one picture. To draw many, keep MpiRanks, which
/// duplicates the communicator once and shares memory.
RanksStats render(MPI_Comm comm, Renderer& renderer, const SceneView& scene,
                  std::span<const std::uint64_t> parts, const Camera& camera,
                  const FrameOptions& frame, const Targets& targets,
                  const RanksOptions& options = {}, StopToken stop = {});

}  // namespace mpi
}  // namespace rastrum
