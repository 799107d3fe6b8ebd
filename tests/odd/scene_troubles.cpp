// Polygons, normals, colours and transforms.
#include "tests/odd/trouble.hpp"

namespace rastrum::odd {

std::vector<Trouble> scene_troubles() {
  return {};
}

}  // namespace rastrum::odd
