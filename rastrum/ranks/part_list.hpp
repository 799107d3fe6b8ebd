// SPDX-License-Identifier: BSD-3-Clause
// All parts, their ranks, and the numbering of their primitives.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/ranks/blocks.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::ranks {

/// A rank's own instances in rising order of their parts.
struct OwnParts {
  /// Throws Error{invalid_argument} unless each instance has a number below 2⁶³.
  OwnParts(const SceneView& scene, std::span<const std::uint64_t> parts);

  std::vector<InstanceView> instances;  ///< may have one more without primitives behind the parts
  std::vector<std::uint64_t> parts;
  /// The first local id of each part, then the end.
  std::vector<std::uint64_t> first_ids;

  /// The instance of this rank's primitive `id`.
  [[nodiscard]] std::size_t instance_of(std::uint64_t id) const;
};

/// All parts in rising order; the same on all ranks.
class PartList {
 public:
  struct Part {
    std::uint64_t number = 0;
    std::uint64_t primitives = 0;
    std::uint64_t first_id = 0;  ///< among all ranks' primitives in this order
    int rank = 0;
  };
  /// From the mail that each rank has packed by tell(). Throws Error{invalid_argument} if a number
  /// occurs twice.
  explicit PartList(const Mail& mail);
  static void tell(const OwnParts& own, Mail& mail);

  [[nodiscard]] std::span<const Part> parts() const { return parts_; }
  [[nodiscard]] std::uint64_t primitives() const { return primitives_; }
  /// The places of `rank`'s parts in parts(), rising, so in the order of OwnParts.
  [[nodiscard]] std::vector<std::size_t> places_of(int rank) const;

 private:
  std::vector<Part> parts_;
  std::uint64_t primitives_ = 0;
};

}  // namespace rastrum::ranks
