// SPDX-License-Identifier: BSD-3-Clause
// Pages of a mapped file that can no longer be read: the file has become shorter, or its disk or
// network fails. POSIX sends SIGBUS to the thread that touches one and so ends the process. Here
// the thread reads zeros from there on, and the mapping's owner is told.
#pragma once

#include <atomic>
#include <cstddef>

namespace rastrum::io {

/// Watches a mapping while it lives. The first one sets a process-wide handler of SIGBUS, which
/// stays and passes on other addresses. A handler that the program sets later replaces it. Threads
/// that touch the mapping must not block SIGBUS.
class LostPages {
 public:
  LostPages(const std::byte* data, std::size_t size);
  ~LostPages();
  LostPages(const LostPages&) = delete;
  LostPages& operator=(const LostPages&) = delete;
  /// False: too many are watched, and this one is not.
  [[nodiscard]] bool watches() const { return watched_ != nullptr; }
  /// Whether a page was lost. Data read since this was last asked may then be zeros.
  [[nodiscard]] bool any() const;

 private:
  struct Watched;
  friend struct LostPagesHandler;
  Watched* watched_ = nullptr;
};

}  // namespace rastrum::io
