// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C in a long frame; see bindings.hpp. The handler writes one atomic word and calls the
// earlier handler (Python's, which notes the signal). A signal handler may do both.
#include <csignal>

#include <unistd.h>

#include "bindings.hpp"

namespace rastrum::python {
namespace {

struct sigaction previous;
// Frames poll their token and register nothing with it, so request_stop() is an atomic write.
std::stop_source* volatile source = nullptr;

void on_interrupt(int number, siginfo_t* info, void* context) {
  if (source != nullptr) source->request_stop();
  if ((previous.sa_flags & SA_SIGINFO) != 0)
    previous.sa_sigaction(number, info, context);
  else if (previous.sa_handler != SIG_DFL && previous.sa_handler != SIG_IGN)
    previous.sa_handler(number);
}

}  // namespace

StopOnInterrupt::StopOnInterrupt() {
  if (gettid() != getpid() || source != nullptr) return;
  struct sigaction now;
  sigaction(SIGINT, nullptr, &previous);
  if ((previous.sa_flags & SA_SIGINFO) == 0 &&
      (previous.sa_handler == SIG_DFL || previous.sa_handler == SIG_IGN))
    return;
  source = new std::stop_source;
  now = previous;
  now.sa_sigaction = on_interrupt;
  now.sa_flags |= SA_SIGINFO;
  installed_ = sigaction(SIGINT, &now, nullptr) == 0;
}

StopOnInterrupt::~StopOnInterrupt() {
  if (source == nullptr || !installed_) return;
  sigaction(SIGINT, &previous, nullptr);
  delete source;
  source = nullptr;
}

std::stop_token StopOnInterrupt::token() const {
  return installed_ ? source->get_token() : std::stop_token{};
}

}  // namespace rastrum::python
