// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/part_list.hpp>

#include <algorithm>
#include <limits>
#include <numeric>

#include <rastrum/core/reject.hpp>
#include <rastrum/raster/rules/piece.hpp>

namespace rastrum::ranks {

OwnParts::OwnParts(const SceneView& scene, std::span<const std::uint64_t> given) {
  if (given.size() != scene.instances.size())
    reject(given.size(), " part numbers for ", scene.instances.size(), " instances");
  std::vector<std::size_t> order(given.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return given[a] < given[b]; });
  std::uint64_t first = 0;
  for (const std::size_t i : order) {
    if (given[i] > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      reject("part number ", given[i], " is above 2^63 - 1");
    InstanceView& instance = instances.emplace_back(scene.instances[i]);
    if (!instance.id) instance.id = static_cast<std::int64_t>(given[i]);
    parts.push_back(given[i]);
    first_ids.push_back(first);
    first += primitive_count(instance.geometry);
  }
  first_ids.push_back(first);
}

std::size_t OwnParts::instance_of(std::uint64_t id) const {
  const auto above = std::ranges::upper_bound(first_ids, id);
  return static_cast<std::size_t>(above - first_ids.begin()) - 1;
}

void PartList::tell(const OwnParts& own, Mail& mail) {
  for (std::size_t r = 0; r < mail.ranks(); ++r)
    for (std::size_t i = 0; i < own.parts.size(); ++i) {
      put(mail.to(r), own.parts[i]);
      put(mail.to(r), own.first_ids[i + 1] - own.first_ids[i]);
    }
}

PartList::PartList(const Mail& mail) {
  for (std::size_t r = 0; r < mail.ranks(); ++r)
    for (Reader from = mail.from(r); !from.at_end();) {
      Part part{.rank = static_cast<int>(r)};
      part.number = from.take<std::uint64_t>();
      part.primitives = from.take<std::uint64_t>();
      parts_.push_back(part);
    }
  std::ranges::stable_sort(parts_, {}, &Part::number);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    if (i > 0 && parts_[i - 1].number == part.number)
      reject("part ", part.number, " is on rank ", parts_[i - 1].rank, " and on rank ", part.rank,
             "; each part needs its own number");
    part.first_id = primitives_;
    primitives_ += part.primitives;
  }
  if (parts_.size() > raster::kMaxId) reject("there are more than 2^33 - 2 parts");
}

std::vector<std::size_t> PartList::places_of(int rank) const {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    if (parts_[i].rank == rank) places.push_back(i);
  return places;
}

}  // namespace rastrum::ranks
