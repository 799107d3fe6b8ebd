// SPDX-License-Identifier: BSD-3-Clause
// A method of transparency that another library adds. A frame names it by
// TransparencyOptions::added; Rastrum itself knows none.
#pragma once

#include <memory>
#include <string_view>

#include <rastrum/device.hpp>
#include <rastrum/frame.hpp>

namespace rastrum {

namespace transparency {
class LayerBlend;  // transparency/blend.hpp
}

struct AddedTransparency {
  std::unique_ptr<transparency::LayerBlend> (*make)(const TransparencyOptions& options, Isa isa);
  /// How many fragments of a pixel an insertion looks back over, without repair. 0: every fragment
  /// finds its place.
  int filter = 0;
  std::string_view why_host;  ///< why the CPU draws it though a device was asked for
};

namespace transparency {

[[nodiscard]] inline int filter_of(const TransparencyOptions& options) {
  return options.method == Transparency::added ? options.added->filter : 0;
}

}  // namespace transparency
}  // namespace rastrum
