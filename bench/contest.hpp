// SPDX-License-Identifier: BSD-3-Clause
// Compares rasterizers on one picture: their ids are compared first, then their frames are timed in
// turns (measure.hpp).
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/error.hpp>
#include <rastrum/family.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/raster/draws/geometry.hpp>
#include <rastrum/render.hpp>

#include "measure.hpp"
#include "tables/comparison.hpp"

namespace rastrum::bench {

/// The frame that all entrants draw. The mesh must outlive it.
struct Subject {
  MeshView mesh;
  Camera camera;
  int width = 0, height = 0;
  /// Makes 8-bit colours; null: grey = depth³, paper 1's shading.
  const raster::BlockShader* shader = nullptr;
  /// Uses the façade's shader of the entrant's options instead, which a device has too.
  bool facade_shader = false;
};

/// One colour per triangle, hashed from its id: what paper 5 draws, and cheap.
[[nodiscard]] const raster::BlockShader& triangle_colors();

struct Entrant {
  std::string name;
  family::Options options;  ///< the size is the subject's
  bool in_place = false;    ///< arrays and picture stay in a device's memory
};

struct Result {
  std::string name;
  std::string not_run;  ///< the reason; empty if it ran
  bool wrong = false;   ///< its ids differ from the default's, as `not_run` says
  FrameStats stats;     ///< of a frame in the middle of the run
  Timing timing;
  std::vector<std::pair<std::string, double>> stages_ms;  ///< medians; equal names are added up

  [[nodiscard]] bool ran() const { return not_run.empty(); }
  [[nodiscard]] double median_ms() const { return ran() ? timing.median_ms() : 0; }
};
[[nodiscard]] inline bool all_right(std::span<const Result> results) {
  return std::ranges::none_of(results, &Result::wrong);
}

/// Draws one frame of `subject`, at its size.
FrameStats draw(Renderer& renderer, const Subject& subject, FrameOptions frame,
                const Targets& targets, const Pass& pass = {});

/// FNV-1a over whole words.
[[nodiscard]] std::uint64_t hash_of(std::span<const std::uint64_t> words);

struct Fingerprint {
  std::uint64_t ids = 0;
  FrameStats stats;
};
[[nodiscard]] Fingerprint fingerprint(const Subject& subject, const Entrant& entrant);

/// Why an entrant could not run: "absent" for a name that this build lacks, else the message.
[[nodiscard]] std::string why_not(const Error& e);

/// Returns a result for each entrant, in order. Each first draws the subject alone. It is not timed
/// if its ids differ from the default's (rasterizer and visibility `auto`), if this build lacks its
/// names or sizes, or if it runs out of memory; `not_run` says why. An entrant whose first frame
/// takes longer than `hopeless` times the fastest one's has that frame as its only sample.
[[nodiscard]] std::vector<Result> contest(const Subject& subject, std::span<const Entrant> entrants,
                                          const Plan& plan, double hopeless = 1e9);

/// A result as a figure in ms; with `memory` also the bytes of mesh, picture and scratch.
[[nodiscard]] Measured measured_ms(const Result& result, const Subject& subject, bool memory);
/// The same in frames a second.
[[nodiscard]] Measured measured_fps(const Result& result, const Subject& subject);

}  // namespace rastrum::bench
