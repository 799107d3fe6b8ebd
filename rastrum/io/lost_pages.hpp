// SPDX-License-Identifier: BSD-3-Clause
// Pages of a mapped file that cannot be read any more: the file has become shorter, or its disk or
// network fails. POSIX sends SIGBUS to the thread that touches one, which ends the process. Here
// whoever touches one reads zeros from there on, and the owner of the mapping is told.
#pragma once

#include <atomic>
#include <cstddef>

namespace rastrum::io {

/// Watches a mapping while it lives. The first one sets a handler of SIGBUS for the process, which
/// stays and passes on what is not of a watched mapping. A program that sets a handler of its own
/// later has that; the thread that touches must not block SIGBUS.
class LostPages {
 public:
  LostPages(const std::byte* data, std::size_t size);
  ~LostPages();
  LostPages(const LostPages&) = delete;
  LostPages& operator=(const LostPages&) = delete;
  /// False: there are too many, and this one is not watched.
  [[nodiscard]] bool watches() const { return watched_ != nullptr; }
  /// Whether some page was lost: what was read since it was last asked may be zeros.
  [[nodiscard]] bool any() const;

 private:
  struct Watched;
  friend struct LostPagesHandler;
  Watched* watched_ = nullptr;
};

}  // namespace rastrum::io
