// The family: every device, thread count and instruction set that must give the same bits.
#pragma once

#include <string>
#include <vector>

#include <rastrum/render/render.hpp>

namespace rastrum::test {

struct Relative {
  std::string name;
  RenderOptions options;
};

/// `base` with the serial device first, then threads 1, 2 and 8 for each instruction set.
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
      family.push_back({"threads " + std::to_string(threads) + " " + std::string(name(isa)), o});
    }
  }
  return family;
}

}  // namespace rastrum::test
