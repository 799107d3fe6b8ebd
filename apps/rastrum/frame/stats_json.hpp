// SPDX-License-Identifier: BSD-3-Clause
// Pictures in numbers and words: --stats says what the frames were and how long they took, and a
// line on stderr the gist.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <rastrum/family.hpp>
#include <rastrum/ranks.hpp>

#include "job/inputs.hpp"

namespace rastrum::cli {

/// The index of the frame whose time is the median: of an even number the faster of the middle
/// two, so that its stages add up to the time that is reported.
[[nodiscard]] std::size_t median_frame(std::span<const FrameStats> frames);

/// The times of stages in ms; those of one name are added up.
[[nodiscard]] nlohmann::ordered_json stages_json(std::span<const StageTime> stages);

/// The object of the issue: counts are the same in every frame, `stages_ms` are of the median
/// frame, `peak_bytes` is the largest of all. Requires a frame.
[[nodiscard]] nlohmann::ordered_json stats_json(std::span<const FrameStats> frames,
                                                const family::Options& options, double load_ms);

/// The work of one of several ranks.
struct RankNumbers {
  double load_ms = 0, frame_ms = 0, primitives = 0, words = 0, won = 0, fragments = 0,
         peak_bytes = 0;
};
/// The object for one picture of several ranks: numbers of the whole picture, and the least, mean
/// and greatest of the ranks' own numbers.
[[nodiscard]] nlohmann::ordered_json stats_json(std::span<const RankNumbers> of_ranks,
                                                const RanksStats& root,
                                                const FrameOptions& options);

/// Adds what was drawn and from where, a camera for each picture.
void add_inputs_and_cameras(nlohmann::ordered_json& json, std::span<const InputPart> inputs,
                            std::span<const Camera> cameras);

/// Parts of a line: "640x480", "640x480, 12 triangles", "3.1 ms".
[[nodiscard]] std::string size_of(const FrameOptions& frame);
[[nodiscard]] std::string summary(const FrameOptions& frame, std::uint64_t triangles);
[[nodiscard]] std::string milliseconds(double ms);
/// The warning about triangles that are left out.
[[nodiscard]] std::string missing_triangles(std::uint64_t missing, std::uint64_t triangles);

}  // namespace rastrum::cli
