// SPDX-License-Identifier: BSD-3-Clause
// Files are opened with the right to rename and remove them meanwhile, as elsewhere.
#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <cerrno>
#include <cstdio>
#include <cwchar>

#include <rastrum/io/system.hpp>

namespace rastrum::io {
namespace fs = std::filesystem;
namespace {

constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

void set_errno() {
  switch (::GetLastError()) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_NAME:
      errno = ENOENT;
      break;
    case ERROR_FILE_EXISTS:
    case ERROR_ALREADY_EXISTS:
      errno = EEXIST;
      break;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION:
    case ERROR_LOCK_VIOLATION:
      errno = EACCES;
      break;
    case ERROR_NOT_ENOUGH_MEMORY:
      errno = ENOMEM;
      break;
    default:
      errno = EIO;
  }
}

HANDLE handle_of(int descriptor) {
  return reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));
}

int descriptor_of(HANDLE handle, int flags) {
  if (handle == INVALID_HANDLE_VALUE) {
    set_errno();
    return -1;
  }
  const int fd =
      ::_open_osfhandle(reinterpret_cast<intptr_t>(handle), flags | _O_BINARY | _O_NOINHERIT);
  if (fd < 0) ::CloseHandle(handle);
  return fd;
}

int open_file(const fs::path& file, DWORD access, DWORD how, int flags, DWORD attributes = 0) {
  return descriptor_of(
      ::CreateFileW(file.c_str(), access, kShared, nullptr, how, attributes, nullptr), flags);
}

std::optional<FileInfo> info_of(HANDLE handle) {
  FileInfo info;
  if (::GetFileType(handle) != FILE_TYPE_DISK) return info;
  BY_HANDLE_FILE_INFORMATION file{};
  if (::GetFileInformationByHandle(handle, &file) == 0) {
    set_errno();
    return {};
  }
  info.kind = (file.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0 ? FileInfo::Kind::folder
                                                                      : FileInfo::Kind::regular;
  info.bytes = (std::uint64_t{file.nFileSizeHigh} << 32U) | file.nFileSizeLow;
  info.read_only = (file.dwFileAttributes & FILE_ATTRIBUTE_READONLY) != 0;
  info.id = {file.dwVolumeSerialNumber,
             (std::uint64_t{file.nFileIndexHigh} << 32U) | file.nFileIndexLow};
  return info;
}

/// Locks a byte that no file has, since a locked byte cannot be read.
bool lock(HANDLE handle) {
  OVERLAPPED at{};
  at.OffsetHigh = 0x7fffffff;
  return ::LockFileEx(handle, LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY, 0, 1, 0, &at) !=
         0;
}

}  // namespace

std::optional<FileInfo> info_of(const fs::path& file) {
  // Folders are opened with this flag alone.
  const HANDLE handle = ::CreateFileW(file.c_str(), FILE_READ_ATTRIBUTES, kShared, nullptr,
                                      OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
  if (handle == INVALID_HANDLE_VALUE) {
    set_errno();
    return {};
  }
  const std::optional<FileInfo> info = info_of(handle);
  ::CloseHandle(handle);
  return info;
}
std::optional<FileInfo> info_of(int descriptor) {
  return info_of(handle_of(descriptor));
}
bool may_write(const fs::path& file_or_folder) {
  return ::_waccess(file_or_folder.c_str(), 2) == 0;
}

int open_to_read(const fs::path& file, bool /*wait*/) {
  if (file == "/dev/stdin") {
    ::_setmode(0, _O_BINARY);
    return ::_dup(0);
  }
  return open_file(file, GENERIC_READ, OPEN_EXISTING, _O_RDONLY, FILE_FLAG_BACKUP_SEMANTICS);
}
int open_to_write(const fs::path& file) {
  return open_file(file, GENERIC_WRITE, OPEN_EXISTING, _O_WRONLY);
}
int open_standard_output() {
  ::_setmode(1, _O_BINARY);
  return ::_dup(1);
}
int duplicate(int descriptor) {
  return ::_dup(descriptor);
}
int create_file(const fs::path& file) {
  return open_file(file, GENERIC_WRITE, CREATE_NEW, _O_WRONLY);
}
void take_mode(int /*descriptor*/, const fs::path& /*target*/) {}

bool lock_file(int descriptor) {
  FILE_STANDARD_INFO info{};
  return lock(handle_of(descriptor)) &&
         ::GetFileInformationByHandleEx(handle_of(descriptor), FileStandardInfo, &info,
                                        sizeof info) != 0 &&
         info.DeletePending == 0;
}
void remove_unlocked(const fs::path& file) {
  const HANDLE handle =
      ::CreateFileW(file.c_str(), GENERIC_WRITE, kShared, nullptr, OPEN_EXISTING, 0, nullptr);
  if (handle == INVALID_HANDLE_VALUE) return;
  if (lock(handle)) ::DeleteFileW(file.c_str());
  ::CloseHandle(handle);
}
std::string host_name() {
  char name[MAX_COMPUTERNAME_LENGTH + 1] = {};
  DWORD size = sizeof name;
  return ::GetComputerNameA(name, &size) != 0 ? name : "";
}

bool after_fork(void (* /*run*/)()) {
  return false;
}

const std::byte* map_file(int descriptor, std::size_t bytes) {
  const HANDLE mapping =
      ::CreateFileMappingW(handle_of(descriptor), nullptr, PAGE_READONLY, 0, 0, nullptr);
  void* const data =
      mapping == nullptr ? nullptr : ::MapViewOfFile(mapping, FILE_MAP_READ, 0, 0, bytes);
  if (data == nullptr) set_errno();
  if (mapping != nullptr) ::CloseHandle(mapping);  // the view keeps it
  return static_cast<const std::byte*>(data);
}
void unmap_file(const std::byte* data, std::size_t /*bytes*/) {
  ::UnmapViewOfFile(data);
}
/// Windows reads ahead and drops pages by its own rules.
void advise(MapAdvice /*advice*/, const std::byte* /*begin*/, std::size_t /*bytes*/) {}
std::size_t page_bytes() {
  return 4096;
}

std::FILE* open_scratch_file() {
  wchar_t folder[MAX_PATH + 1] = {}, name[MAX_PATH + 1] = {};
  if (::GetTempPathW(MAX_PATH, folder) == 0 || ::GetTempFileNameW(folder, L"ras", 0, name) == 0) {
    set_errno();
    return nullptr;
  }
  const int fd = open_file(name, GENERIC_READ | GENERIC_WRITE | DELETE, CREATE_ALWAYS, _O_RDWR,
                           FILE_FLAG_DELETE_ON_CLOSE);
  if (fd < 0) return nullptr;
  std::FILE* const stream = ::_fdopen(fd, "w+b");
  if (stream == nullptr) ::_close(fd);
  return stream;
}

}  // namespace rastrum::io
