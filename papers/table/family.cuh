// SPDX-License-Identifier: BSD-3-Clause
// The rows of both axes of the papers' rasterizers on a device, by name. family.cu and
// visibilities.cu compile them once.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include <papers/axes/frame.cuh>

namespace rastrum::family {

template <class Exec>
struct CoverageOnDevice {
  std::string_view name;
  /// Enumerates pieces that have a sample in the frame's view into FamilyFrame::emit.
  void (*draw)(FamilyFrame<Exec>&, std::span<const Piece>) = nullptr;
};

template <class Exec>
struct VisibilityOnDevice {
  std::string_view name;
  std::uint64_t pixel_bytes = 0;  ///< of a band, beside its keys
  bool shades = false;            ///< sets FragmentColors::colors
  std::unique_ptr<DeviceVisibility<Exec>> (*make)(FamilyFrame<Exec>&) = nullptr;
};

template <class Exec>
[[nodiscard]] std::span<const VisibilityOnDevice<Exec>> visibilities_on_device();

}  // namespace rastrum::family
