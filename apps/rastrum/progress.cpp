#include "progress.hpp"

#include <rastrum/io/files.hpp>

#include <unistd.h>

#include <cstdio>

namespace rastrum::cli {

Progress::Progress(bool quiet)
    : active_(!quiet && ::isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + std::chrono::milliseconds(500)) {}

void Progress::show(const std::string& what) {
  if (!active_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(100);
  std::fprintf(stderr, "\r\x1b[K%s", what.c_str());
  std::fflush(stderr);
  visible_ = true;
}

void Progress::clear() {
  if (!visible_) return;
  std::fputs("\r\x1b[K", stderr);
  visible_ = false;
}

void warn(const std::string& what) {
  std::fprintf(stderr, "warning: %s\n", io::shortened(what).c_str());
}
void note(const std::string& what) {
  std::fprintf(stderr, "note: %s\n", io::shortened(what).c_str());
}

}  // namespace rastrum::cli
