// SPDX-License-Identifier: BSD-3-Clause
#include "options.hpp"

#include <apps/command_line/choose.hpp>
#include <rastrum/parallel/cuda/status.hpp>
#include <rastrum/parallel/device.hpp>

namespace rastrum::bench {

std::optional<int> TableOptions::read(OptionParser& parser,
                                      std::span<const std::string_view> arguments,
                                      bool takes_mesh) {
  if (takes_mesh)
    parser
        .add_option("--mesh", mesh,
                    "a mesh for all columns, brought to each column's number of triangles "
                    "(default: generated balls)")
        ->type_name("FILE");
  parser.add_option("--out", out, "write NAME.md, NAME.json and NAME.svg into FOLDER")
      ->type_name("FOLDER");
  parser
      .add_option("--rounds", rounds, "rounds of A B C … (default: " + std::to_string(rounds) + ")")
      ->range(1, 1000);
  parser.add_option("--threads", threads, "number of threads (default: all)")->range(1, 1024);
  parser.add_flag(
      "--quick", quick,
      "a smoke test: 1 round, pictures of an eighth of the edge, a 32nd of the triangles");
  if (const auto status = parser.parse(arguments)) return status;
  resolve();
  return {};
}

void TableOptions::add_device(OptionParser& parser) {
  parser.add("--device", "NAME", "cuda: a GPU's figures beside those of the threads (threads)",
             [this](const std::string& s) {
               device = cli::choose<Device>("--device", s,
                                            {{"threads", Device::threads}, {"cuda", Device::cuda}});
             });
}

void TableOptions::resolve() {
  if (threads == 0) threads = cores();
  if (quick) rounds = 1;
  static_cast<void>(choose_device(device));
  if (on_cuda()) gpu = parallel::cuda_status().name;
}

Document TableOptions::document(std::string name, std::string title) const {
  Document made{std::move(name), std::move(title)};
  if (quick)
    made.notes.emplace_back(
        "**A smoke test: pictures and meshes are smaller than the paper's, and no figure here may "
        "be "
        "compared with it.**");
  return made;
}

Plot TableOptions::plot(const Document& document, std::string x_title, std::string y_title) const {
  Plot made;
  made.title = document.title;
  made.note = here();
  made.x_title = std::move(x_title);
  made.y_title = std::move(y_title);
  return made;
}

}  // namespace rastrum::bench
