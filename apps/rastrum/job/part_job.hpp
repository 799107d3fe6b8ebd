// SPDX-License-Identifier: BSD-3-Clause
// The job of one of several ranks. Each reads its own inputs; the first writes the files that one
// process would have written.
#pragma once

#include <optional>
#include <vector>

#include "ranks_of_program.hpp"
#include "render_job.hpp"

namespace rastrum::cli {

struct PartJob : RenderJob {
  /// If one rank fails, all do. Refuses by name options that ranks lack.
  PartJob(const RenderArguments& a, RanksOfProgram& program);

  void in_writer(std::string_view phase, const std::function<void()>& f) override;
  [[nodiscard]] bool is_writer() const { return ranks.rank() == 0; }

  Communicator& ranks;
  std::optional<Renderer> renderer;
  Inputs inputs;  ///< of this rank
  std::optional<SceneBinding> binding;
  std::vector<std::uint64_t> instance_ids;  ///< of its instances, among all ranks'
  std::vector<std::size_t> rank_of_input;   ///< for each of `parts`

 private:
  void load();
  void agree_on_scene(const std::vector<std::uint64_t>& firsts);
  void show_numbers();
  void light();
  void place_camera();
};

}  // namespace rastrum::cli
