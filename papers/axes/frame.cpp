// SPDX-License-Identifier: BSD-3-Clause
#include <papers/axes/frame.hpp>

#include <rastrum/stop.hpp>

namespace rastrum::family {

void Emitter::flush() {
  if (count_ == 0) return;
  throw_if_stopped();  // one tile or chunk may have most of the scene
  std::span<Block> blocks(worker_.blocks, count_);
  count_ = 0;
  if (to_cover_) blocks = frame_.base.cover(pieces_, blocks);
  to_cover_ = false;
  if (first_pass_) frame_.base.count_fragments(blocks);
  blocks = frame_.base.test(pieces_, blocks, nullptr);
  if (!blocks.empty()) region_.blocks(chunk_, pieces_, blocks);
}

void Emitter::fragments(Rect bin, std::span<const BinFragment> fragments) {
  if (first_pass_) frame_.base.count_fragments(bin, fragments);
  region_.fragments(fragments);
}

}  // namespace rastrum::family
