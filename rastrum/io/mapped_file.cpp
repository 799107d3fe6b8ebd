// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/mapped_file.hpp>

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
#include <rastrum/io/system.hpp>

namespace rastrum::io {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
  const Errc code = error == ENOENT || error == ENOTDIR ? Errc::not_found : Errc::io;
  throw Error(code, file.string() + ": cannot be read: " + std::strerror(error));
}

struct FilesRead {
  std::atomic<bool> remembers{false};
  std::mutex mutex;
  std::set<FileId> files;
};
FilesRead& all() {
  static FilesRead* const files = new FilesRead;  // never destroyed: a thread may read at the end
  return *files;
}

void remember(const FileInfo& file) {
  if (!all().remembers || file.kind != FileInfo::Kind::regular) return;
  const std::scoped_lock lock(all().mutex);
  all().files.insert(file.id);
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

std::optional<FileId> id_of(const std::filesystem::path& file) {
  const std::optional<FileInfo> info = info_of(file);
  if (!info) return {};
  return info->id;
}

void remember_read(const std::filesystem::path& file) {
  if (const std::optional<FileInfo> info = info_of(file)) remember(*info);
}

bool was_read(const std::filesystem::path& file) {
  const std::optional<FileId> id = id_of(file);
  if (!id) return false;
  const std::scoped_lock lock(all().mutex);
  return all().files.contains(*id);
}

MappedFile::MappedFile(const std::filesystem::path& file, Kind kind) : file_(file) {
  // A pipe is refused below, with or without a writer.
  const Descriptor d{open_to_read(file, kind != Kind::regular)};
  if (d.fd < 0) fail(file, errno);
  const std::optional<FileInfo> info = info_of(d.fd);
  if (!info) fail(file, errno);
  if (info->kind == FileInfo::Kind::folder) fail(file, EISDIR);
  remember(*info);
  if (info->kind != FileInfo::Kind::regular) {
    if (kind == Kind::regular)
      throw Error(Errc::io, file.string() + ": is no regular file, and is not read");
    copy(d.fd);
    return;
  }
  if (!std::in_range<std::size_t>(info->bytes)) fail(file, EFBIG);
  size_ = static_cast<std::size_t>(info->bytes);
  if (size_ == 0) return;  // systems refuse empty mappings
  data_ = map_file(d.fd, size_);
  if (data_ == nullptr) fail(file, errno);
  mapped_.emplace(data_, size_);
  if (mapped_->watches()) {
    advise(MapAdvice::sequential, data_, size_);
    return;
  }
  mapped_.reset();
  unmap_file(data_, size_);
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
  const std::size_t page = page_bytes();
  const std::size_t begin = offset / page * page, end = offset + std::min(size, size_ - offset);
  advise(MapAdvice::will_need, data_ + begin, end - begin);
}

void MappedFile::drop(std::size_t offset, std::size_t size) const {
  if (!mapped_ || offset >= size_) return;
  const std::size_t page = page_bytes();
  const std::size_t begin = (offset + page - 1) / page * page;
  // The file's last page counts as whole.
  const std::size_t stop = offset + std::min(size, size_ - offset);
  const std::size_t end = stop == size_ ? stop : stop / page * page;
  if (begin < end) advise(MapAdvice::drop, data_ + begin, end - begin);
}

MappedFile::~MappedFile() {
  if (!mapped_) return;
  mapped_.reset();  // before another file may be mapped there
  unmap_file(data_, size_);
}

}  // namespace rastrum::io
