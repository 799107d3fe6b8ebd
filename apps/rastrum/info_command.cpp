// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <rastrum/io.hpp>

#include "commands.hpp"
#include "job/inputs.hpp"
#include "parse/scene_options.hpp"

namespace rastrum::cli {
namespace {

struct InfoArguments {
  std::vector<std::string> inputs;
  InputReading reading;
};

int run(const InfoArguments& a) {
  check_inputs(a.inputs, a.reading.format);
  for (const std::string& input : a.inputs)
    std::printf("%s\n%s", input.c_str(), io::describe(load_input(input, a.reading)).c_str());
  return 0;
}

}  // namespace

Command add_info_command(Parser& app) {
  auto arguments = std::make_shared<InfoArguments>();
  Parser info = app.add_subcommand("info", "Print what files hold");
  info.add_option("INPUT", arguments->inputs,
                  "files and builtin:SHAPE[?name=value,...]; - is standard input")
      ->required()
      ->type_name("");
  add_reading_options(info, arguments->reading);
  info.footer(
      "Examples:\n"
      "  rastrum info scene.glb\n"
      "  rastrum info *.stl builtin:teapot");
  return {info, [arguments] { return run(*arguments); }};
}

}  // namespace rastrum::cli
