// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/scene/shapes/require.hpp>

#include <string>

#include <rastrum/core/number_text.hpp>
#include <rastrum/error.hpp>

namespace rastrum::shapes {

void require_range(std::string_view shape, std::string_view parameter, double value, double low,
                   double high) {
  if (value >= low && value <= high) return;
  throw Error(Errc::invalid_argument, std::string(shape).append(": ").append(parameter) +
                                          " must lie in [" + number_text(low, 6) + ", " +
                                          number_text(high, 6) + "], got " + number_text(value, 6));
}

void require_size(std::string_view shape, std::string_view parameters, double vertices) {
  if (vertices < 4294967296.0) return;
  throw Error(Errc::invalid_argument, std::string(shape).append(": ").append(parameters) +
                                          " ask for " + number_text(vertices, 6) +
                                          " vertices, more than 32-bit indices can number");
}

}  // namespace rastrum::shapes
