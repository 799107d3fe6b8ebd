// SPDX-License-Identifier: BSD-3-Clause
// USGS DEM files that tests write: cells of 30 m, heights in half metres.
#pragma once

#include <string>
#include <vector>

namespace rastrum::test {

inline void put(std::string& record, std::size_t at, const std::string& text, std::size_t width) {
  record.replace(at, width, std::string(width - text.size(), ' ') + text);
}

struct DemProfile {
  double x, y, datum;
  std::vector<int> elevations;
};

inline std::string dem(const std::vector<DemProfile>& profiles,
                       const std::string& elevation_unit = "2", const std::string& line_end = "") {
  std::string a(1024, ' ');
  put(a, 528, "2", 6);
  put(a, 534, elevation_unit, 6);
  put(a, 816, "0.300000E+02", 12);
  put(a, 828, "0.300000D+02", 12);
  put(a, 840, "0.5", 12);
  put(a, 852, "1", 6);
  put(a, 858, std::to_string(profiles.size()), 6);
  std::string file = a + line_end;
  for (const DemProfile& p : profiles) {
    std::string block(1024, ' ');
    put(block, 12, std::to_string(p.elevations.size()), 6);
    put(block, 18, "1", 6);
    put(block, 24, std::to_string(p.x) + "D+00", 24);
    put(block, 48, std::to_string(p.y) + "D+00", 24);
    put(block, 72, std::to_string(p.datum) + "D+00", 24);
    std::size_t at = 144;
    for (const int e : p.elevations) {
      if (at + 6 > 1020) {
        file += block + line_end;
        block.assign(1024, ' ');
        at = 0;
      }
      put(block, at, std::to_string(e), 6);
      at += 6;
    }
    file += block + line_end;
  }
  return file;
}

}  // namespace rastrum::test
