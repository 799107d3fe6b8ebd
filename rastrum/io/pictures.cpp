// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/pictures.hpp>

#include <utility>

#include <rastrum/parallel/exec.hpp>

namespace rastrum::io {

std::size_t Pictures::add(std::function<Image<Rgba8>()> decode) {
  all_.push_back({std::move(decode), {}, nullptr, 1});
  return all_.size() - 1;
}

void Pictures::decode_all() {
  const auto decode = [&](std::size_t i) noexcept {
    Picture& p = all_[i];
    try {
      p.image = std::exchange(p.decode, nullptr)();
    } catch (...) {
      p.error = std::current_exception();
    }
  };
  if (all_.size() == 1) return decode(0);  // no threads are started for one
  if (all_.empty()) return;
  parallel::Threads threads;
  parallel::for_each_index(threads, all_.size(), decode);
}

Image<Rgba8> Pictures::take(std::size_t picture) {
  Picture& p = all_[picture];
  if (p.error != nullptr) std::rethrow_exception(p.error);
  if (--p.uses == 0) return std::move(p.image);
  budget_.take(p.image.pixels().size(), sizeof(Rgba8));
  return p.image;
}

}  // namespace rastrum::io
