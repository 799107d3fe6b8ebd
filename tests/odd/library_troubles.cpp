// Calls of the C++ interface, faults and limits.
#include "tests/odd/trouble.hpp"

namespace rastrum::odd {

std::vector<Trouble> library_troubles() {
  return {};
}

}  // namespace rastrum::odd
