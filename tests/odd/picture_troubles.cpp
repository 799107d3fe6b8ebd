// Cameras and clipping.
#include "tests/odd/trouble.hpp"

namespace rastrum::odd {

std::vector<Trouble> picture_troubles() {
  return {};
}

}  // namespace rastrum::odd
