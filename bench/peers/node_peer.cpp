#include "node_peer.hpp"

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <rastrum/error.hpp>

extern char** environ;

namespace rastrum::bench {

struct NodePeer::Impl {
  pid_t child = -1;
  std::FILE* answers = nullptr;
  int socket = -1;
  std::string file;
  std::uint64_t hash = 0;

  Impl(const terrain::HeightMap& map, int width, int height, double distance) {
    std::string pattern = (std::filesystem::temp_directory_path() / "rastrum_node_XXXXXX").string();
    const int handle = mkstemp(pattern.data());
    if (handle < 0) throw Error(Errc::io, "cannot make a file such as " + pattern);
    close(handle);
    file = pattern;
    std::ofstream out(file, std::ios::binary);
    for (const float h : map.heights.pixels()) out.put(static_cast<char>(static_cast<int>(h)));
    out.write(reinterpret_cast<const char*>(map.colors.pixels().data()),
              static_cast<std::streamsize>(map.colors.pixels().size_bytes()));
    if (!out.flush()) throw Error(Errc::io, "cannot write " + file);

    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
      throw Error(Errc::no_device, "node: no socket for its process");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addclose(&actions, ends[1]);
    std::string arguments[] = {"node",
                               RASTRUM_BENCH_DIR "/peers/voxel_space.js",
                               file,
                               std::to_string(width),
                               std::to_string(height),
                               std::to_string(distance)};
    char* pointers[7] = {};
    for (std::size_t i = 0; i < 6; ++i) pointers[i] = arguments[i].data();
    const int failed = posix_spawnp(&child, "node", &actions, nullptr, pointers, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    socket = ends[0];
    answers = fdopen(socket, "r");
    if (failed != 0) {
      child = -1;
      stop();
      throw Error(Errc::no_device, "node does not start; apt-get install nodejs");
    }
    try {
      hash = std::stoull(line(), nullptr, 16);
    } catch (const std::exception&) {
      stop();
      throw Error(Errc::no_device, "node: voxel_space.js did not draw");
    }
  }
  ~Impl() { stop(); }
  void stop() {
    if (answers != nullptr) std::fclose(answers);  // the child ends with its input
    answers = nullptr;
    if (child > 0) waitpid(child, nullptr, 0);
    child = -1;
    std::remove(file.c_str());
  }
  [[nodiscard]] std::string line() const {
    std::string text;
    for (int c = std::fgetc(answers); c != EOF && c != '\n'; c = std::fgetc(answers))
      text += static_cast<char>(c);
    return text;
  }
};

NodePeer::NodePeer(const terrain::HeightMap& map, int width, int height, double distance)
    : impl_(std::make_unique<Impl>(map, width, height, distance)) {}
NodePeer::~NodePeer() = default;
NodePeer::NodePeer(NodePeer&&) noexcept = default;

std::uint64_t NodePeer::hash() const {
  return impl_->hash;
}

double NodePeer::turn_ms() {
  if (send(impl_->socket, "\n", 1, MSG_NOSIGNAL) != 1)
    throw Error(Errc::unsupported, "node: its process ended");
  const std::string answer = impl_->line();
  if (answer.empty()) throw Error(Errc::unsupported, "node: its process ended");
  return std::stod(answer);
}

}  // namespace rastrum::bench
