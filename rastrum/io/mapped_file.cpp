// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/mapped_file.hpp>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/io/files.hpp>

namespace rastrum::io {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  const Errc code = error == ENOENT || error == ENOTDIR ? Errc::not_found : Errc::io;
  throw Error(code, file.string() + ": cannot be read: " + std::strerror(error));
}

struct FilesRead {
  std::atomic<bool> remembers{false};
  std::mutex mutex;
  std::set<std::pair<dev_t, ino_t>> files;
};
FilesRead& all() {
  static FilesRead* const files = new FilesRead;  // never destroyed: a thread may read at the end
  return *files;
}

struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

}  // namespace

void remember_files_read() {
  all().remembers = true;
}

void remember_read(const struct stat& file) {
  if (!all().remembers || !S_ISREG(file.st_mode)) return;
  const std::scoped_lock lock(all().mutex);
  all().files.emplace(file.st_dev, file.st_ino);
}

void remember_read(const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) == 0) remember_read(info);
}

bool was_read(const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) return false;
  const std::scoped_lock lock(all().mutex);
  return all().files.contains({info.st_dev, info.st_ino});
}

MappedFile::MappedFile(const std::filesystem::path& file, Kind kind) : file_(file) {
  // O_NONBLOCK opens a pipe without a writer at once; it is refused below.
  const int wait = kind == Kind::regular ? O_NONBLOCK : 0;
  const Descriptor d{::open(file.c_str(), O_RDONLY | O_CLOEXEC | wait)};
  if (d.fd < 0) fail(file, errno);
  struct stat info {};
  if (::fstat(d.fd, &info) != 0) fail(file, errno);
  if (S_ISDIR(info.st_mode)) fail(file, EISDIR);
  remember_read(info);
  if (!S_ISREG(info.st_mode)) {
    if (kind == Kind::regular)
      throw Error(Errc::io, file.string() + ": is no regular file, and is not read");
    copy(d.fd);
    return;
  }
  size_ = static_cast<std::size_t>(info.st_size);
  if (size_ == 0) return;  // mmap refuses empty mappings
  void* p = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, d.fd, 0);
  if (p == MAP_FAILED) fail(file, errno);
  data_ = static_cast<const std::byte*>(p);
  mapped_.emplace(data_, size_);
  if (mapped_->watches()) {
    ::madvise(p, size_, MADV_SEQUENTIAL);
    return;
  }
  mapped_.reset();
  ::munmap(p, size_);
  copy(d.fd);
}

void MappedFile::copy(int fd) {
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  for (;;) {
    const std::size_t old = copy_.size();
    copy_.resize(old + kChunk);
    const ssize_t n = ::read(fd, copy_.data() + old, kChunk);
    if (n < 0 && errno != EINTR) fail(file_, errno);
    copy_.resize(old + static_cast<std::size_t>(n < 0 ? 0 : n));
    if (n == 0) break;
  }
  data_ = copy_.data();
  size_ = copy_.size();
}

void MappedFile::check() const {
  if (!mapped_) return;
  std::error_code ignored;
  const std::uintmax_t now = std::filesystem::file_size(file_, ignored);
  if (!ignored && now < size_)
    throw Error(Errc::io, file_.string() + ": has become shorter while it was read (" +
                              std::to_string(size_) + " bytes to " + std::to_string(now) + ")");
  if (mapped_->any())
    throw Error(Errc::io, file_.string() +
                              ": could not be read whole: its disk or network has "
                              "failed, or it was shorter for a time");
}

void MappedFile::will_need(std::size_t offset, std::size_t size) const {
  if (!mapped_ || offset >= size_) return;
  static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t begin = offset / page * page, end = offset + std::min(size, size_ - offset);
  ::madvise(const_cast<std::byte*>(data_) + begin, end - begin, MADV_WILLNEED);
}

void MappedFile::drop(std::size_t offset, std::size_t size) const {
  if (!mapped_ || offset >= size_) return;
  static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t begin = (offset + page - 1) / page * page;
  // The file's last page counts as whole.
  const std::size_t stop = offset + std::min(size, size_ - offset);
  const std::size_t end = stop == size_ ? stop : stop / page * page;
  if (begin < end) ::madvise(const_cast<std::byte*>(data_) + begin, end - begin, MADV_DONTNEED);
}

MappedFile::~MappedFile() {
  if (!mapped_) return;
  mapped_.reset();  // before another file may be mapped there
  // munmap takes a non-const pointer but writes nothing.
  ::munmap(const_cast<std::byte*>(data_), size_);
}

}  // namespace rastrum::io
