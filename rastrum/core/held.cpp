// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/held.hpp>

#include <atomic>
#include <string>

#include <rastrum/error.hpp>

namespace rastrum::held_detail {

void throw_moved_from(const char* name) {
  throw Error(Errc::invalid_argument,
              std::string("this ").append(name).append(
                  " was moved from; use the one that it was moved to, or make a new one"));
}

void throw_no_function() {
  throw Error(Errc::invalid_argument, "an empty function is called; give one that can be called");
}

struct Count {
  void (*destroy)(const void* object);
  const void* object;
  std::atomic<std::size_t> number = 1;
};

Count* first_of(void (*destroy)(const void* object), const void* object) {
  return new Count{destroy, object};
}

void join(Count* count) noexcept {
  count->number.fetch_add(1, std::memory_order_relaxed);
}

// acq_rel: the object ends after all that other threads did with it.
void leave(Count* count) noexcept {
  if (count->number.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  count->destroy(count->object);
  delete count;
}

}  // namespace rastrum::held_detail
