#include "options.hpp"

#include <map>

#include <rastrum/parallel/cuda/status.hpp>
#include <rastrum/raster/cuda/rasterizer.hpp>

namespace rastrum::bench {

void TableOptions::add_to(OptionParser& parser, bool takes_mesh) {
  CLI::App& app = parser.app();
  if (takes_mesh)
    app.add_option("--mesh", mesh,
                   "a mesh for all columns, brought to each column's number of triangles "
                   "(generated balls)")
        ->type_name("FILE");
  app.add_option("--out", out, "write NAME.md, NAME.json and NAME.svg into FOLDER")
      ->type_name("FOLDER");
  app.add_option("--rounds", rounds, "rounds of A B C … (9)")->check(CLI::Range(1, 1000));
  app.add_option("--threads", threads, "threads (all)")->check(CLI::Range(1, 1024));
  app.add_flag("--quick", quick,
               "a smoke test: 1 round, pictures of an eighth of the edge, a 32nd of the triangles");
}

void TableOptions::add_device(OptionParser& parser) {
  parser.app()
      .add_option("--device", device, "cuda: a GPU's figures beside those of the threads (threads)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Device>{{"threads", Device::threads}, {"cuda", Device::cuda}}));
}

void TableOptions::resolve() {
  if (threads == 0) threads = cores();
  if (quick) rounds = 1;
  static_cast<void>(choose_device(device, raster::draws_on_cuda()));
  if (on_cuda()) gpu = parallel::cuda_status().name;
}

}  // namespace rastrum::bench
