// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <system_error>

#if defined(__APPLE__)
#include <mach-o/dyld.h>
#endif

#include <rastrum/error.hpp>

#include "job/system.hpp"

namespace rastrum::cli {
namespace {

namespace fs = std::filesystem;

/// The running program; empty: unknown.
fs::path this_program() {
#if defined(__APPLE__)
  char name[4096];
  std::uint32_t size = sizeof name;
  return _NSGetExecutablePath(name, &size) == 0 ? fs::path(name) : fs::path();
#else
  std::error_code unknown;
  return fs::read_symlink("/proc/self/exe", unknown);
#endif
}

}  // namespace

void prepare_streams() {
  // A file that is opened takes the lowest free number, and messages would be written into it.
  // Writing to a file that is only read fails as writing to a closed stream does.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0)
      static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
}

double peak_bytes() {
#if defined(__APPLE__)
  constexpr double kUnit = 1;
#else
  constexpr double kUnit = 1024;
#endif
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * kUnit;
}

void become_program_beside(const char* name, const std::vector<std::string>& arguments) {
  const std::string program = (this_program().parent_path() / name).string();
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  ::execv(program.c_str(), argv.data());
  throw Error(Errc::unsupported, "the benchmarks are a separate program, but " + program +
                                     " cannot be started (" + std::strerror(errno) +
                                     "): build the target rastrum_bench_program");
}

}  // namespace rastrum::cli
