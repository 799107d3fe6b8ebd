// Parts of a mesh dealt to ranks, and what ranks would send, for `rastrum bench ranks`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <rastrum/ranks.hpp>
#include <rastrum/render.hpp>

#include "tables/document.hpp"

namespace rastrum::bench {

/// A mesh cut into slabs of space, as a simulation deals its domain.
struct Slabs {
  Slabs(const Mesh& whole, std::size_t count);
  Slabs(const Slabs&) = delete;
  Slabs& operator=(const Slabs&) = delete;

  std::size_t triangles;
  std::vector<Mesh> meshes;  ///< one a slab that has some
  std::vector<InstanceView> parts;
};

/// The instances that rank r of n holds, a run of them, and their numbers.
struct Share {
  std::vector<std::uint64_t> numbers;
  SceneView scene;
};
[[nodiscard]] Share share_of(const Slabs& slabs, std::size_t r, std::size_t n);

/// The constants of LogGP for ranks that are threads of this process, measured here.
struct LogGP {
  double message_us = 0;    ///< of one message, latency and overhead together
  double bytes_per_us = 0;  ///< of large ones
};
[[nodiscard]] LogGP measure_messages(bool quick);

/// What up to 16,384 ranks would send, counted one rank after another, and how long that would
/// take. False where the counts are not those that ranks of this process have.
[[nodiscard]] bool add_simulated(Document& document, const Mesh& mesh, int width, int height,
                                 bool quick);

}  // namespace rastrum::bench
