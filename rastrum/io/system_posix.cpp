// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

#if defined(__linux__)
#include <sys/syscall.h>
#endif
#if !defined(__wasi__)
#include <pthread.h>
#include <sys/file.h>
#endif

#include <rastrum/io/system.hpp>

namespace rastrum::io {
namespace fs = std::filesystem;
namespace {

FileInfo info_of(const struct stat& file) {
  FileInfo info;
  if (S_ISREG(file.st_mode)) info.kind = FileInfo::Kind::regular;
  if (S_ISDIR(file.st_mode)) info.kind = FileInfo::Kind::folder;
  info.bytes = static_cast<std::uint64_t>(file.st_size);
  info.read_only = (file.st_mode & 0222) == 0;
  info.id = {static_cast<std::uint64_t>(file.st_dev), static_cast<std::uint64_t>(file.st_ino)};
  return info;
}

}  // namespace

std::optional<FileInfo> info_of(const fs::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) return {};
  return info_of(info);
}
std::optional<FileInfo> info_of(int descriptor) {
  struct stat info {};
  if (::fstat(descriptor, &info) != 0) return {};
  return info_of(info);
}
bool may_write(const fs::path& file_or_folder) {
  return ::access(file_or_folder.c_str(), W_OK) == 0;
}

int open_to_read(const fs::path& file, bool wait) {
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | (wait ? 0 : O_NONBLOCK));
  // A folder that is all of a program's world (chroot) may have no /dev.
  return fd < 0 && file == "/dev/stdin" ? duplicate(STDIN_FILENO) : fd;
}
int open_to_write(const fs::path& file) {
  return ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
}
int create_file(const fs::path& file) {
  return ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

const std::byte* map_file(int descriptor, std::size_t bytes) {
  void* const data = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, descriptor, 0);
  return data == MAP_FAILED ? nullptr : static_cast<const std::byte*>(data);
}
void unmap_file(const std::byte* data, std::size_t bytes) {
  // munmap takes a non-const pointer but writes nothing.
  ::munmap(const_cast<std::byte*>(data), bytes);
}

#if defined(__wasi__)
// WebAssembly's one process has its files in memory and writes none.
namespace {

template <class T = int>
T none(T result = -1) {
  errno = ENOTSUP;
  return result;
}

}  // namespace

int open_standard_output() {
  return none();
}
int duplicate(int /*descriptor*/) {
  return none();
}
void take_mode(int /*descriptor*/, const fs::path& /*target*/) {}
bool lock_file(int /*descriptor*/) {
  return true;
}
void remove_unlocked(const fs::path& /*file*/) {}
std::string host_name() {
  return {};
}
bool after_fork(void (* /*run*/)()) {
  return false;
}
void advise(MapAdvice /*advice*/, const std::byte* /*begin*/, std::size_t /*bytes*/) {}
std::size_t page_bytes() {
  return 65536;
}
std::FILE* open_scratch_file() {
  return none<std::FILE*>(nullptr);
}

#else
namespace {

/// A nameless file in `folder`.
int open_nameless(const std::string& folder) {
#if defined(O_TMPFILE)
  const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (fd >= 0) return fd;
#endif
  std::string name = folder + "/.rastrum-XXXXXX";  // some file systems have no nameless files
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

}  // namespace

int open_standard_output() {
  return duplicate(STDOUT_FILENO);
}
int duplicate(int descriptor) {
  return ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
}

void take_mode(int descriptor, const fs::path& target) {
  struct stat old {};
  if (::stat(target.c_str(), &old) != 0) return;
  mode_t mode = old.st_mode & 0777;
  // We may not be allowed to set the owner. A group that cannot be set gets no more rights than
  // everybody.
  if (::fchown(descriptor, old.st_uid, old.st_gid) != 0 &&
      ::fchown(descriptor, static_cast<uid_t>(-1), old.st_gid) != 0)
    mode &= static_cast<mode_t>(~0070U | ((mode & 0007U) << 3U));
  ::fchmod(descriptor, mode);
}

bool lock_file(int descriptor) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;
  struct stat info {};
  return ::fstat(descriptor, &info) == 0 && info.st_nlink > 0;
}

void remove_unlocked(const fs::path& file) {
  const int fd = ::open(file.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return;
  if (::flock(fd, LOCK_EX | LOCK_NB) == 0) ::unlink(file.c_str());
  ::close(fd);
}

std::string host_name() {
  constexpr std::size_t kLongest = 64;
  char name[kLongest + 1] = {};
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

bool after_fork(void (*run)()) {
  return ::pthread_atfork(nullptr, nullptr, run) == 0;
}

void advise(MapAdvice advice, const std::byte* begin, std::size_t bytes) {
  constexpr int kAdvices[] = {MADV_SEQUENTIAL, MADV_WILLNEED, MADV_DONTNEED};
  ::madvise(const_cast<std::byte*>(begin), bytes, kAdvices[static_cast<int>(advice)]);
}
std::size_t page_bytes() {
  static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return page;
}

std::FILE* open_scratch_file() {
  const char* const said = std::getenv("TMPDIR");
  int fd = -1;
  for (const char* const folder : {said, "/tmp", "/var/tmp", "."})
    if (fd < 0 && folder != nullptr && *folder != '\0') fd = open_nameless(folder);
#if defined(__linux__)
  // memfd_create, which glibc has from 2.27 on.
  if (fd < 0) fd = static_cast<int>(::syscall(SYS_memfd_create, "rastrum", 1U /* MFD_CLOEXEC */));
#endif
  if (fd < 0) return nullptr;
  std::FILE* const stream = ::fdopen(fd, "w+b");
  if (stream == nullptr) ::close(fd);
  return stream;
}
#endif

}  // namespace rastrum::io
