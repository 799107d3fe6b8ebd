// SPDX-License-Identifier: BSD-3-Clause
// How the program ends by a signal: nothing half written stays behind, and the shell sees which
// signal it was.
#pragma once

namespace rastrum::cli {

/// From now on SIGINT, SIGTERM, SIGHUP and SIGPIPE (a pipe whose reader has gone) remove the
/// temporaries of all outputs and then end the program as they would have without this, so that its
/// exit status is 128 + signal in a shell. Signals that the program's starter had ignored, as nohup
/// does, stay ignored. Call it once, before anything is written.
void end_cleanly_on_signals();

/// Does not return where such a signal has come: failures then have it as their cause (ffmpeg gets
/// Ctrl-C, too), and are no news.
void leave_it_to_the_signal();

}  // namespace rastrum::cli
