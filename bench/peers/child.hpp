// SPDX-License-Identifier: BSD-3-Clause
// Peers in other languages: a process that answers lines with lines. One socket is its stdin and
// stdout. Arrays go through files.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <rastrum/error.hpp>

namespace rastrum::bench {

class Child {
 public:
  /// Starts arguments[0], found along PATH. `who` is for messages. Throws Error{no_device}.
  Child(std::string who, std::vector<std::string> arguments);
  /// Closes the process's input, which ends it.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Throws Error{unsupported} if the process has ended.
  void tell(const std::string& text) const;
  /// The next line; empty if the process has ended.
  [[nodiscard]] std::string line() const;

 private:
  std::string who_;
  pid_t process_ = -1;
  int socket_ = -1;
  std::FILE* answers_ = nullptr;
};

/// A file that carries arrays. The destructor removes it.
class TemporaryFile {
 public:
  TemporaryFile();
  ~TemporaryFile() { std::remove(name_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Writes spans one behind the other.
  template <class... Values>
  void write(const Values&... values) const {
    std::ofstream out(name_, std::ios::binary);
    (out.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size_bytes())),
     ...);
    if (!out.flush()) throw Error(Errc::io, "cannot write " + name_);
  }

 private:
  std::string name_;
};

}  // namespace rastrum::bench
