// What each rank of MPI runs: a picture of parts dealt to all ranks equals one renderer's in all
// targets, by both exchanges, and what fails on one rank is said by all.
#include <cstdio>
#include <string>
#include <vector>

#include <rastrum/mpi/mpi_ranks.hpp>

#include "tests/ranks/parts_picture.hpp"

namespace rastrum::test {
namespace {

constexpr std::uint64_t kParts = 12;

/// Of this rank: parts rank, rank + size, … The picture is the last rank's.
bool equals_one_renderer(int rank, int size, Shader shader, bool with_materials, bool translucent,
                         WordExchange exchange, int samples = 1) {
  PartsScene scene(5, kParts, with_materials);
  for (std::size_t p = 0; translucent && p < kParts; p += 2)
    scene.scene.instances[p].opacity = 0.4F;
  const SceneBinding binding(scene.scene);
  const Camera camera = fit_camera(binding.view(), 1.0472F, false);
  FrameOptions frame;
  frame.width = 90;
  frame.height = 61;
  frame.shader = shader;
  frame.samples = samples;
  const bool linear = shader == Shader::material;
  const AllTargets one(frame.width, frame.height, linear), many(frame.width, frame.height, linear);
  std::vector<InstanceView> instances;
  std::vector<std::uint64_t> parts;
  for (auto p = static_cast<std::uint64_t>(rank); p < kParts;
       p += static_cast<std::uint64_t>(size)) {
    instances.push_back(binding.view().instances[p]);
    parts.push_back(p);
  }
  SceneView own = binding.view();
  own.instances = instances;
  Renderer renderer({.threads = 1});
  RanksOptions options;
  options.root = size - 1;
  options.exchange = exchange;
  options.fragment_bytes = 200'000;  // several bands
  (void)mpi::render(MPI_COMM_WORLD, renderer, own, parts, camera, frame,
                    rank == options.root ? many.targets() : Targets{}, options);
  if (rank != options.root) return true;
  (void)renderer.render(binding.view(), camera, frame, one.targets());
  const testing::AssertionResult same = same_targets(one.targets(), many.targets());
  if (!same) std::fprintf(stderr, "%d ranks: %s\n", size, same.message());
  return static_cast<bool>(same);
}

/// Each rank in its turn has a part that cannot be drawn.
bool all_say_the_same(int rank, int size, int failing) {
  FrameOptions frame;
  frame.width = frame.height = 20;
  Mesh mesh = shapes::soup(3);
  mesh.indices = {0, 1, 1000};
  const InstanceView instance{.geometry = mesh.view()};
  SceneView own;
  const auto part = static_cast<std::uint64_t>(rank);
  if (rank == failing) own.instances = std::span(&instance, 1);
  Renderer renderer({.threads = 1});
  try {
    (void)mpi::render(MPI_COMM_WORLD, renderer, own, std::span(&part, own.instances.size()),
                      Camera{.eye = {0, 0, 3}}, frame, {});
  } catch (const Error& e) {
    const std::string begin = "rank " + std::to_string(failing) + ": ";
    if (std::string(e.what()).starts_with(begin)) return true;
    std::fprintf(stderr, "rank %d of %d says: %s\n", rank, size, e.what());
  }
  return false;
}

int run() {
  int rank = 0, size = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  bool ok = true;
  for (const WordExchange exchange : {WordExchange::automatic, WordExchange::dense,
                                      WordExchange::sparse, WordExchange::two_hops}) {
    for (const bool translucent : {false, true}) {
      ok &= equals_one_renderer(rank, size, Shader::phong, false, translucent, exchange);
      ok &= equals_one_renderer(rank, size, Shader::material, true, translucent, exchange);
      ok &= equals_one_renderer(rank, size, Shader::id, false, translucent, exchange);
    }
  }
  ok &= equals_one_renderer(rank, size, Shader::phong, false, false, WordExchange::automatic, 4);
  ok &= equals_one_renderer(rank, size, Shader::material, true, true, WordExchange::automatic, 4);
  for (int failing = 0; failing < size; ++failing) ok &= all_say_the_same(rank, size, failing);
  return ok ? 0 : 1;
}

}  // namespace
}  // namespace rastrum::test

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const int result = rastrum::test::run();
  MPI_Finalize();
  return result;
}
