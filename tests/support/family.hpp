// SPDX-License-Identifier: BSD-3-Clause
// The points of the coverage × visibility table.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <rastrum/family.hpp>

namespace rastrum::test {

/// A point needs threads.
struct TablePoint {
  std::string rasterizer, visibility;
  operator family::Row() const { return {.rasterizer = rasterizer, .visibility = visibility}; }
};
inline std::vector<TablePoint> table_points() {
  std::vector<TablePoint> points;
  for (const family::AxisInfo& r : family::rasterizer_axis())
    for (const family::AxisInfo& v : family::visibility_axis())
      if (r.name != "reference") points.push_back({r.name, v.name});
  return points;
}
inline void PrintTo(const TablePoint& p, std::ostream* out) {
  *out << p.rasterizer << " × " << p.visibility;
}
inline std::string test_name(const TablePoint& p) {
  return p.rasterizer + "_" + p.visibility;
}

}  // namespace rastrum::test
