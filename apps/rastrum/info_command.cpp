// `rastrum info FILE…`: what a file holds.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "inputs.hpp"
#include "progress.hpp"

namespace rastrum::cli {
namespace {

void print(const std::string& input, const Scene& scene) {
  const SceneBinding binding(scene);
  const Bounds box = bounds(binding.view());
  std::printf("%s\n  meshes %zu, instances %zu, triangles %llu\n", input.c_str(),
              scene.meshes.size(), scene.instances.size(),
              static_cast<unsigned long long>(scene.triangle_count()));
  std::printf("  materials %zu, textures %zu, cameras %zu\n", scene.materials.size(),
              scene.textures.size(), scene.cameras.size());
  if (box.vertices_in_use != 0)
    std::printf("  bounds (%g, %g, %g) to (%g, %g, %g), %llu vertices in use\n",
                static_cast<double>(box.min.x), static_cast<double>(box.min.y),
                static_cast<double>(box.min.z), static_cast<double>(box.max.x),
                static_cast<double>(box.max.y), static_cast<double>(box.max.z),
                static_cast<unsigned long long>(box.vertices_in_use));
}

}  // namespace

Command add_info_command(CLI::App& app) {
  auto inputs = std::make_shared<std::vector<std::string>>();
  CLI::App& info = *app.add_subcommand("info", "Print what files hold");
  info.add_option("INPUT", *inputs, "files and builtin:SHAPE[?name=value,...]")
      ->required()
      ->type_name("");
  info.footer(
      "Examples:\n"
      "  rastrum info scene.glb\n"
      "  rastrum info *.stl builtin:teapot");
  return {&info, [inputs] {
            for (const std::string& input : *inputs) {
              const Scene scene = load_input(input);
              print(input, scene);
              for (const std::string& w : scene.warnings) warn(w);
            }
            return 0;
          }};
}

}  // namespace rastrum::cli
