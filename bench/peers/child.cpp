// SPDX-License-Identifier: BSD-3-Clause
#include "child.hpp"

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

extern char** environ;

namespace rastrum::bench {

Child::Child(std::string who, std::vector<std::string> arguments) : who_(std::move(who)) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
    throw Error(Errc::no_device, who_ + ": no socket for its process");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const int failed =
      posix_spawnp(&process_, pointers[0], &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (failed != 0) {
    close(ends[0]);
    throw Error(Errc::no_device,
                who_ + ": cannot start " + arguments[0] + ": " + std::strerror(failed));
  }
  socket_ = ends[0];
  answers_ = fdopen(socket_, "r");
}

Child::~Child() {
  std::fclose(answers_);
  waitpid(process_, nullptr, 0);
}

void Child::tell(const std::string& text) const {
  const std::string line = text + "\n";
  for (std::size_t sent = 0; sent < line.size();) {
    const ssize_t n = send(socket_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) throw Error(Errc::unsupported, who_ + ": its process ended");
    sent += static_cast<std::size_t>(n);
  }
}

std::string Child::line() const {
  std::string text;
  for (int c = std::fgetc(answers_); c != EOF && c != '\n'; c = std::fgetc(answers_))
    text += static_cast<char>(c);
  return text;
}

TemporaryFile::TemporaryFile() {
  name_ = (std::filesystem::temp_directory_path() / "rastrum_peer_XXXXXX").string();
  const int file = mkstemp(name_.data());
  if (file < 0) throw Error(Errc::io, "cannot make a file such as " + name_);
  close(file);
}

}  // namespace rastrum::bench
