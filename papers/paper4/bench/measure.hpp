// SPDX-License-Identifier: BSD-3-Clause
// A scene drawn by every way of transparency, ours and the peers': each picture is compared with
// the one that it should equal before anything is timed, then all take turns.
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

/// Our ways; the first is exact, which the others are compared with.
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
/// Techniques that a CUDA device has, as indices of kTechniques.
inline constexpr std::array kOnDevice{kExact, kUnsorted};

/// The peers, in the order of TransparencyRow::peers.
enum Peer : std::size_t { kGlUnsorted, kGlLists, kGlPeeling, kVtkPeeling, kPeerCount };
inline constexpr std::array<std::string_view, kPeerCount> kPeerNames{
    "llvmpipe unsorted", "llvmpipe lists", "llvmpipe peeling", "VTK peeling"};

/// Opacities at which alpha thresholds are measured.
inline constexpr std::array<float, 2> kThresholdOpacities{0.5F, 0.9F};

/// How one contender fared.
struct Lap {
  std::string name;
  std::string not_run;             ///< why; empty: it ran
  bool wrong = false;              ///< its picture is not what it should be: `not_run` says so
  bool at_least = false;           ///< it did not come to its end: `timing` is a lower bound
  int passes = 1;                  ///< over the geometry
  PictureError error;              ///< from exact, and of unsorted peers from our unsorted
  std::uint64_t wrong_pixels = 0;  ///< of the filters: blended in another order
  FrameStats stats;                ///< of ours
  Timing timing;

  [[nodiscard]] bool ran() const { return not_run.empty() && !timing.samples_ms.empty(); }
};

/// `a`'s time over `b`'s, the median over rounds; 0 where one did not run.
[[nodiscard]] double ratio(const Lap& a, const Lap& b);

struct TransparencyRow {
  std::string scene;
  Size size;
  Workload work;
  Floor floor;                     ///< of exact
  std::uint64_t deepest = 0;       ///< fragments of the pixel that has most
  std::uint64_t opaque_bytes = 0;  ///< scratch of the same frame with opaque surfaces
  double samples_per_block = 0;    ///< fragments over pieces, in blocks of 8 × 8 that they touch
  std::vector<Lap> ours;           ///< kTechniques
  std::vector<Lap> peers;          ///< kPeerNames
  std::vector<Lap> thresholds;     ///< for each opacity: exact without, exact with the threshold
  std::vector<Lap> device;         ///< kOnDevice on CUDA, or none
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
  /// Peeling is stopped after this, and then VTK's is not begun.
  double patience_ms = 20000;
  MachineLimits machine;
  bool on_cuda = false;  ///< the device's techniques take turns with the threads'
  MachineLimits device = {};
};

/// The mesh has vertex normals that share its indices; the peers have it already.
[[nodiscard]] TransparencyRow measure_transparency(const Mesh& mesh, Size size,
                                                   TransparencyPeers& peers,
                                                   const TransparencyPlan& plan);

}  // namespace rastrum::bench
