#include <rastrum/io/atomic_file.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <rastrum/core/error.hpp>

namespace rastrum::io {
namespace fs = std::filesystem;

AtomicFile::AtomicFile(const fs::path& file) : asked_(file), target_(file) {
  std::error_code ignored;
  if (fs::is_symlink(file, ignored)) {
    const fs::path followed = fs::weakly_canonical(file, ignored);
    if (!ignored) target_ = followed;
  }
  const fs::file_status status = fs::status(target_, ignored);
  if (fs::is_directory(status)) fail("it is a directory");
  const bool direct = fs::exists(status) && !fs::is_regular_file(status);
  int fd = -1;
  if (direct) {
    temporary_ = target_;
    fd = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    // Two writers of one name, in this process or another, must not meet in one temporary.
    static std::atomic<unsigned> serial{0};
    temporary_ = target_;
    std::string hidden = target_.filename().string();
    hidden.insert(0, 1, '.');
    hidden.append(".").append(std::to_string(::getpid()));
    hidden.append(".").append(std::to_string(serial++)).append(".tmp");
    temporary_.replace_filename(hidden);
    fd = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  }
  if (fd < 0) fail(std::strerror(errno));
  stream_ = ::fdopen(fd, "wb");
  if (stream_ == nullptr) {
    const int error = errno;
    ::close(fd);
    if (temporary_ != target_) fs::remove(temporary_, ignored);
    fail(std::strerror(error));
  }
}

AtomicFile::~AtomicFile() {
  if (stream_ == nullptr) return;
  std::fclose(stream_);
  std::error_code ignored;
  if (temporary_ != target_) fs::remove(temporary_, ignored);
}

void AtomicFile::write(const void* data, std::size_t size) {
  if (std::fwrite(data, 1, size, stream_) != size) fail(std::strerror(errno));
}

void AtomicFile::commit() {
  if (std::fflush(stream_) != 0 || std::ferror(stream_) != 0) fail(std::strerror(errno));
  std::FILE* const stream = stream_;
  stream_ = nullptr;
  std::error_code error;
  const bool closed = std::fclose(stream) == 0;
  const int close_error = errno;
  if (closed && temporary_ != target_) fs::rename(temporary_, target_, error);
  if (closed && !error) return;
  std::error_code ignored;
  if (temporary_ != target_) fs::remove(temporary_, ignored);
  fail(closed ? error.message().c_str() : std::strerror(close_error));
}

void AtomicFile::fail(const char* what) const {
  throw Error(Errc::io, asked_.string() + ": cannot be written: " + what);
}

}  // namespace rastrum::io
