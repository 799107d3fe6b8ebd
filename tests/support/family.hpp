// The family: every device, rasterizer, thread count and instruction set that must give the same
// bits.
#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/render.hpp>

#include "tests/support/painter.hpp"

namespace rastrum::test {

struct Relative {
  std::string name;
  RenderOptions options;
};

/// `base` with the serial device first, then with threads 1, 2 and 8 for each instruction set. The
/// other rasterizers have a test each (table_test.cpp).
inline std::vector<Relative> family_of(const RenderOptions& base) {
  std::vector<Relative> family;
  RenderOptions serial = base;
  serial.device = Device::serial;
  serial.isa = Isa::scalar;
  family.push_back({"serial", serial});
  for (const Isa isa : available_isas()) {
    for (const int threads : {1, 2, 8}) {
      RenderOptions o = base;
      o.device = Device::threads;
      o.threads = threads;
      o.isa = isa;
      std::string title = std::to_string(threads);
      title.append(" threads ").append(name(isa));
      family.push_back({std::move(title), o});
    }
  }
  return family;
}

/// A point of the coverage × visibility table, which needs threads.
struct TablePoint {
  std::string rasterizer, visibility;
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
