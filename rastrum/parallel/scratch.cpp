// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/parallel/scratch.hpp>

#include <atomic>
#include <thread>
#include <utility>

namespace rastrum::parallel {

/// A list that only grows at its head. A thread finds its slot by walking it, which is short: one
/// node for each thread that ever asked.
struct ThreadSlots::Impl {
  struct Node {
    std::thread::id thread;
    void* slot = nullptr;
    Node* next = nullptr;
  };
  std::atomic<Node*> head = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    for (Node* node = head; node != nullptr;) delete std::exchange(node, node->next);
  }
};

ThreadSlots::ThreadSlots() : impl_(std::make_unique<Impl>()) {}
ThreadSlots::ThreadSlots(ThreadSlots&&) noexcept = default;
ThreadSlots& ThreadSlots::operator=(ThreadSlots&&) noexcept = default;
ThreadSlots::~ThreadSlots() = default;

void*& ThreadSlots::local() {
  const std::thread::id caller = std::this_thread::get_id();
  Impl::Node* node = impl_->head.load(std::memory_order_acquire);
  while (node != nullptr && node->thread != caller) node = node->next;
  if (node == nullptr) {
    node = new Impl::Node{caller, nullptr, impl_->head.load(std::memory_order_relaxed)};
    while (!impl_->head.compare_exchange_weak(node->next, node, std::memory_order_release,
                                              std::memory_order_relaxed)) {
    }
  }
  return node->slot;
}

void ThreadSlots::for_each(void (*f)(void* slot, void* data), void* data) {
  if (impl_ == nullptr) return;  // moved from
  for (Impl::Node* node = impl_->head; node != nullptr; node = node->next)
    if (node->slot != nullptr) f(node->slot, data);
}

}  // namespace rastrum::parallel
