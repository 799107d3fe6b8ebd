// SPDX-License-Identifier: BSD-3-Clause
// Draws a scene by every way of transparency, ours and the peers'. Each picture is compared with
// its reference before the timing; then all take turns.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <bench/floor.hpp>
#include <bench/measure.hpp>
#include <bench/peers/compare.hpp>
#include <bench/peers/gl_transparency.hpp>
#include <bench/peers/selection.hpp>
#include <bench/peers/started.hpp>
#include <bench/peers/vtk_peer.hpp>
#include <rastrum/family.hpp>
#include <rastrum/render.hpp>

namespace rastrum::bench {

/// Our ways. All are compared with the first, which is exact.
struct Technique {
  std::string_view name;
  TransparencyOptions options;
};
inline const std::array<Technique, 9> kTechniques{{{"exact", {Transparency::exact}},
                                                   {"unsorted", {Transparency::unsorted}},
                                                   {"filter:3", family::filtered(3)},
                                                   {"filter:8", family::filtered(8)},
                                                   {"filter:12", family::filtered(12)},
                                                   {"wboit", family::wboit()},
                                                   {"mboit4", family::mboit4()},
                                                   {"mboit6", family::mboit6()},
                                                   {"mlab4", family::mlab4()}}};
inline constexpr std::size_t kExact = 0, kUnsorted = 1, kFilter3 = 2;
/// The techniques of a CUDA device, as indices of kTechniques.
inline constexpr std::array kOnDevice{kExact, kUnsorted};

/// The peers, in the order of TransparencyRow::peers.
enum Peer : std::size_t { kGlUnsorted, kGlLists, kGlPeeling, kVtkPeeling, kPeerCount };
inline constexpr std::array<std::string_view, kPeerCount> kPeerNames{
    "llvmpipe unsorted", "llvmpipe lists", "llvmpipe peeling", "VTK peeling"};

/// Opacities at which alpha thresholds are measured.
inline constexpr std::array<float, 2> kThresholdOpacities{0.5F, 0.9F};

/// One contender's result.
struct Lap {
  std::string name;
  std::string not_run;             ///< the reason; empty if it ran
  bool wrong = false;              ///< its picture is wrong: `not_run` says how
  bool at_least = false;           ///< it was stopped early: `timing` is a lower bound
  int passes = 1;                  ///< over the geometry
  PictureError error;              ///< from exact; for unsorted peers, from our unsorted
  std::uint64_t wrong_pixels = 0;  ///< for filters: pixels blended in another order
  FrameStats stats;                ///< for our ways
  Timing timing;

  [[nodiscard]] bool ran() const { return not_run.empty() && !timing.samples_ms.empty(); }
};

/// `a`'s time over `b`'s, the median over rounds; 0 if one did not run.
[[nodiscard]] double ratio(const Lap& a, const Lap& b);

struct TransparencyRow {
  std::string scene;
  Size size;
  Workload work;
  Floor floor;                     ///< of exact
  std::uint64_t deepest = 0;       ///< the most fragments of a pixel
  std::uint64_t opaque_bytes = 0;  ///< scratch of the same frame with opaque surfaces
  double samples_per_block = 0;    ///< fragments over (piece, 8 × 8 block) pairs
  std::vector<Lap> ours;           ///< kTechniques
  std::vector<Lap> peers;          ///< kPeerNames
  std::vector<Lap> thresholds;     ///< for each opacity: exact without and with the threshold
  std::vector<Lap> device;         ///< kOnDevice on CUDA, or empty
  double device_floor_ms = 0;      ///< of exact there, bytes alone

  [[nodiscard]] bool right() const;
  /// Bytes of per-pixel lists: nodes and heads.
  [[nodiscard]] std::uint64_t list_bytes() const;
};

struct TransparencyPeers {
  Started<GlTransparency> gl;
  Started<VtkPeer> vtk;
};

struct TransparencyPlan {
  Plan plan;
  int threads = 2;
  float opacity = 0.5F;
  /// Peeling is stopped after this. VTK's then does not start.
  double patience_ms = 20000;
  MachineLimits machine;
  bool on_cuda = false;  ///< the device's techniques take turns with the threads'
  MachineLimits device = {};
};

/// The mesh has vertex normals that share its indices. The peers have loaded it.
[[nodiscard]] TransparencyRow measure_transparency(const Mesh& mesh, Size size,
                                                   TransparencyPeers& peers,
                                                   const TransparencyPlan& plan);

}  // namespace rastrum::bench
