// A queue of work that makes work, on a device: it is worked off in passes, and before each pass
// what that can push is counted and the queue of the next one grown to it. So it never overflows,
// and has one order on every device: that of the items that pushed.
//
// Work O(items + pushes), span O(passes · log items). Each pass waits for its number of pushes.
// Memory: the items of two passes. Source: the queues of paper 2, which are arrays of a fixed size
// that may overflow; the counting is an expansion (paper 1, section 2.2.2).
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

#include <rastrum/parallel/cuda/expand.cuh>

namespace rastrum::parallel {

namespace cuda_detail {

// Not a private member: nvcc's host code names the types of a kernel's arguments.
template <class T, class F, class Plan>
struct Push {
  std::span<const T> items;
  std::span<T> next;
  Plan places;
  F f;
  RASTRUM_HD void operator()(std::size_t i) const {
    const std::size_t begin = places.first(i);
    f(items[i], next.subspan(begin, places.segment_end(i) - begin));
  }
};

}  // namespace cuda_detail

template <class T>
class PassQueue {
 public:
  /// `items` are copied; they lie on the device.
  PassQueue(Cuda& exec, std::span<const T> items)
      : exec_(&exec), items_(make_buffer<T>(exec, items.size())) {
    gather(exec, items, counting(items.size()), items_);
  }
  [[nodiscard]] std::size_t size() const { return items_.size(); }

  /// Until there are no items: pushes(item) → how many items it pushes, then f(item, std::span<T>),
  /// which writes them, each once. Both must agree; pushes must be pure. Returns the passes.
  template <class Pushes, class F>
  std::size_t work_off(Pushes&& pushes, F&& f) {
    std::size_t passes = 0;
    for (; items_.size() > 0; ++passes) {
      const auto places = make_expansion(*exec_, items_, pushes);
      auto next = make_buffer<T>(*exec_, places.size());
      for_each_index(*exec_, items_.size(),
                     cuda_detail::Push<T, std::decay_t<F>, decltype(places.view())>{
                         view_of(std::as_const(items_)), view_of(next), places.view(), f});
      items_ = std::move(next);
    }
    return passes;
  }

 private:
  Cuda* exec_;
  DeviceBuffer<T> items_;
};

}  // namespace rastrum::parallel
