// SPDX-License-Identifier: BSD-3-Clause
#include "path_keys.hpp"

namespace rastrum::cli {

Interpolation read_interpolation(JsonFields& fields) {
  const auto word = fields.text("interpolation");
  if (word && *word != "smooth" && *word != "linear")
    fields.fail("interpolation", "expected smooth or linear, got '" + *word + "'");
  return word && *word == "linear" ? Interpolation::linear : Interpolation::smooth;
}

double read_key_time(JsonFields& fields, std::optional<double> before_s) {
  const auto time = fields.number("time");
  if (!time && before_s) fields.fail("time", "is needed: the seconds at which the camera is here");
  const double time_s = time.value_or(0);
  if (before_s && !(time_s > *before_s))
    fields.fail("time", "must be greater than the time of the key before");
  return time_s;
}

}  // namespace rastrum::cli
