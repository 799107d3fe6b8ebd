// SPDX-License-Identifier: BSD-3-Clause
// A signal ends the program with nothing half written, and the shell sees the signal.
#pragma once

namespace rastrum::cli {

/// From now on SIGINT, SIGTERM, SIGHUP and SIGPIPE (a pipe whose reader has gone) remove the
/// temporaries of all outputs, then end the program as usual, so that its exit status is 128 +
/// signal in a shell. Signals that the starter had ignored (nohup) stay ignored. Call it once,
/// before anything is written.
void end_cleanly_on_signals();

/// Does not return if such a signal has come: it causes other failures (ffmpeg gets Ctrl-C, too),
/// which need no report.
void leave_it_to_the_signal();

}  // namespace rastrum::cli
