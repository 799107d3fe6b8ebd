#include <rastrum/held.hpp>

#include <string>

#include <rastrum/error.hpp>

namespace rastrum::held_detail {

void throw_moved_from(const char* name) {
  throw Error(Errc::invalid_argument,
              std::string("this ").append(name).append(
                  " was moved from; use the one that it was moved to, or make a new one"));
}

}  // namespace rastrum::held_detail
