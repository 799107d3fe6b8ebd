// SPDX-License-Identifier: BSD-3-Clause
#include "mpi_start.hpp"

#include <cstdlib>
#include <optional>

#include <rastrum/error.hpp>

#if defined(RASTRUM_HAS_MPI)
#include <rastrum/io.hpp>
#include <rastrum/mpi/mpi_ranks.hpp>
#endif

namespace rastrum::cli {
namespace {

/// The number of ranks that a launcher tells: Open MPI's mpirun, MPICH's and srun with PMI, srun
/// with PMIx, where Slurm tells it.
struct Launch {
  const char* name;  ///< of the variable with the number
  int ranks;
};

int number_in(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? -1 : static_cast<int>(std::strtol(text, nullptr, 10));
}

std::optional<Launch> launched() {
  for (const char* const name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const int ranks = number_in(name); ranks > 1) return Launch{name, ranks};
  if (number_in("PMIX_RANK") >= 0)
    for (const char* const name : {"SLURM_STEP_NUM_TASKS", "SLURM_NTASKS"})
      if (const int ranks = number_in(name); ranks > 1) return Launch{name, ranks};
  return {};
}

[[noreturn]] void refuse(const Launch& launch, const std::string& why) {
  throw Error(Errc::unsupported,
              std::string("the program was started as one of ")
                  .append(std::to_string(launch.ranks))
                  .append(" ranks, each of which would write the same files, and ")
                  .append(why)
                  .append("; start it alone, or unset ")
                  .append(launch.name)
                  .append(" if each is to draw its own picture"));
}

#if defined(RASTRUM_HAS_MPI)
class StartedRanks final : public RanksOfProgram {
 public:
  StartedRanks(const Launch& launch, double timeout_s) {
    int level = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level) != MPI_SUCCESS)
      refuse(launch, "MPI cannot be initialized");
    int size = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (size != launch.ranks) {
      MPI_Finalize();
      refuse(launch, "its MPI knows of " + std::to_string(size) +
                         ": it was built with another MPI than the one that started it");
    }
    // For a single picture shared memory costs what it saves.
    ranks_.emplace(MPI_COMM_WORLD, timeout_s, io::abandon_files, false);
    MPI_Comm here = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &neighbours_);
    MPI_Comm_free(&here);
  }
  ~StartedRanks() override {
    ranks_.reset();
    MPI_Finalize();
  }
  [[nodiscard]] Communicator& ranks() override { return *ranks_; }
  [[nodiscard]] int neighbours() const override { return neighbours_; }
  void give_up() override {
    io::abandon_files();
    MPI_Abort(MPI_COMM_WORLD, 1);
  }

 private:
  std::optional<mpi::MpiRanks> ranks_;
  int neighbours_ = 1;
};
#endif

}  // namespace

bool started_as_further_rank() {
  if (!launched()) return false;
  for (const char* const name : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"})
    if (number_in(name) > 0) return true;
  return false;
}

void refuse_ranks(const std::string& why) {
  if (const auto launch = launched()) refuse(*launch, why);
}

std::unique_ptr<RanksOfProgram> start_ranks([[maybe_unused]] double timeout_s) {
  const auto launch = launched();
  if (!launch) return nullptr;
#if defined(RASTRUM_HAS_MPI)
  return std::make_unique<StartedRanks>(*launch, timeout_s);
#else
  refuse(*launch,
         "was built without MPI (Debian: libopenmpi-dev openmpi-bin, then configure and build "
         "again)");
#endif
}

}  // namespace rastrum::cli
