// SPDX-License-Identifier: BSD-3-Clause
// Feeds random text to one parser of the program's options or files, which is chosen when
// compiling. An Error or a UsageError is a right answer.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include <apps/rastrum/job/camera_path.hpp>
#include <apps/rastrum/job/terrain_path.hpp>
#include <apps/rastrum/parse/arguments.hpp>
#include <apps/rastrum/parse/input_spec.hpp>
#include <apps/rastrum/parse/light_options.hpp>
#include <rastrum/error.hpp>
#include <rastrum/render.hpp>
#include <rastrum/terrain_light.hpp>

namespace {

using namespace rastrum;

[[maybe_unused]] void require(bool sound) {
  if (!sound) std::abort();
}

[[maybe_unused]] std::filesystem::path written(const std::string& text) {
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() /
      ("rastrum_fuzz_" + std::to_string(::getpid()) + ".json");
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

void run(const std::string& text) {
#if defined(RASTRUM_FUZZ_camera_path)
  const auto file = written(text);
  const cli::CameraPath path = cli::read_camera_path(file, Camera{});
  require(path.first_s() <= path.last_s());
  for (const double share : {0.0, 0.3, 1.0}) {
    const double time = path.first_s() + share * (path.last_s() - path.first_s());
    (void)path.at(time);
  }
  (void)cli::read_terrain_path(file, {});
#elif defined(RASTRUM_FUZZ_light_spec)
  // The renderer must take every parsed light or throw. Skips environments, which are large files.
  if (text.find("environment") != std::string::npos) return;
  FrameOptions frame;
  frame.lights.push_back(cli::parse_light(text));
  check(frame);
#elif defined(RASTRUM_FUZZ_input_spec)
  const cli::InputSpec spec = cli::parse_input(text);
  require(spec.look.opacity >= 0 && spec.look.opacity <= 1 && spec.placement.scale != 0);
  if (spec.source.starts_with(cli::kBuiltin) && text.size() < 40)
    (void)cli::parse_input(spec.source);
#elif defined(RASTRUM_FUZZ_formula)
  const terrain::HeightRange range = terrain::sampled_range(terrain::expression_function(text));
  require(range.low <= range.high);
#else
#error "which text?"
#endif
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    run(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const rastrum::Error&) {
  } catch (const rastrum::cli::UsageError&) {
  }
  return 0;
}
