// Whole or absent: a file is written under a temporary name in the same directory and renamed.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>

namespace rastrum::io {

/// Without commit() the destructor removes the temporary. A target that exists and is not a regular
/// file (a device, a pipe) is written directly; a symbolic link is followed.
/// Every member throws Error{io} naming the file.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& file);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The open stream; check nothing, commit() does.
  [[nodiscard]] std::FILE* stream() { return stream_; }
  /// Where the bytes are until commit(), for libraries that open files themselves.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  void write(const void* data, std::size_t size);
  void commit();
  /// The error for a failure seen elsewhere; `what` is the reason.
  [[noreturn]] void fail(const char* what) const;

 private:
  std::filesystem::path asked_;      ///< as the caller spelled it, for messages
  std::filesystem::path target_;     ///< links resolved
  std::filesystem::path temporary_;  ///< equal to target_: written directly
  std::FILE* stream_ = nullptr;
};

}  // namespace rastrum::io
