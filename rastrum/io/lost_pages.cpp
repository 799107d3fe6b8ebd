// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/lost_pages.hpp>

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <mutex>

namespace rastrum::io {

/// `begin` is 0 where nothing is watched, and is set last.
struct LostPages::Watched {
  std::atomic<bool> taken{false}, lost{false};
  std::atomic<std::uintptr_t> begin{0}, end{0};
};

struct LostPagesHandler {
  static constexpr std::size_t kMost = 64;
  static LostPages::Watched all[kMost];
  static struct sigaction before;
  static std::uintptr_t page;

  /// Runs in a signal handler: lock-free atomics and one system call.
  static void run(int number, siginfo_t* info, void* context) {
    const int error = errno;
    const auto at = reinterpret_cast<std::uintptr_t>(info->si_addr);
    const bool is_fault = info->si_code > 0;  // else it was sent, and has no address
    for (LostPages::Watched& w : all) {
      const std::uintptr_t begin = w.begin.load(), end = w.end.load();
      // `begin` is read again: another mapping may have taken the place meanwhile.
      if (!is_fault || begin == 0 || at < begin || at >= end || w.begin.load() != begin) continue;
      w.lost.store(true);  // before anybody can read zeros
      // Maps zeros up to the end, because a shorter file has lost all from here on.
      const std::uintptr_t first = at / page * page;
      void* const zeros = ::mmap(reinterpret_cast<void*>(first), end - first, PROT_READ,
                                 MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED | MAP_NORESERVE, -1, 0);
      if (zeros == MAP_FAILED) break;
      errno = error;
      return;
    }
    errno = error;
    if ((before.sa_flags & SA_SIGINFO) != 0)
      before.sa_sigaction(number, info, context);
    else if (before.sa_handler != SIG_DFL && before.sa_handler != SIG_IGN)
      before.sa_handler(number);
    else if (is_fault || before.sa_handler == SIG_DFL) {
      std::signal(number, SIG_DFL);
      ::raise(number);  // takes effect when this returns, and ends the process
    }
  }

  static void set() {
    page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    struct sigaction own {};
    own.sa_sigaction = run;
    own.sa_flags = SA_SIGINFO;
    sigemptyset(&own.sa_mask);
    ::sigaction(SIGBUS, &own, &before);
  }
};

LostPages::Watched LostPagesHandler::all[kMost];
struct sigaction LostPagesHandler::before {};
std::uintptr_t LostPagesHandler::page = 4096;

LostPages::LostPages(const std::byte* data, std::size_t size) {
  static std::once_flag once;
  std::call_once(once, LostPagesHandler::set);
  for (Watched& w : LostPagesHandler::all) {
    if (w.taken.exchange(true)) continue;
    w.lost.store(false);
    const auto begin = reinterpret_cast<std::uintptr_t>(data);
    w.end.store(begin + size);
    w.begin.store(begin);
    watched_ = &w;
    return;
  }
}

LostPages::~LostPages() {
  if (watched_ == nullptr) return;
  watched_->begin.store(0);
  watched_->taken.store(false);
}

bool LostPages::any() const {
  return watched_ != nullptr && watched_->lost.load();
}

}  // namespace rastrum::io
