// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/mpi/mpi_ranks.hpp>

#include <sys/statvfs.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <limits>
#include <thread>
#include <utility>

#include <rastrum/error.hpp>

namespace rastrum::mpi {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr int kTag = 1;

MPI_Comm checked(MPI_Comm comm) {
  int begun = 0, ended = 0;
  MPI_Initialized(&begun);
  if (begun != 0) MPI_Finalized(&ended);
  if (begun == 0 || ended != 0)
    throw Error(Errc::invalid_argument, "ranks of MPI are made between MPI_Init and MPI_Finalize");
  if (comm == MPI_COMM_NULL)
    throw Error(Errc::invalid_argument, "the communicator of MPI is MPI_COMM_NULL");
  return comm;
}

/// Whether shared memory has `bytes` bytes left, and some for MPI. Linux limits it separately, in a
/// container often to 64 MiB. True on systems without /dev/shm.
bool has_room(std::size_t bytes) {
  struct statvfs there {};
  if (statvfs("/dev/shm", &there) != 0) return true;
  const std::uint64_t free = std::uint64_t{there.f_bavail} * there.f_frsize;
  constexpr std::uint64_t kOfMpi = std::uint64_t{4} << 20;
  return free >= kOfMpi && bytes <= free - kOfMpi;
}

}  // namespace

MpiRanks::MpiRanks(MPI_Comm comm, double timeout_s, Function<void()> before_abort, bool shares)
    : shares_(shares), timeout_s_(timeout_s), before_abort_(std::move(before_abort)) {
  check(MPI_Comm_dup(checked(comm), &comm_), "the duplication of the communicator");
  check(MPI_Comm_set_errhandler(comm_, MPI_ERRORS_RETURN), "setting what errors do");
  check(MPI_Comm_rank(comm_, &rank_), "asking for the rank");
  check(MPI_Comm_size(comm_, &size_), "asking for the number of ranks");
}

MpiRanks::~MpiRanks() {
  // Freeing the shared objects takes all ranks, so one that leaves by an exception would wait for
  // ever.
  if (std::uncaught_exceptions() > exceptions_) return;
  free_window();
  if (node_ != MPI_COMM_NULL) MPI_Comm_free(&node_);
  MPI_Comm_free(&comm_);
}

void MpiRanks::end_job() const {
  if (before_abort_) before_abort_();
  MPI_Abort(comm_ == MPI_COMM_NULL ? MPI_COMM_WORLD : comm_, 1);
}

void MpiRanks::check(int code, const char* what) const {
  if (code == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(code, text.data(), &length);
  std::fprintf(stderr, "rastrum: rank %d: %s failed: %s\n", rank_, what, text.data());
  end_job();
}

void MpiRanks::wait(std::span<MPI_Request> requests, const char* what) const {
  const auto count = static_cast<int>(requests.size());
  if (timeout_s_ <= 0) return check(MPI_Waitall(count, requests.data(), MPI_STATUSES_IGNORE), what);
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  for (int round = 0;; ++round) {
    int done = 0;
    check(MPI_Testall(count, requests.data(), &done, MPI_STATUSES_IGNORE), what);
    if (done != 0) return;
    const double waited_s = std::chrono::duration<double>(Clock::now() - begin).count();
    if (waited_s > timeout_s_) {
      std::fprintf(stderr,
                   "rastrum: error: rank %d has waited %.1f s for the others (%s, phase '%s') and "
                   "ends the job: one of them has died, hangs, or needs longer than the timeout\n",
                   rank_, waited_s, what, phase_.c_str());
      end_job();
    }
    // Poll at first to find a quick answer; in a long wait leave the core to others.
    if (round > 1000)
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    else
      std::this_thread::yield();
  }
}

std::uint64_t MpiRanks::max(std::uint64_t value) {
  max_of_each({&value, 1});
  return value;
}

void MpiRanks::max_of_each(std::span<std::uint64_t> values) {
  // After this call others see what this rank wrote into shared memory before.
  if (window_ != MPI_WIN_NULL) check(MPI_Win_sync(window_), "writing shared memory");
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Iallreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_UINT64_T,
                       MPI_MAX, comm_, &request),
        "agreeing on a number");
  wait({&request, 1}, "agreeing on a number");
  if (window_ != MPI_WIN_NULL) check(MPI_Win_sync(window_), "reading shared memory");
}

bool MpiRanks::is_one_node() {
  if (node_ == MPI_COMM_NULL) {
    check(MPI_Comm_split_type(comm_, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &node_),
          "asking which ranks are on this machine");
    check(MPI_Comm_set_errhandler(node_, MPI_ERRORS_RETURN), "setting what errors do");
    int here = 0;
    check(MPI_Comm_size(node_, &here), "asking how many ranks are on this machine");
    one_node_ = here == size_;  // then for all ranks
  }
  return one_node_;
}

void MpiRanks::free_window() {
  if (window_ == MPI_WIN_NULL) return;
  MPI_Win_unlock_all(window_);
  MPI_Win_free(&window_);
  shared_ = {};
}

std::span<std::uint64_t> MpiRanks::share(std::size_t count) {
  constexpr std::size_t kMost = std::numeric_limits<std::ptrdiff_t>::max() / sizeof(std::uint64_t);
  if (!shares_ || !is_one_node() || count > kMost || (too_much_ != 0 && count >= too_much_))
    return {};
  if (shared_.size() >= count && window_ != MPI_WIN_NULL) return shared_;
  const std::size_t bytes_of_all = count * sizeof(std::uint64_t);
  // Asked first, because MPI may leave the other ranks waiting if the first finds no room.
  if (max(rank_ != 0 || has_room(bytes_of_all) ? 0 : 1) != 0) {
    // If a window is held, its bytes are missing; the next call may have room.
    if (window_ == MPI_WIN_NULL) too_much_ = count;
    return {};
  }
  MPI_Win window = MPI_WIN_NULL;
  void* memory = nullptr;
  const auto bytes = static_cast<MPI_Aint>(rank_ == 0 ? bytes_of_all : 0);
  bool made = MPI_Win_allocate_shared(bytes, sizeof(std::uint64_t), MPI_INFO_NULL, node_, &memory,
                                      &window) == MPI_SUCCESS;
  if (made) {
    MPI_Win_set_errhandler(window, MPI_ERRORS_RETURN);
    MPI_Aint size = 0;
    int unit = 0;
    made = MPI_Win_shared_query(window, 0, &size, &unit, &memory) == MPI_SUCCESS &&
           MPI_Win_lock_all(MPI_MODE_NOCHECK, window) == MPI_SUCCESS;
  }
  if (made && rank_ == 0) {
    std::ranges::copy(shared_, static_cast<std::uint64_t*>(memory));
    made = MPI_Win_sync(window) == MPI_SUCCESS;
  }
  // A window that only some ranks have is not freed: that takes all of them.
  if (max(made ? 0 : 1) != 0) {
    too_much_ = count;
    return {};
  }
  free_window();
  window_ = window;
  check(MPI_Win_sync(window_), "reading shared memory");
  shared_ = {static_cast<std::uint64_t*>(memory), count};
  return shared_;
}

void MpiRanks::broadcast(std::span<std::byte> bytes, int root) {
  while (!bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), kMostBytes);
    MPI_Request request = MPI_REQUEST_NULL;
    check(MPI_Ibcast(bytes.data(), static_cast<int>(count), MPI_BYTE, root, comm_, &request),
          "telling all ranks");
    wait({&request, 1}, "telling all ranks");
    bytes = bytes.subspan(count);
  }
}

void MpiRanks::exchange_sizes(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) {
  MPI_Request request = MPI_REQUEST_NULL;
  check(MPI_Ialltoall(to.data(), 1, MPI_UINT64_T, from.data(), 1, MPI_UINT64_T, comm_, &request),
        "exchanging sizes");
  wait({&request, 1}, "exchanging sizes");
}

void MpiRanks::exchange(std::span<const std::span<const std::byte>> to,
                        std::span<const std::span<std::byte>> from) {
  const auto me = static_cast<std::size_t>(rank_);
  if (!from[me].empty()) std::memcpy(from[me].data(), to[me].data(), from[me].size());
  for (int step = 1; step < size_; ++step) {
    const int target = (rank_ + step) % size_, source = (rank_ - step + size_) % size_;
    std::span<const std::byte> out = to[static_cast<std::size_t>(target)];
    std::span<std::byte> in = from[static_cast<std::size_t>(source)];
    // Both ranks exchange piece k at the same time, so nobody waits for a later one.
    while (!out.empty() || !in.empty()) {
      const std::size_t sent = std::min(out.size(), kMostBytes);
      const std::size_t received = std::min(in.size(), kMostBytes);
      const int next = sent == 0 ? MPI_PROC_NULL : target;
      const int previous = received == 0 ? MPI_PROC_NULL : source;
      std::array<MPI_Request, 2> requests{MPI_REQUEST_NULL, MPI_REQUEST_NULL};
      check(MPI_Irecv(in.data(), static_cast<int>(received), MPI_BYTE, previous, kTag, comm_,
                      requests.data()),
            "exchanging blocks");
      check(MPI_Isend(out.data(), static_cast<int>(sent), MPI_BYTE, next, kTag, comm_,
                      requests.data() + 1),
            "exchanging blocks");
      wait(requests, "exchanging blocks");
      out = out.subspan(sent);
      in = in.subspan(received);
    }
  }
}

RanksStats render(MPI_Comm comm, Renderer& renderer, const SceneView& scene,
                  std::span<const std::uint64_t> parts, const Camera& camera,
                  const FrameOptions& frame, const Targets& targets, const RanksOptions& options,
                  StopToken stop) {
  MpiRanks ranks(comm, 0, {}, false);
  return render_parts(ranks, renderer, scene, parts, camera, frame, targets, options, stop);
}

}  // namespace rastrum::mpi
