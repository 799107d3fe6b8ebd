// SPDX-License-Identifier: BSD-3-Clause
// Pictures in numbers and words, for --stats and a line on stderr.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <rastrum/family.hpp>
#include <rastrum/ranks.hpp>

#include "job/inputs.hpp"

namespace rastrum::cli {

/// The frame with the median time: of an even number the faster of the middle two, so that its
/// stages add up to the reported time.
[[nodiscard]] std::size_t median_frame(std::span<const FrameStats> frames);

/// In ms; stages of one name are added up.
[[nodiscard]] nlohmann::ordered_json stages_json(std::span<const StageTime> stages);

/// Counts are the same in every frame, `stages_ms` are the median frame's, `peak_bytes` is the
/// largest of all. Requires a frame.
[[nodiscard]] nlohmann::ordered_json stats_json(std::span<const FrameStats> frames,
                                                const family::Options& options, double load_ms);

struct RankNumbers {
  double load_ms = 0, frame_ms = 0, primitives = 0, words = 0, won = 0, fragments = 0,
         peak_bytes = 0;
};
/// For one picture of several ranks: numbers of the whole picture, and the least, mean and greatest
/// of the ranks' own.
[[nodiscard]] nlohmann::ordered_json stats_json(std::span<const RankNumbers> of_ranks,
                                                const RanksStats& root,
                                                const FrameOptions& options);

/// Adds the inputs, and a camera for each picture.
void add_inputs_and_cameras(nlohmann::ordered_json& json, std::span<const InputPart> inputs,
                            std::span<const Camera> cameras);

/// Parts of a line: "640x480", "640x480, 12 triangles", "3.1 ms".
[[nodiscard]] std::string size_of(const FrameOptions& frame);
[[nodiscard]] std::string summary(const FrameOptions& frame, std::uint64_t triangles);
[[nodiscard]] std::string milliseconds(double ms);
/// A warning about dropped triangles.
[[nodiscard]] std::string missing_triangles(std::uint64_t missing, std::uint64_t triangles);

}  // namespace rastrum::cli
