// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <exception>
#include <memory>
#include <system_error>
#include <thread>

#include <rastrum/core/no_memory.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/error.hpp>
#include <rastrum/ranks.hpp>

namespace rastrum {
namespace {

/// The most values that one meeting compares; longer lists take several.
constexpr std::size_t kMostValues = 8;

template <class Shared>
class LocalRank final : public Communicator {
 public:
  LocalRank(Shared& shared, int rank)
      : shared_(shared), rank_(rank), me_(static_cast<std::size_t>(rank)) {}

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return static_cast<int>(shared_.posts.size()); }

  [[nodiscard]] std::uint64_t max(std::uint64_t value) override {
    max_of_each({&value, 1});
    return value;
  }

  void max_of_each(std::span<std::uint64_t> values) override {
    while (!values.empty()) {
      const auto now = values.first(std::min(values.size(), kMostValues));
      // One meeting suffices: a slot is reused only after the next meeting, and all come to that
      // after they have read the slot.
      turn_ = 1 - turn_;
      std::ranges::copy(now, shared_.posts[me_].values[turn_].begin());
      shared_.meet();
      for (const auto& post : shared_.posts)
        for (std::size_t i = 0; i < now.size(); ++i)
          now[i] = std::max(now[i], post.values[turn_][i]);
      count_rounds(now.size_bytes());
      values = values.subspan(now.size());
    }
  }

  [[nodiscard]] std::span<std::uint64_t> share(std::size_t count) override {
    if (!shared_.shares) return {};
    // All see the same size, because it changes only between two meetings.
    if (shared_.surface.size() < count) {
      shared_.meet();
      if (rank_ == 0) {
        try {
          shared_.surface.resize(count);
        } catch (const std::exception&) {  // all go without shared memory
        }
      }
      shared_.meet();
      if (shared_.surface.size() < count) return {};
    }
    return shared_.surface;
  }

  /// With several nodes, ranks stand for processes.
  [[nodiscard]] bool is_one_process() const override { return shared_.shares; }

  void broadcast(std::span<std::byte> bytes, int root) override {
    shared_.posts[me_].bytes = bytes;
    shared_.meet();
    if (root != rank_)
      copy(shared_.posts[static_cast<std::size_t>(root)].bytes, bytes);
    else
      count_rounds(bytes.size());
    shared_.meet();
  }

  void exchange_sizes(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) override {
    shared_.posts[me_].words = to;
    shared_.meet();
    for (std::size_t r = 0; r < from.size(); ++r) from[r] = shared_.posts[r].words[me_];
    count_to_all(sizeof(std::uint64_t));
    shared_.meet();
  }

  void exchange(std::span<const std::span<const std::byte>> to,
                std::span<const std::span<std::byte>> from) override {
    shared_.posts[me_].blocks = to;
    shared_.meet();
    for (std::size_t r = 0; r < from.size(); ++r) {
      copy(shared_.posts[r].blocks[me_], from[r]);
      if (r != me_ && !to[r].empty()) count(to[r].size());
    }
    shared_.meet();
  }

 private:
  void count(std::uint64_t bytes) {
    shared_.traffic[me_].bytes += bytes;
    ++shared_.traffic[me_].messages;
  }
  /// log N rounds, as with trees and recursive doubling.
  void count_rounds(std::uint64_t bytes) {
    for (std::size_t r = 1; r < shared_.posts.size(); r *= 2) count(bytes);
  }
  void count_to_all(std::uint64_t bytes) {
    for (std::size_t r = 1; r < shared_.posts.size(); ++r) count(bytes);
  }
  static void copy(std::span<const std::byte> from, std::span<std::byte> to) {
    if (!to.empty()) std::memcpy(to.data(), from.data(), to.size());
  }

  Shared& shared_;
  int rank_;
  std::size_t me_;
  std::size_t turn_ = 0;
};

}  // namespace

/// The memory that the threads share.
struct LocalRanks::Shared {
  /// Written by one rank; others read it between two meetings.
  struct Post {
    std::array<std::array<std::uint64_t, kMostValues>, 2> values{};
    std::span<const std::byte> bytes{};
    std::span<const std::uint64_t> words{};
    std::span<const std::span<const std::byte>> blocks{};
  };

  Shared(int n, bool one_node)
      : shares(one_node),
        posts(static_cast<std::size_t>(n)),
        traffic(static_cast<std::size_t>(n)),
        failures(static_cast<std::size_t>(n)) {}
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  ~Shared() {
    job = nullptr;
    begin_run();
  }

  /// Waits until all ranks are here. Throws once one has left or returned.
  void meet() {
    const std::uint32_t mine = meeting.load();
    if ((mine & kGone) != 0) throw_gone();
    if (arrived.fetch_add(1) + 1 == posts.size()) {
      arrived = 0;
      meeting.fetch_add(kMeeting);
      meeting.notify_all();
      return;
    }
    // A rank that leaves after all have arrived ends the next meeting, not this one.
    meeting.wait(mine);
    if ((meeting.load() & ~kGone) == mine) throw_gone();
  }

  /// Marks that `rank` has gone; `first` keeps the first rank that has gone this way.
  void go(std::uint32_t how, std::atomic<int>& first, int rank) {
    int nobody = -1;
    first.compare_exchange_strong(nobody, rank);
    meeting.fetch_or(how);
    meeting.notify_all();
  }
  void leave(int rank) { go(kLeft, left, rank); }
  void come_back(int rank) { go(kReturned, returned, rank); }

  [[noreturn]] void throw_gone() const {
    if (left >= 0)
      throw Error(Errc::io, text_of("rank ", left.load(), " has left the others waiting"));
    reject("rank ", returned.load(),
           " has returned while others wait for it; all ranks make the same calls");
  }

  void begin_run() {
    turn.fetch_add(1);
    turn.notify_all();
  }

  static constexpr std::uint32_t kLeft = 1, kReturned = 2, kGone = 3, kMeeting = 4;

  const bool shares;
  std::vector<std::uint64_t> surface;  ///< shared memory; rank 0 grows it while all wait
  std::atomic<std::uint32_t> arrived = 0;
  /// kMeeting times the number of meetings; plus kLeft once a rank has thrown, and kReturned once
  /// one has returned.
  std::atomic<std::uint32_t> meeting = 0;
  std::atomic<int> left = -1, returned = -1;  ///< the first such rank; −1: none
  std::vector<Post> posts;
  std::vector<Traffic> traffic;
  std::vector<std::exception_ptr> failures;

  const FunctionRef<void(Communicator&)>* job = nullptr;  ///< of this turn; null: end
  std::atomic<std::uint32_t> turn = 0, busy = 0;
  std::atomic<bool> running = false;
  std::vector<std::jthread> threads;  ///< last member, so that the threads end before what they use
};

LocalRanks::LocalRanks(int ranks, int node) {
  if (ranks < 1 || ranks > 4096) reject("ranks must lie between 1 and 4096, not ", ranks);
  if (node < 0) reject("ranks of a node must be 0 for all, or more, not ", node);
  shared_ = in_memory([&] { return std::make_unique<Shared>(ranks, node == 0 || node >= ranks); });
  const auto live_as = [shared = shared_.get()](int rank) {
    for (std::uint32_t turn = 0;;) {
      shared->turn.wait(turn);
      turn = shared->turn.load();
      if (shared->job == nullptr) return;
      LocalRank<Shared> own(*shared, rank);
      try {
        (*shared->job)(own);
        shared->come_back(rank);
      } catch (...) {
        shared->failures[static_cast<std::size_t>(rank)] = std::current_exception();
        shared->leave(rank);
      }
      if (shared->busy.fetch_sub(1) == 1) shared->busy.notify_one();
    }
  };
  shared_->threads.reserve(static_cast<std::size_t>(ranks));
  for (int r = 0; r < ranks; ++r) try {
      shared_->threads.emplace_back(live_as, r);
    } catch (const std::system_error& e) {
      throw Error(Errc::io, text_of("the thread of rank ", r, " of ", ranks,
                                    " cannot be started: ", e.what()));
    }
}
LocalRanks::~LocalRanks() = default;

std::span<const LocalRanks::Traffic> LocalRanks::traffic() const {
  return shared_->traffic;
}

void LocalRanks::run(FunctionRef<void(Communicator&)> f) {
  Shared& shared = *shared_;
  if (shared.running.exchange(true))
    reject(
        "LocalRanks::run: these ranks run already, and their threads are one's at a time; "
        "make others");
  shared.arrived = 0;
  shared.meeting.fetch_and(~Shared::kGone);
  shared.left = -1;
  shared.returned = -1;
  std::fill(shared.traffic.begin(), shared.traffic.end(), Traffic{});
  std::fill(shared.failures.begin(), shared.failures.end(), nullptr);
  shared.job = &f;
  shared.busy = static_cast<std::uint32_t>(shared.posts.size());
  shared.begin_run();
  while (const std::uint32_t busy = shared.busy.load()) shared.busy.wait(busy);
  shared.running = false;
  // The rank that left first has the cause; the others threw because it had left.
  if (const int left = shared.left; left >= 0)
    std::rethrow_exception(shared.failures[static_cast<std::size_t>(left)]);
}

}  // namespace rastrum
