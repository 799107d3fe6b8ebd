// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/parallel/scratch.hpp>

#include <tbb/enumerable_thread_specific.h>

namespace rastrum::parallel {

struct ThreadSlots::Impl {
  tbb::enumerable_thread_specific<void*> of_threads{nullptr};
};

ThreadSlots::ThreadSlots() : impl_(std::make_unique<Impl>()) {}
ThreadSlots::ThreadSlots(ThreadSlots&&) noexcept = default;
ThreadSlots& ThreadSlots::operator=(ThreadSlots&&) noexcept = default;
ThreadSlots::~ThreadSlots() = default;

void*& ThreadSlots::local() {
  return impl_->of_threads.local();
}

void ThreadSlots::for_each(void (*f)(void* slot, void* data), void* data) {
  if (impl_ == nullptr) return;  // moved from
  for (void* const slot : impl_->of_threads)
    if (slot != nullptr) f(slot, data);
}

}  // namespace rastrum::parallel
