// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io.hpp>

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/io/files.hpp>
#include <rastrum/io/system.hpp>

namespace rastrum::io {
namespace fs = std::filesystem;
namespace {

/// The suffix of this host's temporaries. Each container is a host.
const std::string& suffix() {
  static const std::string all = "@" + host_name() + ".rastrum-tmp";
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

/// The temporaries of this process. Making, renaming or removing one needs the mutex.
struct Live {
  std::mutex mutex;
  std::set<fs::path> names;
};
Live& live() {
  static Live* all = new Live;  // never destroyed: a thread may still write at the end
  // A forked child has its own. Another thread may hold the parent's, whose names are not the
  // child's to remove.
  static const bool registered = after_fork([] { all = new Live; });
  static_cast<void>(registered);
  return *all;
}

void forget(const fs::path& temporary) {
  Live& all = live();
  const std::scoped_lock lock(all.mutex);
  std::error_code ignored;
  fs::remove(temporary, ignored);
  all.names.erase(temporary);
}

}  // namespace

std::string why_not_writable(const fs::path& file) {
  using Kind = FileInfo::Kind;
  const std::optional<FileInfo> info = info_of(file);
  if (!info && errno == ELOOP) return std::strerror(errno);
  if (info && info->kind == Kind::folder) return "it is a directory";
  // Refused for root, too, who hardly wants to lose the file.
  if (info && info->kind == Kind::regular && info->read_only) return "it is read-only";
  if (info && !may_write(file)) return std::strerror(errno);
  if (info && info->kind != Kind::regular) return {};  // a device, a pipe: written in place
  const fs::path folder = folder_of(follow_links(file));
  const std::optional<FileInfo> around = info_of(folder);
  if (!around || around->kind != Kind::folder)
    return "there is no directory " + folder.string() + "; create it first";
  if (!may_write(folder)) return folder.string() + ": " + std::strerror(errno);
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
  const std::optional<FileInfo> info = info_of(file);
  if (info && info->kind != FileInfo::Kind::regular) {
    const int fd = open_to_write(file);
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
  const int fd = open_standard_output();
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
    const int fd = create_file(name);
    error = fd < 0 ? errno : 0;
    if (fd < 0) continue;
    if (!lock_file(fd)) {  // another process took it for an abandoned one
      ::close(fd);
      error = EEXIST;
      continue;
    }
    take_mode(fd, target);
    lock = duplicate(fd);
    stream = ::fdopen(fd, "wb");
    if (lock >= 0 && stream != nullptr) {
      all.names.insert(name);
      temporary = name;
      return;
    }
    error = errno;
    if (stream == nullptr) ::close(fd);
    std::error_code ignored;
    fs::remove(name, ignored);
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
  while (const auto n = static_cast<unsigned>(std::fread(bytes, 1, kChunk, stream)))
    for (unsigned done = 0; done < n;) {
      const ssize_t now = ::write(sent, bytes + done, n - done);
      if (now < 0 && errno == EINTR) continue;
      if (now < 0) fail(std::strerror(errno));
      done += static_cast<unsigned>(now);
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
    std::error_code error;
    fs::rename(f.temporary, f.target, error);
    if (error) f.fail(error.message().c_str());
    all.names.erase(f.temporary);
    f.temporary.clear();
  }
}

void AtomicFile::Impl::fail(const char* what) const {
  throw Error(Errc::io, asked + ": cannot be written: " + what);
}

void abandon_files() noexcept {
  Live& all = live();
  all.mutex.lock();  // never unlocked (see the header)
  std::error_code ignored;
  for (const fs::path& name : all.names) fs::remove(name, ignored);
}

void remove_abandoned(PathView folder) {
  std::error_code error;
  for (fs::directory_iterator at(fs::path(folder.text()), error), end; !error && at != end;
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with('.') || !name.ends_with(suffix())) continue;
    remove_unlocked(at->path());
  }
}

}  // namespace rastrum::io
