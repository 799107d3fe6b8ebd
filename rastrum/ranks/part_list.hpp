// SPDX-License-Identifier: BSD-3-Clause
// Which parts there are, who has them and how their primitives are numbered.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <rastrum/ranks/blocks.hpp>
#include <rastrum/scene.hpp>

namespace rastrum::ranks {

/// A rank's own instances in rising order of their parts.
struct OwnParts {
  /// Throws Error{invalid_argument} unless there is a number for each instance, below 2⁶³.
  OwnParts(const SceneView& scene, std::span<const std::uint64_t> parts);

  std::vector<InstanceView> instances;  ///< behind the parts there may be one without primitives
  std::vector<std::uint64_t> parts;
  /// The first local id of each, and behind the last.
  std::vector<std::uint64_t> first_ids;

  /// The instance that has primitive `id` of this rank.
  [[nodiscard]] std::size_t instance_of(std::uint64_t id) const;
};

/// All parts of all ranks, in rising order; the same on all ranks.
class PartList {
 public:
  struct Part {
    std::uint64_t number = 0;
    std::uint64_t primitives = 0;
    std::uint64_t first_id = 0;  ///< of all ranks' primitives in this order
    int rank = 0;
  };
  /// From what each rank has told (tell). Throws Error{invalid_argument} where two have one number.
  explicit PartList(const Mail& mail);
  static void tell(const OwnParts& own, Mail& mail);

  [[nodiscard]] std::span<const Part> parts() const { return parts_; }
  [[nodiscard]] std::uint64_t primitives() const { return primitives_; }
  /// The places in parts() of those of `rank`, rising: of its instances in OwnParts.
  [[nodiscard]] std::vector<std::size_t> places_of(int rank) const;

 private:
  std::vector<Part> parts_;
  std::uint64_t primitives_ = 0;
};

}  // namespace rastrum::ranks
