// SPDX-License-Identifier: BSD-3-Clause
// Left out: films, which need a child program that writes into an open file, and the benchmarks.
#include <windows.h>
// after windows.h
#include <psapi.h>

#include <atomic>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>

#include "files/mp4.hpp"
#include "job/system.hpp"
#include "signals.hpp"

namespace rastrum::cli {
namespace {

std::atomic<bool> ending{false};

/// Runs in a thread of its own. Afterwards Windows ends the process.
BOOL WINAPI on_event(DWORD /*event*/) {
  ending = true;
  io::abandon_files();
  return FALSE;
}

}  // namespace

void prepare_streams() {
  ::SetConsoleOutputCP(CP_UTF8);
  const HANDLE terminal = ::GetStdHandle(STD_ERROR_HANDLE);
  DWORD mode = 0;
  if (::GetConsoleMode(terminal, &mode) != 0)
    ::SetConsoleMode(terminal, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

double peak_bytes() {
  PROCESS_MEMORY_COUNTERS memory{};
  ::K32GetProcessMemoryInfo(::GetCurrentProcess(), &memory, sizeof memory);
  return static_cast<double>(memory.PeakWorkingSetSize);
}

void become_program_beside(const char* name, const std::vector<std::string>& /*arguments*/) {
  throw Error(Errc::unsupported, std::string(name) + " is not built for Windows");
}

void end_cleanly_on_signals() {
  ::SetConsoleCtrlHandler(on_event, TRUE);
}
void leave_it_to_the_signal() {
  while (ending) ::Sleep(INFINITE);
}

struct Mp4Writer::Impl {};
Mp4Writer::Mp4Writer(io::AtomicFile& /*file*/, int width, int height, double /*fps*/) {
  check(width, height);
}
Mp4Writer::~Mp4Writer() = default;
void Mp4Writer::add(ImageView<const Rgba8> /*picture*/) {}
void Mp4Writer::finish() {}
void Mp4Writer::check(int /*width*/, int /*height*/) {
  throw Error(Errc::unsupported,
              "an .mp4 is not written on Windows: write numbered pictures, as in -o "
              "frame_%04d.png");
}

}  // namespace rastrum::cli
