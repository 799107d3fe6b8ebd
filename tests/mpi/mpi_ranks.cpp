// SPDX-License-Identifier: BSD-3-Clause
// Runs on each rank of MPI: a picture of parts on all ranks equals one renderer's in all targets,
// by each exchange, and all ranks report an error of one rank.
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/mpi/mpi_ranks.hpp>

#include "tests/ranks/parts_picture.hpp"

namespace rastrum::test {
namespace {

using mpi::MpiRanks;

constexpr std::uint64_t kParts = 12;

/// If this returns true, MPI_Win_allocate_shared (below) fails.
std::function<bool()> without_window;

struct Way {
  Shader shader = Shader::phong;
  bool with_materials = false, translucent = false;
  WordExchange exchange = WordExchange::automatic;
  int samples = 1;
  std::optional<WordExchange> taken{};
  std::uint64_t fragment_bytes = 200'000;  ///< several bands
};

/// This rank has parts rank, rank + size, … The last rank gets the picture.
bool equals_one_renderer(MpiRanks& ranks, const Way& way) {
  const int rank = ranks.rank(), size = ranks.size();
  Scene scene = PartsScene(5, kParts, way.with_materials).scene;
  for (std::size_t p = 0; way.translucent && p < kParts; p += 2) scene.instances[p].opacity = 0.4F;
  const Whole whole(std::move(scene),
                    {.width = 90, .height = 61, .shader = way.shader, .samples = way.samples});
  std::vector<std::uint64_t> parts;
  for (int p = rank; p < static_cast<int>(kParts); p += size)
    parts.push_back(static_cast<std::uint64_t>(p));
  const AllTargets many = whole.images();
  RanksOptions options{
      .root = size - 1, .exchange = way.exchange, .fragment_bytes = way.fragment_bytes};
  const RanksStats stats = whole.draw_on(ranks, parts, many.targets(), options, kThreadRank);
  if (way.taken && stats.exchange != *way.taken) {
    std::fprintf(stderr, "rank %d of %d took %s\n", rank, size, name(stats.exchange).data());
    return false;
  }
  if (rank != options.root) return true;
  const testing::AssertionResult same = same_targets(whole.one(), many.targets());
  if (!same) std::fprintf(stderr, "%d ranks: %s\n", size, same.message());
  return static_cast<bool>(same);
}

/// Each rank in turn has a part that cannot be drawn.
bool all_say_the_same(int rank, int size, int failing) {
  FrameOptions frame{.width = 20, .height = 20};
  Mesh mesh = shapes::soup(3);
  mesh.indices = {0, 1, 1000};
  const MeshView view = mesh.view();
  const InstanceView instance{view};
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

/// If a window cannot be allocated on some ranks or on all, words go as messages. Memory that is
/// shared later works.
bool goes_without_windows() {
  bool ok = true;
  for (const int failing : {0, 1, -1}) {
    MpiRanks ranks(MPI_COMM_WORLD);
    if (failing >= ranks.size()) continue;
    without_window = [&] { return failing < 0 || failing == ranks.rank(); };
    for (int frame = 0; frame < 2; ++frame) {
      const auto memory = ranks.share(100);
      if (!memory.empty()) std::fprintf(stderr, "rank %d shares nevertheless\n", ranks.rank());
      ok &= memory.empty();
    }
    if (ranks.size() > 1) {
      ok &= equals_one_renderer(ranks, {.translucent = true, .exchange = WordExchange::shared});
      ok &= equals_one_renderer(ranks,
                                {.exchange = WordExchange::sparse, .taken = WordExchange::sparse});
    }
    without_window = nullptr;
    // A smaller size is possible.
    const auto less = ranks.share(50);
    ok &= less.size() == 50;
    if (less.size() != 50) return false;
    if (ranks.rank() < 50)
      less[static_cast<std::size_t>(ranks.rank())] = 7 + static_cast<std::uint64_t>(ranks.rank());
    (void)ranks.max(0);
    for (int r = 0; r < ranks.size(); ++r)
      ok &= less[static_cast<std::size_t>(r)] == 7 + static_cast<std::uint64_t>(r);
  }
  return ok;
}

/// Layers in memory that ranks share, which grows and keeps its contents. If it cannot grow, layers
/// are sent.
bool shares_layers() {
  MpiRanks ranks(MPI_COMM_WORLD);
  if (ranks.size() == 1) return true;
  const auto equals = [](MpiRanks& these, bool translucent, int samples) {
    return equals_one_renderer(these, {.translucent = translucent,
                                       .samples = samples,
                                       .taken = WordExchange::shared,
                                       .fragment_bytes = std::uint64_t{1} << 30});
  };
  bool ok = equals(ranks, false, 1);
  const std::size_t words = ranks.share(1).size();
  for (const int failing : {0, 1}) {
    without_window = [&] { return ranks.rank() == failing; };
    ok &= equals(ranks, true, 1);
    ok &= ranks.share(1).size() == words;
  }
  without_window = nullptr;
  MpiRanks others(MPI_COMM_WORLD);
  for (const std::size_t count : {20U, 3000U, 100U}) {
    const auto memory = others.share(count);
    if (memory.size() < count) return false;
    const auto me = static_cast<std::size_t>(ranks.rank());
    if (count != 20) ok &= memory[me] == 5 + me;
    (void)others.max(0);
    memory[me] = 5 + me;
  }
  for (const int samples : {1, 4, 1})
    for (const bool translucent : {false, true}) ok &= equals(others, translucent, samples);
  ok &= others.share(1).size() > words;
  if (!ok) std::fprintf(stderr, "rank %d: layers on shared memory are wrong\n", ranks.rank());
  return ok;
}

/// In each phase each rank in turn throws: all ranks report its error and draw the next frame.
/// Returns whether they do; a hang ends the job after half a minute.
bool each_phase_ends_on_all(int rank, int size, WordExchange exchange) {
  PartsScene scene(9, 3, false);
  scene.scene.instances[0].opacity = 0.5F;
  const SceneBinding binding(scene.scene);
  FrameOptions frame{.width = 16, .height = 16};
  Renderer renderer({.device = Device::serial});
  MpiRanks ranks(MPI_COMM_WORLD, 30);
  std::vector<std::string> phases;
  const auto draw = [&](const ranks::AtPhase& at) -> std::string {
    SceneView own = binding.view();
    const auto first = static_cast<std::size_t>(rank);
    own.instances = first < 3 ? own.instances.subspan(first, 1) : std::span<const InstanceView>{};
    const auto part = static_cast<std::uint64_t>(rank);
    Image<Rgba8> image(16, 16);
    Targets targets;
    if (rank == 0) targets.color8 = image;
    try {
      (void)ranks::render_parts(ranks, renderer, own, std::span(&part, own.instances.size()),
                                Camera{.eye = {0, 0, 3}}, frame, targets, {.exchange = exchange},
                                at);
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  };
  const std::string first = draw([&](std::string_view phase, int) { phases.emplace_back(phase); });
  bool ok = first.empty() && phases.size() > (size > 1 ? 15U : 3U);
  if (!ok)
    std::fprintf(stderr, "rank %d of %d: %zu phases, '%s'\n", rank, size, phases.size(),
                 first.c_str());
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const int failing = static_cast<int>(i) % size;
    const std::string said = draw([&](std::string_view phase, int r) {
      if (phase == phases[i] && r == failing) throw Error(Errc::io, "wing.ply: cut short");
    });
    if (said == "rank " + std::to_string(failing) + ": wing.ply: cut short") continue;
    std::fprintf(stderr, "phase '%s', rank %d of %d says: '%s'\n", phases[i].c_str(), rank, size,
                 said.c_str());
    ok = false;
  }
  return ok && draw({}).empty();
}

void never(MPI_Comm*, int*, ...) {}

/// A receive of any message that the caller has begun gets the caller's message, and the caller's
/// error handler stays.
bool leaves_the_caller_alone(int rank, int size) {
  MPI_Errhandler own = MPI_ERRHANDLER_NULL, then = MPI_ERRHANDLER_NULL;
  MPI_Comm_create_errhandler(never, &own);
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, own);
  int got = 0;
  const int sent = 4711 + rank;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Irecv(&got, 1, MPI_INT, MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &request);
  bool ok = true;
  {
    MpiRanks ranks(MPI_COMM_WORLD);
    ok = equals_one_renderer(ranks, {.translucent = true, .exchange = WordExchange::sparse});
  }
  int came = 0;
  MPI_Test(&request, &came, MPI_STATUS_IGNORE);
  ok &= came == 0;
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Send(&sent, 1, MPI_INT, (rank + 1) % size, 7, MPI_COMM_WORLD);
  if (came == 0) MPI_Wait(&request, MPI_STATUS_IGNORE);
  ok &= got == 4711 + (rank + size - 1) % size;
  MPI_Comm_get_errhandler(MPI_COMM_WORLD, &then);
  ok &= then == own;
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_ARE_FATAL);
  MPI_Errhandler_free(&then);
  MPI_Errhandler_free(&own);
  if (!ok) std::fprintf(stderr, "rank %d of %d: the caller's communicator was used\n", rank, size);
  return ok;
}

int run() {
  int rank = 0, size = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  bool ok = true;
  {
    MpiRanks ranks(MPI_COMM_WORLD);
    for (const WordExchange exchange : {WordExchange::automatic, WordExchange::sparse,
                                        WordExchange::two_hops, WordExchange::shared})
      for (const bool translucent : {false, true})
        for (const Shader shader : {Shader::phong, Shader::material, Shader::id})
          ok &= equals_one_renderer(ranks,
                                    {shader, shader == Shader::material, translucent, exchange});
    ok &= equals_one_renderer(ranks, {.samples = 4});
    ok &= equals_one_renderer(
        ranks,
        {.shader = Shader::material, .with_materials = true, .translucent = true, .samples = 4});
    ok &= ranks.share(std::size_t{1} << 61).empty();  // in bytes this overflows to 0
    // All these ranks are on one machine.
    if (size > 1) ok &= equals_one_renderer(ranks, {.taken = WordExchange::shared});
    MpiRanks others(MPI_COMM_WORLD, 0, {}, false);
    ok &= others.share(8).empty();
  }
  ok &= goes_without_windows();
  ok &= shares_layers();
  for (int failing = 0; failing < size; ++failing) ok &= all_say_the_same(rank, size, failing);
  for (const WordExchange exchange : {WordExchange::automatic, WordExchange::sparse})
    ok &= each_phase_ends_on_all(rank, size, exchange);
  ok &= leaves_the_caller_alone(rank, size);
  return ok ? 0 : 1;
}

}  // namespace
}  // namespace rastrum::test

/// Replaces MPI's own function, which it calls, to simulate a lack of memory.
extern "C" int MPI_Win_allocate_shared(MPI_Aint size, int unit, MPI_Info info, MPI_Comm comm,
                                       void* memory, MPI_Win* window) {
  const int code = PMPI_Win_allocate_shared(size, unit, info, comm, memory, window);
  const auto& fails = rastrum::test::without_window;
  return fails && fails() ? MPI_ERR_NO_MEM : code;
}

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const int result = rastrum::test::run();
  MPI_Finalize();
  return result;
}
