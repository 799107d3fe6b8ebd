// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io.hpp>

#include <fcntl.h>
#include <pthread.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/io/files.hpp>

namespace rastrum::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLongestHost = 64;

/// The suffix of this host's temporaries. Each container is a host.
const std::string& suffix() {
  static const std::string all = [] {
    char name[kLongestHost + 1] = {};
    if (::gethostname(name, sizeof name - 1) != 0) name[0] = '\0';
    return "@" + std::string(name) + ".rastrum-tmp";
  }();
  return all;
}

/// Follows links, also to a file that does not exist. In a circle of links it returns any of them.
fs::path follow_links(fs::path file) {
  constexpr int kMostLinks = 40;  // Linux's
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(file, error); ++i) {
    const fs::path next = fs::read_symlink(file, error);
    if (error) break;
    file = next.is_absolute() ? next : file.parent_path() / next;
  }
  return file;
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// Gives `fd`, which will replace `target`, its owner and mode.
void take_mode(int fd, const fs::path& target) {
  struct stat old {};
  if (::stat(target.c_str(), &old) != 0) return;
  mode_t mode = old.st_mode & 0777;
  // We may not be allowed to set the owner. A group that cannot be set gets no more rights than
  // everybody.
  if (::fchown(fd, old.st_uid, old.st_gid) != 0 &&
      ::fchown(fd, static_cast<uid_t>(-1), old.st_gid) != 0)
    mode &= ~mode_t{0070} | ((mode & 0007U) << 3U);
  ::fchmod(fd, mode);
}

/// A nameless file in `folder`; −1: errno says why not.
int open_nameless(const std::string& folder) {
  const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (fd >= 0) return fd;
  std::string name = folder + "/.rastrum-XXXXXX";  // some file systems have no nameless files
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

/// The temporaries of this process. Making, renaming or removing one needs the mutex.
struct Live {
  std::mutex mutex;
  std::set<std::string> names;
};
Live& live() {
  static Live* all = new Live;  // never destroyed: a thread may still write at the end
  // A forked child has its own. Another thread may hold the parent's, whose names are not the
  // child's to remove.
  static const int registered = pthread_atfork(nullptr, nullptr, [] { all = new Live; });
  static_cast<void>(registered);
  return *all;
}

void forget(const fs::path& temporary) {
  Live& all = live();
  const std::scoped_lock lock(all.mutex);
  ::unlink(temporary.c_str());
  all.names.erase(temporary.string());
}

/// Whether the file of `fd` is now ours. False: another process took it for an abandoned one.
bool keep(int fd) {
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;
  struct stat info {};
  return ::fstat(fd, &info) == 0 && info.st_nlink > 0;
}

}  // namespace

std::string why_not_writable(const fs::path& file) {
  struct stat info {};
  const bool exists = ::stat(file.c_str(), &info) == 0;
  if (!exists && errno == ELOOP) return std::strerror(errno);
  if (exists && S_ISDIR(info.st_mode)) return "it is a directory";
  // Refused for root, too, who hardly wants to lose the file.
  if (exists && S_ISREG(info.st_mode) && (info.st_mode & 0222) == 0) return "it is read-only";
  if (exists && ::access(file.c_str(), W_OK) != 0) return std::strerror(errno);
  if (exists && !S_ISREG(info.st_mode)) return {};  // a device, a pipe: written in place
  const fs::path folder = folder_of(follow_links(file));
  if (::stat(folder.c_str(), &info) != 0 || !S_ISDIR(info.st_mode))
    return "there is no directory " + folder.string() + "; create it first";
  if (::access(folder.c_str(), W_OK) != 0) return folder.string() + ": " + std::strerror(errno);
  return {};
}

struct AtomicFile::Impl {
  explicit Impl(const fs::path& file);
  explicit Impl(StandardOutput);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  void open_temporary();
  void spool(int fd);
  void finish();
  void send();
  [[noreturn]] void fail(const char* what) const;

  std::string asked;   ///< as the caller spelled it, for messages
  fs::path target;     ///< links resolved
  fs::path temporary;  ///< empty: written directly, or sent
  std::FILE* stream = nullptr;
  int lock = -1;  ///< of the temporary; shows others that it is in use
  int sent = -1;  ///< where the bytes of a spooled file go
};

AtomicFile::Impl::Impl(const fs::path& file) : asked(file.string()), target(follow_links(file)) {
  if (const std::string why = why_not_writable(file); !why.empty()) fail(why.c_str());
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    const int fd = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    if (fd < 0) fail(std::strerror(errno));
    if (::lseek(fd, 0, SEEK_CUR) < 0) {
      spool(fd);
      return;
    }
    stream = ::fdopen(fd, "wb");
    if (stream != nullptr) return;
    const int error = errno;
    ::close(fd);
    fail(std::strerror(error));
  }
  open_temporary();
}

AtomicFile::Impl::Impl(StandardOutput) : asked("standard output") {
  const int fd = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  if (fd < 0) fail(std::strerror(errno));
  spool(fd);
}

void AtomicFile::Impl::open_temporary() {
  // Writers of one name must not share a temporary. Another process may have our number, as the
  // first one of every container has.
  static std::atomic<unsigned> serial{0};
  constexpr int kTries = 100;
  constexpr std::size_t kLongest = 140;  // bytes, so that the rest of the name fits
  std::string begin(".");
  begin.append(target.filename().string(), 0, kLongest).append(".");
  begin.append(std::to_string(::getpid())).append(".");
  int error = EEXIST;
  for (int i = 0; i < kTries && error == EEXIST; ++i) {
    fs::path name = target;
    name.replace_filename(begin + std::to_string(serial++) + suffix());
    Live& all = live();
    const std::scoped_lock held(all.mutex);
    const int fd = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    error = fd < 0 ? errno : 0;
    if (fd < 0) continue;
    if (!keep(fd)) {
      ::close(fd);
      error = EEXIST;
      continue;
    }
    take_mode(fd, target);
    lock = ::fcntl(fd, F_DUPFD_CLOEXEC, 0);
    stream = ::fdopen(fd, "wb");
    if (lock >= 0 && stream != nullptr) {
      all.names.insert(name.string());
      temporary = name;
      return;
    }
    error = errno;
    if (stream == nullptr) ::close(fd);
    ::unlink(name.c_str());
  }
  if (stream != nullptr) std::fclose(stream);
  if (lock >= 0) ::close(lock);
  fail(std::strerror(error));
}

void AtomicFile::Impl::spool(int fd) {
  sent = fd;
  stream = open_scratch_file();
  if (stream != nullptr) return;
  const int error = errno;
  ::close(fd);
  fail((std::string("no temporary file for it: ") + std::strerror(error)).c_str());
}

AtomicFile::Impl::~Impl() {
  if (stream != nullptr) std::fclose(stream);
  if (!temporary.empty()) forget(temporary);
  if (lock >= 0) ::close(lock);
  if (sent >= 0) ::close(sent);
}

AtomicFile::AtomicFile(PathView file) : impl_(new Impl(fs::path(file.text()))) {}
AtomicFile::AtomicFile(StandardOutput output) : impl_(new Impl(output)) {}
AtomicFile::~AtomicFile() = default;

std::FILE* AtomicFile::stream() {
  return impl_->stream;
}
const std::string& AtomicFile::name() const {
  return impl_->asked;
}
void AtomicFile::fail(const char* what) const {
  impl_->fail(what);
}

void AtomicFile::write(const void* data, std::size_t size) {
  if (std::fwrite(data, 1, size, impl_->stream) != size) fail(std::strerror(errno));
}

void AtomicFile::Impl::finish() {
  if (std::fflush(stream) != 0 || std::ferror(stream) != 0) fail(std::strerror(errno));
  if (sent >= 0) return;
  if (std::fclose(std::exchange(stream, nullptr)) != 0) fail(std::strerror(errno));
}

void AtomicFile::Impl::send() {
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  char bytes[kChunk];
  std::rewind(stream);
  while (const std::size_t n = std::fread(bytes, 1, kChunk, stream))
    for (std::size_t done = 0; done < n;) {
      const ssize_t now = ::write(sent, bytes + done, n - done);
      if (now < 0 && errno == EINTR) continue;
      if (now < 0) fail(std::strerror(errno));
      done += static_cast<std::size_t>(now);
    }
  if (std::ferror(stream) != 0) fail(std::strerror(errno));
  const int fd = sent;
  sent = -1;
  if (::close(fd) != 0) fail(std::strerror(errno));
}

void AtomicFile::commit() {
  AtomicFile* const self = this;
  commit({&self, 1});
}

void AtomicFile::commit(std::span<AtomicFile* const> files) {
  for (AtomicFile* const f : files) f->impl_->finish();
  for (AtomicFile* const f : files)
    if (f->impl_->sent >= 0) f->impl_->send();
  Live& all = live();
  const std::scoped_lock lock(all.mutex);
  for (AtomicFile* const file : files) {
    Impl& f = *file->impl_;
    if (f.temporary.empty()) continue;
    if (::rename(f.temporary.c_str(), f.target.c_str()) != 0) f.fail(std::strerror(errno));
    all.names.erase(f.temporary.string());
    f.temporary.clear();
  }
}

void AtomicFile::Impl::fail(const char* what) const {
  throw Error(Errc::io, asked + ": cannot be written: " + what);
}

std::FILE* open_scratch_file() {
  const char* const said = std::getenv("TMPDIR");
  int fd = -1;
  for (const char* const folder : {said, "/tmp", "/var/tmp", "."})
    if (fd < 0 && folder != nullptr && *folder != '\0') fd = open_nameless(folder);
  // memfd_create, which glibc has from 2.27 on.
  if (fd < 0) fd = static_cast<int>(::syscall(SYS_memfd_create, "rastrum", 1U /* MFD_CLOEXEC */));
  if (fd < 0) return nullptr;
  std::FILE* const stream = ::fdopen(fd, "w+b");
  if (stream == nullptr) ::close(fd);
  return stream;
}

void abandon_files() noexcept {
  Live& all = live();
  all.mutex.lock();  // never unlocked (see the header)
  for (const std::string& name : all.names) ::unlink(name.c_str());
}

void remove_abandoned(PathView folder) {
  std::error_code error;
  for (fs::directory_iterator at(fs::path(folder.text()), error), end; !error && at != end;
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with('.') || !name.ends_with(suffix())) continue;
    const int fd = ::open(at->path().c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) continue;
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0) ::unlink(at->path().c_str());
    ::close(fd);
  }
}

}  // namespace rastrum::io
