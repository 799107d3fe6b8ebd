// Whole or absent: a file is written under a temporary name in the same directory and renamed.
// Several become visible together: all are written before the first is renamed.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <span>

namespace rastrum::io {

/// Chooses standard output in the place of a file.
struct StandardOutput {};

/// Without commit() the destructor removes the temporary. A symbolic link is followed. A target
/// that exists and is not a regular file (a device) is written directly; what cannot seek (a pipe)
/// and standard output get their bytes at commit(), so that nothing leaves before all is written.
/// Every member throws Error{io} naming the file. Cost: what the system's calls cost.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& file);
  explicit AtomicFile(StandardOutput);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The open stream, which can seek; check nothing, commit() does.
  [[nodiscard]] std::FILE* stream() { return stream_; }
  void write(const void* data, std::size_t size);
  void commit();
  /// All are finished, then those for pipes sent, then the temporaries renamed: where one of them
  /// cannot be finished none is seen.
  static void commit(std::span<AtomicFile* const> files);
  /// The error for a failure seen elsewhere; `what` is the reason.
  [[noreturn]] void fail(const char* what) const;
  /// The name as the caller gave it, for messages.
  [[nodiscard]] const std::filesystem::path& name() const { return asked_; }

 private:
  void open_temporary();
  void spool(int fd);
  void finish();
  void send();

  std::filesystem::path asked_;      ///< as the caller spelled it, for messages
  std::filesystem::path target_;     ///< links resolved
  std::filesystem::path temporary_;  ///< empty: written directly, or sent
  std::FILE* stream_ = nullptr;
  int lock_ = -1;  ///< the temporary's, so that others see that it is in work
  int sent_ = -1;  ///< where the bytes of a spooled file go
};

/// For a program that ends by a signal: removes the temporaries of all files that are in work, and
/// holds every thread that begins or commits one from then on, so that nothing is half there. Call
/// it from a thread, not from a signal's handler, and end the process next: it cannot be undone.
void abandon_files() noexcept;

/// Removes the temporaries in `folder` that a writer which was killed has left. Those of living
/// writers are locked, on other machines of a cluster too, and are not touched; nor is anything
/// where locks are not known. What cannot be removed is left. O(names in the folder).
void remove_abandoned(const std::filesystem::path& folder);

}  // namespace rastrum::io
