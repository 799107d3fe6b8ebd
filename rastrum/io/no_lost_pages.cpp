// SPDX-License-Identifier: BSD-3-Clause
// Nobody can shorten a mapped file on Windows, and WebAssembly's mmap is a copy. If a disk or the
// network fails, the process ends.
#include <rastrum/io/lost_pages.hpp>

namespace rastrum::io {

struct LostPages::Watched {};
LostPages::LostPages(const std::byte* /*data*/, std::size_t /*size*/) {
  static Watched all;
  watched_ = &all;
}
LostPages::~LostPages() = default;
bool LostPages::any() const {
  return false;
}

}  // namespace rastrum::io
