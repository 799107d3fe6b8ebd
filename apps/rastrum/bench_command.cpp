// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench NAME…`: passes the command line to the program `rastrum-bench` beside this one.
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <rastrum/error.hpp>

#include "commands.hpp"

namespace rastrum::cli {
namespace {

/// Returns only by an exception.
int run(const std::vector<std::string>& arguments) {
  std::error_code unknown;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", unknown);
  const std::string program = (self.parent_path() / "rastrum-bench").string();
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  ::execv(program.c_str(), argv.data());
  throw Error(Errc::unsupported, "the benchmarks are a separate program, but " + program +
                                     " cannot be started (" + std::strerror(errno) +
                                     "): build the target rastrum_bench_program");
}

}  // namespace

Command add_bench_command(Parser& app) {
  Parser bench =
      app.add_subcommand("bench", "Measure Rastrum beside its peers; --help lists the benchmarks");
  bench.leave_rest();
  return {bench, [bench] { return run(bench.rest()); }};
}

}  // namespace rastrum::cli
