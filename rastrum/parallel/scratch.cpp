// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/parallel/scratch.hpp>

#include <array>
#include <atomic>
#include <functional>
#include <thread>
#include <utility>

namespace rastrum::parallel {

/// Lists that only grow at their heads. A thread's list is chosen by its id, and has one node for
/// each such thread that ever asked.
struct ThreadSlots::Impl {
  struct Node {
    std::thread::id thread;
    void* slot = nullptr;
    Node* next = nullptr;
  };
  std::array<std::atomic<Node*>, 64> heads{};

  std::atomic<Node*>& head_of(std::thread::id thread) {
    return heads[std::hash<std::thread::id>{}(thread) % heads.size()];
  }

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    for (Node* node : heads)
      while (node != nullptr) delete std::exchange(node, node->next);
  }
};

ThreadSlots::ThreadSlots() : impl_(std::make_unique<Impl>()) {}
ThreadSlots::ThreadSlots(ThreadSlots&&) noexcept = default;
ThreadSlots& ThreadSlots::operator=(ThreadSlots&&) noexcept = default;
ThreadSlots::~ThreadSlots() = default;

void*& ThreadSlots::local() {
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<Impl::Node*>& head = impl_->head_of(caller);
  Impl::Node* node = head.load(std::memory_order_acquire);
  while (node != nullptr && node->thread != caller) node = node->next;
  if (node == nullptr) {
    node = new Impl::Node{caller, nullptr, head.load(std::memory_order_relaxed)};
    while (!head.compare_exchange_weak(node->next, node, std::memory_order_release,
                                       std::memory_order_relaxed)) {
    }
  }
  return node->slot;
}

void ThreadSlots::for_each(void (*f)(void* slot, void* data), void* data) {
  if (impl_ == nullptr) return;  // moved from
  for (Impl::Node* node : impl_->heads)
    for (; node != nullptr; node = node->next)
      if (node->slot != nullptr) f(node->slot, data);
}

}  // namespace rastrum::parallel
