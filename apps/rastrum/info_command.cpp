// `rastrum info FILE…`: what a file holds.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <rastrum/io/report.hpp>

#include "commands.hpp"
#include "inputs.hpp"

namespace rastrum::cli {

Command add_info_command(Parser& app) {
  auto inputs = std::make_shared<std::vector<std::string>>();
  Parser info = app.add_subcommand("info", "Print what files hold");
  info.add_option("INPUT", *inputs, "files and builtin:SHAPE[?name=value,...]")
      ->required()
      ->type_name("");
  info.footer(
      "Examples:\n"
      "  rastrum info scene.glb\n"
      "  rastrum info *.stl builtin:teapot");
  return {info, [inputs] {
            for (const std::string& input : *inputs)
              std::printf("%s\n%s", input.c_str(), io::describe(load_input(input)).c_str());
            return 0;
          }};
}

}  // namespace rastrum::cli
