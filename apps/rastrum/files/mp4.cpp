// SPDX-License-Identifier: BSD-3-Clause
#include "mp4.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/io/files.hpp>

namespace rastrum::cli {
namespace {

namespace fs = std::filesystem;

std::string find_ffmpeg() {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    const fs::path candidate = fs::path(rest.substr(0, colon)) / "ffmpeg";
    std::error_code ignored;
    if (colon != 0 && fs::is_regular_file(candidate, ignored) &&
        ::access(candidate.c_str(), X_OK) == 0)
      return candidate.string();
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
  throw Error(Errc::not_found,
              "an .mp4 needs the program ffmpeg, which is not in PATH: install it (Debian: ffmpeg) "
              "or write numbered pictures, as in -o 'frame_%04d.png'");
}

std::string shortest(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return error == std::errc{} ? std::string(text, end) : std::string();
}

/// A write to a pipe whose reader has gone must fail, not end the program.
class IgnorePipeSignal {
 public:
  IgnorePipeSignal() {
    struct sigaction ignore = {};
    ignore.sa_handler = SIG_IGN;
    ::sigaction(SIGPIPE, &ignore, &before_);
  }
  ~IgnorePipeSignal() { ::sigaction(SIGPIPE, &before_, nullptr); }
  IgnorePipeSignal(const IgnorePipeSignal&) = delete;
  IgnorePipeSignal& operator=(const IgnorePipeSignal&) = delete;

 private:
  struct sigaction before_ = {};
};

}  // namespace

struct Mp4Writer::Impl {
  io::AtomicFile& file;
  std::FILE* said = io::open_scratch_file();  ///< ffmpeg's stderr
  pid_t child = -1;
  int pipe = -1;
  std::vector<std::uint8_t> row;

  explicit Impl(io::AtomicFile& f) : file(f) {}
  ~Impl() {
    // A pipe still open means that the video is not wanted.
    if (pipe >= 0) ::close(pipe);
    if (child > 0) {
      ::kill(child, SIGTERM);
      ::waitpid(child, nullptr, 0);
    }
    if (said != nullptr) std::fclose(said);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void start(const std::string& program, const std::vector<std::string>& arguments);
  void write(const std::vector<std::uint8_t>& bytes);
  /// Closes the pipe and waits; throws with ffmpeg's words unless it succeeded.
  void wait(const char* otherwise);
};

void Mp4Writer::Impl::start(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  const int output = ::fileno(file.stream());
  int ends[2];
  if (said == nullptr || ::pipe(ends) != 0) file.fail(std::strerror(errno));
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  child = ::fork();
  if (child == 0) {
    // Between fork and exec only async-signal-safe calls are allowed.
    if (::dup2(ends[0], 0) < 0 || ::dup2(::fileno(said), 2) < 0 || ::fcntl(output, F_SETFD, 0) != 0)
      ::_exit(127);
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
  }
  const int error = errno;
  ::close(ends[0]);
  pipe = ends[1];
  if (child < 0) file.fail(std::strerror(error));
}

void Mp4Writer::Impl::write(const std::vector<std::uint8_t>& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::write(pipe, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) wait("it ended early");
    done += static_cast<std::size_t>(n);
  }
}

void Mp4Writer::Impl::wait(const char* otherwise) {
  ::close(pipe);
  pipe = -1;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  child = -1;
  const bool ok = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (ok && otherwise == nullptr) return;
  std::rewind(said);
  char text[400] = {};
  const std::size_t size = std::fread(text, 1, sizeof text - 1, said);
  std::string words(text, size);
  while (!words.empty() && (words.back() == '\n' || words.back() == '\r')) words.pop_back();
  if (words.empty())
    words = otherwise != nullptr ? otherwise : "it ended with status " + std::to_string(status);
  file.fail(("ffmpeg failed: " + words).c_str());
}

void Mp4Writer::check(int width, int height) {
  static_cast<void>(find_ffmpeg());
  if (width % 2 != 0 || height % 2 != 0)
    throw Error(Errc::invalid_argument, "--size: an .mp4 needs an even width and height, not " +
                                            std::to_string(width) + "x" + std::to_string(height));
}

Mp4Writer::Mp4Writer(io::AtomicFile& file, int width, int height, double fps) {
  check(width, height);
  impl_ = std::make_unique<Impl>(file);
  impl_->row.resize(static_cast<std::size_t>(width) * 3);
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  // Names sRGB's primaries, BT.709's, so that players do not guess by size.
  impl_->start(
      find_ffmpeg(),
      {"-hide_banner", "-loglevel", "error", "-nostdin", "-y", "-f", "rawvideo", "-pixel_format",
       "rgb24", "-video_size", size, "-framerate", shortest(fps), "-i", "pipe:0", "-an", "-vf",
       "scale=out_color_matrix=bt709:out_range=tv", "-c:v", "libx264", "-crf", "16", "-pix_fmt",
       "yuv420p", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1",
       "-color_range", "tv", "-movflags", "+faststart", "-f", "mp4",
       // The open file, not its name: if the program ends before ffmpeg begins, no file appears.
       "file:/dev/fd/" + std::to_string(::fileno(file.stream()))});
}

Mp4Writer::~Mp4Writer() = default;

void Mp4Writer::add(ImageView<const Rgba8> picture) {
  const IgnorePipeSignal guard;
  const auto over_black = [](std::uint8_t c, std::uint8_t alpha) {
    return static_cast<std::uint8_t>((c * alpha + 127) / 255);
  };
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const Rgba8 p = picture(x, y);
      std::uint8_t* const out = impl_->row.data() + static_cast<std::size_t>(x) * 3;
      out[0] = over_black(p.r, p.a);
      out[1] = over_black(p.g, p.a);
      out[2] = over_black(p.b, p.a);
    }
    impl_->write(impl_->row);
  }
}

void Mp4Writer::finish() {
  impl_->wait(nullptr);
}

}  // namespace rastrum::cli
