// SPDX-License-Identifier: BSD-3-Clause
// `rastrum render INPUT… -o OUT`: options (parse/), then the job (job/), its pictures (frame/),
// their files (files/).
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "commands.hpp"
#include "files/mp4.hpp"
#include "files/picture_files.hpp"
#include "job/large_job.hpp"
#include "job/part_job.hpp"
#include "job/scene_job.hpp"

namespace rastrum::cli {
namespace {

template <class Job>
void draw(Job&& job) {
  write_pictures(job, *frames_of(job));
}

/// If one rank fails, all do, and the first reports it. Returns the exit status.
int draw_part(const RenderArguments& a, RanksOfProgram& program) {
  try {
    draw(PartJob(a, program));
    return 0;
  } catch (const UsageError& e) {
    // All ranks got the same wrong arguments, so one reports them. It does so before MPI ends: a
    // launcher may kill a rank that ends later than a failed one.
    if (program.ranks().rank() == 0)
      std::fprintf(stderr, "rastrum: error: %s\nSee rastrum render --help.\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    // An error that all ranks have agreed on is reported once.
    const bool agreed = std::string_view(e.what()).starts_with("rank ");
    if (!agreed)
      std::fprintf(stderr, "rastrum: error: rank %d: %s\n", program.ranks().rank(), e.what());
    else if (program.ranks().rank() == 0)
      std::fprintf(stderr, "rastrum: error: %s\n", e.what());
    if (!agreed) program.give_up();
    return 1;
  }
}

int run(RenderArguments& a, const StartRanks& start) {
  settle(a);
  if (a.outputs.color.is_film()) Mp4Writer::check(a.render.width, a.render.height);
  if (start) {
    if (const std::unique_ptr<RanksOfProgram> ranks = start(a.timeout_s.value_or(0)))
      return draw_part(a, *ranks);
  }
  if (a.timeout_s)
    throw UsageError("--timeout", "needs several ranks, as in mpirun -n 8 rastrum render");
  check_files(a);
  if (const std::optional<OutOfCoreFile> large = large_input(a))
    draw(LargeJob(a, *large));
  else
    draw(SceneJob(a));
  return 0;
}

}  // namespace

Command add_render_command(Parser& app, StartRanks start) {
  auto arguments = std::make_shared<RenderArguments>();
  Parser render = app.add_subcommand("render", "Draw meshes and shapes into an image file");
  add_render_options(render, *arguments);
  std::string footer = shapes_help();
  footer +=
      "\nTimes: a frame goes from the mesh in memory to the finished 8-bit image in memory. With\n"
      "--frames, --stats or --trace the timed frames fill that image alone, and one more pass,\n"
      "which is not timed, fills the others; without them one pass fills all.\n"
      "\nExamples:\n"
      "  rastrum render bunny.obj -o bunny.png\n"
      "  rastrum render scene.glb --camera 0 --size 1920x1080 --background '#20242c' -o scene.png\n"
      "  rastrum render a.stl b.ply --eye 3,2,5 --target 0,0,0 --depth d.npy --ids i.npy -o c.exr\n"
      "  rastrum render builtin:teapot 'builtin:sphere?x=3,scale=0.5' --shader normal -o two.png\n"
      "  rastrum render part.stl -o part.png\n"
      "  rastrum render part.stl --lights studio --light point:0,2,1:intensity=3 -o lit.png\n"
      "  rastrum render scan.ply --scalars quality --cmap turbo --bar Quality -o quality.png\n"
      "  rastrum render part.stl --bounds --axes --occlusion --title 'Part 7' -o part.png\n"
      "  rastrum render engine.glb --opacity 0.3 --samples 4 -o see_through.png\n"
      "  rastrum render hair.ply --opacity 0.5 --transparency filter:3 --show-errors wrong.png\n"
      "  rastrum render dragon.ply --frames 20 --stats - --trace frames.json --heatmap heat.png\n"
      "  rastrum render fox.glb --animation 1 --time 0.4 -o running.png\n"
      "  rastrum render dragon.ply --path flight.json --fps 60 -o 'frame_%04d.png'\n"
      "  rastrum render shell.ply@opacity=0.3,color=#88aaff core.stl@z=0.2,rx=90 -o glass.png\n"
      "  rastrum render dragon.ply --turntable 120 -o dragon.mp4\n"
      "  rastrum render scan.ply --memory-limit 2G -o scan.png\n"
      "  mpirun -n 8 rastrum render part_*.ply -o all.png\n"
      "  rastrum render a.stl b.stl --depth d.npy --depth-unit world --objects o.npy\n"
      "  rastrum make sphere -o - | rastrum render - --format ply -o - | display";
  render.footer(footer);
  return {render, [arguments, start = std::move(start)] { return run(*arguments, start); }};
}

}  // namespace rastrum::cli
