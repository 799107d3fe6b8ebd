// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C in a long frame; see bindings.hpp. The handler writes one atomic word and calls the
// earlier handler (Python's, which notes the signal). A signal handler may do both.
#include <csignal>

#include <unistd.h>

#include "bindings.hpp"

namespace rastrum::python {
namespace {

struct sigaction previous;
bool in_force = false;  // of the main thread alone
SignalFlag in_frame;

void on_interrupt(int number, siginfo_t* info, void* context) {
  in_frame.came = true;
  if ((previous.sa_flags & SA_SIGINFO) != 0)
    previous.sa_sigaction(number, info, context);
  else if (previous.sa_handler != SIG_DFL && previous.sa_handler != SIG_IGN)
    previous.sa_handler(number);
}

}  // namespace

StopOnInterrupt::StopOnInterrupt() {
  if (gettid() != getpid() || in_force) return;
  struct sigaction now;
  sigaction(SIGINT, nullptr, &previous);
  if ((previous.sa_flags & SA_SIGINFO) == 0 &&
      (previous.sa_handler == SIG_DFL || previous.sa_handler == SIG_IGN))
    return;
  in_frame.came = false;
  now = previous;
  now.sa_sigaction = on_interrupt;
  now.sa_flags |= SA_SIGINFO;
  in_force = installed_ = sigaction(SIGINT, &now, nullptr) == 0;
}

StopOnInterrupt::~StopOnInterrupt() {
  if (!installed_) return;
  sigaction(SIGINT, &previous, nullptr);
  in_force = false;
}

StopToken StopOnInterrupt::token() const {
  return installed_ ? StopToken(in_frame) : StopToken{};
}

}  // namespace rastrum::python
