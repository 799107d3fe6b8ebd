// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C in a long frame; see bindings.hpp and ranks.hpp. A handler writes one atomic word and may
// call the earlier handler (Python's, which notes the signal). A signal handler may do both.
#include <csignal>

#ifdef __linux__
#include <unistd.h>
#endif

#include "bindings.hpp"
#include "ranks.hpp"

namespace rastrum::python {
namespace {

/// Python's handlers of signals run on this thread alone.
bool on_main_thread() {
#ifdef __linux__
  return gettid() == getpid();
#else
  const nb::object thread = nb::module_::import_("threading").attr("main_thread")();
  return nb::cast<unsigned long>(thread.attr("ident")) == PyThread_get_thread_ident();
#endif
}

/// SIGINT's handler while one of ours is in its place. Ours may run late, so these are static.
class Earlier {
 public:
// Windows has C's signal() alone. It runs a handler on a new thread, and only once.
#ifdef _WIN32
  using Handler = void(int);
  using Action = Handler*;
#else
  using Handler = void(int, siginfo_t*, void*);
  using Action = struct sigaction;
#endif

  /// Puts `ours` in its place, and clears the flag. Returns false and does nothing on other
  /// threads, if that was done already, and if nobody handles the signal. `restart`: system calls
  /// go on after the signal.
  bool replace(Handler* ours, bool restart) {
    if (!on_main_thread() || replaced_) return false;
#ifdef _WIN32
    static_cast<void>(restart);
    action_ = std::signal(SIGINT, SIG_GET);
    if (action_ == SIG_DFL || action_ == SIG_IGN) return false;
    flag.came = false;
    replaced_ = std::signal(SIGINT, ours) != SIG_ERR;
#else
    sigaction(SIGINT, nullptr, &action_);
    if ((action_.sa_flags & SA_SIGINFO) == 0 &&
        (action_.sa_handler == SIG_DFL || action_.sa_handler == SIG_IGN))
      return false;
    flag.came = false;
    Action now = action_;
    now.sa_sigaction = ours;
    now.sa_flags |= SA_SIGINFO | (restart ? SA_RESTART : 0);
    replaced_ = sigaction(SIGINT, &now, nullptr) == 0;
#endif
    return replaced_;
  }

  void put_back() {
#ifdef _WIN32
    std::signal(SIGINT, action_);
#else
    sigaction(SIGINT, &action_, nullptr);
#endif
    replaced_ = false;
  }

#ifdef _WIN32
  void call(int number) const {
    action_(number);
  }
#else
  void call(int number, siginfo_t* info, void* context) const {
    if ((action_.sa_flags & SA_SIGINFO) != 0)
      action_.sa_sigaction(number, info, context);
    else
      action_.sa_handler(number);
  }
#endif

  SignalFlag flag;

 private:
  Action action_{};
  bool replaced_ = false;  // of the main thread alone
};

Earlier of_frame, of_ranks;

template <class... Details>
void on_interrupt(int number, Details... details) {
  of_frame.flag.came = true;
  of_frame.call(number, details...);
}

template <class... Details>
void on_deferred_interrupt(int, Details...) {
  of_ranks.flag.came = true;
#ifdef _WIN32
  std::signal(SIGINT, on_deferred_interrupt<>);
#endif
}

}  // namespace

StopOnInterrupt::StopOnInterrupt() : installed_(of_frame.replace(on_interrupt, false)) {}

StopOnInterrupt::~StopOnInterrupt() {
  if (installed_) of_frame.put_back();
}

StopToken StopOnInterrupt::token() const {
  return installed_ ? StopToken(of_frame.flag) : StopToken{};
}

void DeferredInterrupt::enter() {
  if (of_ranks.replace(on_deferred_interrupt, true)) installed_ = true;
}

void DeferredInterrupt::exit() {
  if (!installed_) return;
  of_ranks.put_back();
  installed_ = false;
  if (of_ranks.flag.came.exchange(false)) PyErr_SetInterrupt();
}

void DeferredInterrupt::raise() {
  if (!installed_) return;
  // A signal that comes after this stops the next frame.
  if (of_ranks.flag.came.exchange(false)) PyErr_SetInterrupt();
  // Also handles signals that came just before raise() began.
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

StopToken DeferredInterrupt::token() const {
  return installed_ ? StopToken(of_ranks.flag) : StopToken{};
}

}  // namespace rastrum::python
