// SPDX-License-Identifier: BSD-3-Clause
// Writes _outputs.pyi: the types of a picture's outputs, for type checkers and editors, which do
// not import the module. Names come from the table of targets.
#include <cstdint>
#include <cstdio>
#include <string>
#include <type_traits>

#include <rastrum/raster/context/target_table.hpp>

int main() {
  std::string names, fields;
  rastrum::raster::for_each_target([&]<class T>(const rastrum::raster::TargetRow<T>& row) {
    if (row.python.empty()) return;
    const char* const number = std::is_same_v<T, rastrum::Rgba8> ? "np.uint8"
                               : std::is_same_v<T, std::int64_t> ? "np.integer[Any]"
                                                                 : "np.float32";
    names.append(names.empty() ? "\"" : ", \"").append(row.python).append("\"");
    fields.append("    ").append(row.python).append(": NDArray[").append(number).append("]\n");
  });
  std::printf(
      "from typing import Any, Literal\n\n"
      "import numpy as np\nfrom numpy.typing import NDArray\n\n"
      "Output = Literal[%s]\n\n"
      "class Fields:\n    arrays: dict[str, NDArray[Any]]\n%s",
      names.c_str(), fields.c_str());
}
