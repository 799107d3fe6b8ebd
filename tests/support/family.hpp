// The family: every device, thread count and instruction set that must give the same bits.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <rastrum/render/render.hpp>

namespace rastrum::test {

struct Relative {
  std::string name;
  RenderOptions options;
};

/// `base` with the serial device first, then every other row of the registry with threads 1, 2 and
/// 8 for each instruction set.
inline std::vector<Relative> family_of(const RenderOptions& base) {
  std::vector<Relative> family;
  RenderOptions serial = base;
  serial.device = Device::serial;
  serial.isa = Isa::scalar;
  family.push_back({"serial", serial});
  for (const AxisInfo& row : rasterizers()) {
    if (row.name == "reference") continue;  // is what the serial device draws with
    for (const Isa isa : available_isas()) {
      for (const int threads : {1, 2, 8}) {
        RenderOptions o = base;
        o.rasterizer = row.name;
        o.device = Device::threads;
        o.threads = threads;
        o.isa = isa;
        std::string title = row.name;
        title.append(" ").append(std::to_string(threads)).append(" ").append(name(isa));
        family.push_back({std::move(title), o});
      }
    }
  }
  return family;
}

}  // namespace rastrum::test
