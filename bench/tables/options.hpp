// SPDX-License-Identifier: BSD-3-Clause
// The options of all benches of tables.
#pragma once

#include <algorithm>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <bench/contest.hpp>
#include <bench/measure.hpp>
#include <bench/options.hpp>
#include <bench/tables/document.hpp>

namespace rastrum::bench {

struct TableOptions {
  int rounds = 9, threads = 0;
  std::string mesh, out;
  bool quick = false;
  Device device = Device::threads;  ///< cuda: beside the threads
  std::string gpu = {};             ///< the GPU's name

  /// Adds the options to `parser`, parses and resolves. Returns the exit status if there is nothing
  /// to run. Throws Error{no_device} if the device is not available.
  [[nodiscard]] std::optional<int> read(OptionParser& parser,
                                        std::span<const std::string_view> arguments,
                                        bool takes_mesh = false);
  /// --device, for tables that can add a GPU's figures.
  void add_device(OptionParser& parser);

  /// Call this after parsing. Throws Error{no_device} if the device is not available.
  void resolve();
  [[nodiscard]] bool on_cuda() const { return device == Device::cuda; }
  [[nodiscard]] static int cores() {
    return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  }
  [[nodiscard]] Plan plan() const { return {rounds, quick ? 1.0 : 30.0}; }
  /// A published edge of a picture, or a smoke test's smaller one.
  [[nodiscard]] int size(int px) const { return quick ? std::max(8, px / 8) : px; }
  [[nodiscard]] FrameOptions frame(int width_px, int height_px) const {
    return {.width = size(width_px), .height = size(height_px)};
  }
  [[nodiscard]] std::size_t triangles(std::size_t n) const {
    return quick ? std::max<std::size_t>(64, n / 32) : n;
  }
  [[nodiscard]] std::string here() const {
    return "here, " + std::to_string(threads) + (threads == 1 ? " thread" : " threads") +
           (gpu.empty() ? "" : " and " + gpu);
  }
  /// The same after the frame's size.
  [[nodiscard]] std::string here(const FrameOptions& frame) const {
    return std::to_string(frame.width) + " × " + std::to_string(frame.height) + ", " + here();
  }
  /// A document without tables; a smoke test's has a warning.
  [[nodiscard]] Document document(std::string name, std::string title) const;
  [[nodiscard]] Plot plot(const Document& document, std::string x_title, std::string y_title) const;
  [[nodiscard]] family::Options render() const {
    family::Options options;
    options.threads = threads;
    options.shader = Shader::id;  // for the façade's shader: one colour a triangle
    return options;
  }
};

/// A rasterizer by name, a visibility (or auto) and a tuning.
[[nodiscard]] inline Entrant entrant(const TableOptions& options, const std::string& rasterizer,
                                     const std::string& visibility = "auto",
                                     family::Tuning tuning = {}) {
  Entrant e{rasterizer + (visibility == "auto" ? "" : " × " + visibility), options.render()};
  e.options.rasterizer = rasterizer;
  e.options.visibility = visibility;
  e.options.tuning = tuning;
  return e;
}

/// A GPU's entrants, for subjects of the façade's shaders: a paper's own rasterizer with arrays and
/// picture in GPU memory; the default with copies to it and of the picture back in each frame; and
/// the default with both in GPU memory.
[[nodiscard]] inline std::vector<Entrant> device_entrants(const TableOptions& options,
                                                          Entrant papers) {
  papers.name.append(", cuda, in place");
  papers.options.device = Device::cuda;
  papers.in_place = true;
  Entrant copied{"cuda", options.render()};
  copied.options.device = Device::cuda;
  Entrant in_place = copied;
  in_place.name = "cuda, in place";
  in_place.in_place = true;
  return {std::move(papers), std::move(copied), std::move(in_place)};
}

/// Says on stderr what is measured now, because tables come at the end.
inline void progress(const std::string& what) {
  std::fprintf(stderr, "  %s\n", what.c_str());
}

}  // namespace rastrum::bench
