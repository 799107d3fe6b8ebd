// The VTK peer; see the header. One socket is the child's stdin and stdout.
#include "vtk_peer.hpp"

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include <rastrum/error.hpp>

extern char** environ;

namespace rastrum::bench {

/// A file for arrays on their way; gone with its owner.
class TemporaryFile {
 public:
  TemporaryFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rastrum_vtk_XXXXXX").string();
    const int file = mkstemp(pattern.data());
    if (file < 0) throw Error(Errc::io, "cannot make a file such as " + pattern);
    close(file);
    name_ = pattern;
  }
  ~TemporaryFile() { std::remove(name_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
};

namespace {

/// Spans, one behind the other.
template <class... Values>
void write(const std::string& file, const Values&... values) {
  std::ofstream out(file, std::ios::binary);
  (out.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size_bytes())),
   ...);
  if (!out.flush()) throw Error(Errc::io, "cannot write " + file);
}

}  // namespace

struct VtkPeer::Impl {
  pid_t child = -1;
  int socket = -1;
  std::FILE* answers = nullptr;
  TemporaryFile file;
  int width = 0, height = 0;
  std::string description;

  explicit Impl(int threads) {
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    const char* chosen = std::getenv("RASTRUM_VTK_PYTHON");
    std::string python = chosen != nullptr ? chosen : "/usr/bin/python3";
    std::string script = RASTRUM_BENCH_DIR "/peers/vtk_peer.py";
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
      throw Error(Errc::no_device, "VTK: no socket for its process");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addclose(&actions, ends[1]);
    char* const arguments[] = {python.data(), script.data(), nullptr};
    const int failed = posix_spawn(&child, python.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    socket = ends[0];
    answers = fdopen(socket, "r");
    try {
      if (failed != 0)
        throw Error(Errc::no_device, "VTK: cannot start " + python + ": " + std::strerror(failed));
      description = answer();
    } catch (const Error& e) {
      stop();
      throw Error(Errc::no_device, e.what());
    }
  }
  ~Impl() { stop(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void stop() {
    std::fclose(answers);  // the child ends with its input
    if (child > 0) waitpid(child, nullptr, 0);
  }

  /// The rest of the answer's line after "done".
  std::string answer() const {
    std::string line;
    for (int c = std::fgetc(answers); c != EOF && c != '\n'; c = std::fgetc(answers))
      line += static_cast<char>(c);
    if (line.rfind("done", 0) == 0) return line.substr(std::min<std::size_t>(line.size(), 5));
    throw Error(Errc::unsupported, "VTK: " + (line.empty() ? "its process ended" : line));
  }

  void tell(const std::string& command) const {
    const std::string line = command + "\n";
    for (std::size_t sent = 0; sent < line.size();) {
      const ssize_t n = send(socket, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) throw Error(Errc::unsupported, "VTK: its process ended");
      sent += static_cast<std::size_t>(n);
    }
    static_cast<void>(answer());
  }
};

VtkPeer::VtkPeer(int threads) : impl_(std::make_unique<Impl>(threads)) {}
VtkPeer::~VtkPeer() = default;

std::string VtkPeer::description() const {
  return impl_->description;
}

void VtkPeer::set_mesh(const MeshView& mesh) {
  if (!mesh.normals.indices.empty() || mesh.normals.values.size() != mesh.positions.size() ||
      mesh.indices.empty())
    throw Error(Errc::invalid_argument, "VtkPeer: normals must share the positions' indices");
  const std::string& file = impl_->file.name();
  write(file, mesh.positions.packed(), mesh.normals.values.packed(), mesh.indices.packed());
  impl_->tell("mesh " + file + " " + std::to_string(mesh.positions.size()) + " " +
              std::to_string(mesh.triangle_count()));
}

void VtkPeer::set_spheres(std::span<const Vec3> centers, std::span<const float> radii) {
  const std::string& file = impl_->file.name();
  write(file, centers, radii.first(centers.size()));
  impl_->tell("spheres " + file + " " + std::to_string(centers.size()));
}

void VtkPeer::set_points(std::span<const Vec3> positions) {
  const std::string& file = impl_->file.name();
  write(file, positions);
  impl_->tell("points " + file + " " + std::to_string(positions.size()));
}

void VtkPeer::set_view(const Camera& camera, int width, int height) {
  if (camera.orthographic || camera.matrix)
    throw Error(Errc::unsupported, "VtkPeer: the camera is no perspective one");
  char numbers[400];
  std::snprintf(numbers, sizeof numbers, "%.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g",
                static_cast<double>(camera.fov_rad), camera.eye.x, camera.eye.y, camera.eye.z,
                camera.target.x, camera.target.y, camera.target.z, camera.up.x, camera.up.y,
                camera.up.z);
  impl_->tell("view " + std::to_string(width) + " " + std::to_string(height) + " " + numbers);
  impl_->width = width;
  impl_->height = height;
}

void VtkPeer::set_occlusion(double radius) {
  char text[64];
  std::snprintf(text, sizeof text, "occlusion %.9g", radius);
  impl_->tell(text);
}

void VtkPeer::draw(float opacity) {
  impl_->tell("draw " + std::to_string(opacity));
}

Image<Vec4> VtkPeer::picture() {
  Image<Vec4> image(impl_->width, impl_->height);
  impl_->tell("picture " + impl_->file.name());
  std::vector<Rgba8> pixels(image.pixels().size());
  std::ifstream in(impl_->file.name(), std::ios::binary);
  in.read(reinterpret_cast<char*>(pixels.data()),
          static_cast<std::streamsize>(pixels.size() * sizeof(Rgba8)));
  if (!in) throw Error(Errc::io, "VTK wrote no picture into " + impl_->file.name());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto unit = [](std::uint8_t v) { return static_cast<float>(v) * (1.0F / 255); };
    image.pixels()[i] = {unit(pixels[i].r), unit(pixels[i].g), unit(pixels[i].b),
                         unit(pixels[i].a)};
  }
  return image;
}

}  // namespace rastrum::bench
