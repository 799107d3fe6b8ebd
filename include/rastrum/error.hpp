// SPDX-License-Identifier: BSD-3-Clause
// The exception that the library throws: for bad files, bad arguments and lack of memory. A
// caller's bug inside the library is an assert instead.
#pragma once

#include <stdexcept>
#include <string>

#include <rastrum/config.hpp>

namespace RASTRUM_API rastrum {

enum class Errc {
  invalid_argument,  ///< an option or argument of the caller
  not_found,         ///< a file or name that does not exist
  io,                ///< reading or writing failed
  bad_format,        ///< the file is not what it claims to be
  unsupported,       ///< valid, but outside what Rastrum does
  out_of_memory,     ///< the message says what was asked for
  no_device,         ///< a device or instruction set that is not available here
  stopped,           ///< on request; the exception is Stopped (stop.hpp)
};

/// `what()` is a whole sentence for a person: it names the file, line or argument, and what to do.
class Error : public std::runtime_error {
 public:
  Error(Errc code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] Errc code() const noexcept { return code_; }

 private:
  Errc code_;
};

}  // namespace rastrum
