// SPDX-License-Identifier: BSD-3-Clause
// A signal handler may call little and take no lock, so it only wakes a thread, by a pipe: macOS
// has no nameless semaphores.
#include "signals.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <thread>

#include <rastrum/io.hpp>

namespace rastrum::cli {
namespace {

std::atomic<int> came{0};
static_assert(std::atomic<int>::is_always_lock_free);
int wake[2] = {-1, -1};

void on_signal(int number) {
  const int error = errno;
  int none = 0;
  if (came.compare_exchange_strong(none, number)) static_cast<void>(::write(wake[1], "", 1) == 1);
  errno = error;
}

void wait_and_end() {
  char byte = 0;
  while (::read(wake[0], &byte, 1) != 1 || came == 0) {
  }
  io::abandon_files();
  struct sigaction as_ever = {};
  as_ever.sa_handler = SIG_DFL;
  ::sigaction(came, &as_ever, nullptr);
  ::raise(came);
}

}  // namespace

void end_cleanly_on_signals() {
  if (::pipe(wake) != 0) return;
  for (const int end : wake) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  std::thread(wait_and_end).detach();
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    struct sigaction action = {};
    ::sigaction(number, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    ::sigaction(number, &action, nullptr);
  }
}

void leave_it_to_the_signal() {
  while (came != 0) ::pause();
}

}  // namespace rastrum::cli
