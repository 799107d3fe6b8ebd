// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/core/view_rows.hpp>

#include <functional>

namespace rastrum {

bool overlap(const ViewRows& a, const ViewRows& b) noexcept {
  if (a.rows == 0 || b.rows == 0) return false;
  const std::less<const std::byte*> before;
  const auto row = [](const ViewRows& v, std::size_t i) { return v.first + i * v.stride_bytes; };
  const auto end = [&](const ViewRows& v) { return row(v, v.rows - 1) + v.row_bytes; };
  if (!before(a.first, end(b)) || !before(b.first, end(a))) return false;
  for (std::size_t i = 0, k = 0; i < a.rows && k < b.rows;) {
    const std::byte *const row_a = row(a, i), *const row_b = row(b, k);
    const bool a_reaches = before(row_b, row_a + a.row_bytes);
    const bool b_reaches = before(row_a, row_b + b.row_bytes);
    if (a_reaches && b_reaches) return true;
    if (a_reaches)
      ++k;  // the row of b ends before that of a begins
    else
      ++i;
  }
  return false;
}

}  // namespace rastrum
