// SPDX-License-Identifier: BSD-3-Clause
#include "stats_json.hpp"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <numeric>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/version.hpp>

#include "job/camera_path.hpp"

namespace rastrum::cli {
namespace {

/// Threads that take part in a frame with these options.
int thread_count(const RendererOptions& options, std::string_view rasterizer) {
  if (options.device == Device::serial || rasterizer == "reference") return 1;
  return parallel::Threads(options.threads).concurrency();
}

}  // namespace

std::size_t median_frame(std::span<const FrameStats> frames) {
  std::vector<std::size_t> order(frames.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>((frames.size() - 1) / 2);
  std::nth_element(order.begin(), middle, order.end(), [&](std::size_t a, std::size_t b) {
    return frames[a].frame_ms < frames[b].frame_ms;
  });
  return *middle;
}

nlohmann::ordered_json stages_json(std::span<const StageTime> stages) {
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (const StageTime& stage : stages) {
    nlohmann::ordered_json& ms = all[stage.name];
    ms = (ms.is_null() ? 0.0 : ms.get<double>()) + (stage.end_ms - stage.begin_ms);
  }
  return all;
}

nlohmann::ordered_json stats_json(std::span<const FrameStats> frames,
                                  const family::Options& options, double load_ms) {
  assert(!frames.empty());
  const FrameStats& median = frames[median_frame(frames)];
  const auto by_time = [](const FrameStats& a, const FrameStats& b) {
    return a.frame_ms < b.frame_ms;
  };
  const auto [fastest, slowest] = std::minmax_element(frames.begin(), frames.end(), by_time);
  std::uint64_t peak_bytes = 0;
  for (const FrameStats& f : frames) peak_bytes = std::max(peak_bytes, f.peak_bytes);

  nlohmann::ordered_json counters = nlohmann::ordered_json::object();
  for (const auto& [name, value] : median.counters) counters[name] = value;
  const FrameStats::Triangles& t = median.triangles;
  return {{"version", version()},
          {"device", name(median.device)},
          {"device_why", median.device_why},
          {"threads", thread_count(options, median.rasterizer)},
          {"isa", name(median.isa)},
          {"rasterizer", median.rasterizer},
          {"visibility", median.visibility},
          {"why", median.why},
          {"shader", median.shader},
          {"size", {options.width, options.height}},
          {"triangles",
           {{"input", t.input},
            {"dropped", t.dropped},
            {"culled", t.culled},
            {"clipped", t.clipped},
            {"drawn", t.drawn}}},
          {"fragments", median.fragments},
          {"pixels_covered", median.pixels_covered},
          {"counters", std::move(counters)},
          {"peak_bytes", peak_bytes},
          {"load_ms", load_ms},
          {"stages_ms", stages_json(median.stages)},
          {"frame_ms",
           {{"median", median.frame_ms},
            {"min", fastest->frame_ms},
            {"max", slowest->frame_ms},
            {"frames", frames.size()}}}};
}

nlohmann::ordered_json stats_json(std::span<const RankNumbers> of_ranks, const RanksStats& root,
                                  const FrameOptions& options) {
  assert(!of_ranks.empty());
  constexpr std::pair<const char*, double RankNumbers::*> kNumbers[] = {
      {"load_ms", &RankNumbers::load_ms},
      {"frame_ms", &RankNumbers::frame_ms},
      {"primitives", &RankNumbers::primitives},
      {"words", &RankNumbers::words},
      {"won", &RankNumbers::won},
      {"fragments", &RankNumbers::fragments},
      {"peak_bytes", &RankNumbers::peak_bytes}};
  nlohmann::ordered_json spread = nlohmann::ordered_json::object();
  for (const auto& [name, number] : kNumbers) {
    double least = of_ranks[0].*number, greatest = least, sum = 0;
    for (const RankNumbers& r : of_ranks) {
      least = std::min(least, r.*number);
      greatest = std::max(greatest, r.*number);
      sum += r.*number;
    }
    spread[name] = {
        {"min", least}, {"mean", sum / static_cast<double>(of_ranks.size())}, {"max", greatest}};
  }
  return {{"version", version()},
          {"ranks", of_ranks.size()},
          {"shader", name(options.shader)},
          {"size", {options.width, options.height}},
          {"primitives", root.primitives},
          {"exchange", name(root.exchange)},
          {"bands", root.bands},
          {"of_ranks", std::move(spread)}};
}

void add_inputs_and_cameras(nlohmann::ordered_json& json, std::span<const InputPart> inputs,
                            std::span<const Camera> cameras) {
  nlohmann::ordered_json& parts = json["inputs"] = nlohmann::ordered_json::array();
  for (const InputPart& part : inputs)
    parts.push_back(
        {{"name", part.name}, {"first_id", part.first_id}, {"triangles", part.triangles}});
  nlohmann::ordered_json& list = json["cameras"] = nlohmann::ordered_json::array();
  for (const Camera& camera : cameras) list.push_back(camera_json(camera, true));
}

std::string size_of(const FrameOptions& frame) {
  return std::to_string(frame.width) + "x" + std::to_string(frame.height);
}

std::string summary(const FrameOptions& frame, std::uint64_t triangles) {
  return size_of(frame) + ", " + std::to_string(triangles) + " triangles";
}

std::string milliseconds(double ms) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f ms", ms);
  return text;
}

std::string missing_triangles(std::uint64_t missing, std::uint64_t triangles) {
  return std::to_string(missing) + " of " + std::to_string(triangles) +
         " triangles have a NaN or infinite vertex and are not drawn";
}

}  // namespace rastrum::cli
