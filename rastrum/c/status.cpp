// SPDX-License-Identifier: BSD-3-Clause
// Turns exceptions into a status, and text that the calling thread keeps.
#include <rastrum/c/handles.hpp>

#include <exception>
#include <new>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/stop.hpp>
#include <rastrum/version.hpp>

namespace rastrum::c {
namespace {

struct Failure {
  rastrum_status status = RASTRUM_OK;
  std::string text;
};
Failure& last_failure() noexcept {
  thread_local Failure failure;
  return failure;
}

rastrum_status failed(rastrum_status status, const char* sentence) noexcept {
  Failure& last = last_failure();
  last.status = status;
  try {
    last.text = sentence;
  } catch (...) {
    last.text.clear();
    last.text = "no memory left";  // short enough to need no memory
  }
  return status;
}

rastrum_status status_of(Errc code) noexcept {
  switch (code) {
    case Errc::invalid_argument:
      return RASTRUM_INVALID_ARGUMENT;
    case Errc::not_found:
      return RASTRUM_NOT_FOUND;
    case Errc::io:
      return RASTRUM_IO;
    case Errc::bad_format:
      return RASTRUM_BAD_FORMAT;
    case Errc::unsupported:
      return RASTRUM_UNSUPPORTED;
    case Errc::out_of_memory:
      return RASTRUM_OUT_OF_MEMORY;
    case Errc::no_device:
      return RASTRUM_NO_DEVICE;
    case Errc::stopped:
      return RASTRUM_STOPPED;
  }
  return RASTRUM_UNEXPECTED;
}

}  // namespace

rastrum_status status_of_exception() noexcept {
  try {
    throw;
  } catch (const Error& e) {
    return failed(status_of(e.code()), e.what());
  } catch (const std::bad_alloc&) {
    return failed(RASTRUM_OUT_OF_MEMORY, "there is not enough memory");
  } catch (const std::exception& e) {
    return failed(RASTRUM_UNEXPECTED, e.what());
  } catch (...) {
    return failed(RASTRUM_UNEXPECTED, "something was thrown that is no std::exception");
  }
}

#pragma GCC visibility push( \
    default)  // as in rastrum.h, whose declarations are in another namespace
extern "C" {

const char* rastrum_error_text() {
  return last_failure().text.c_str();
}

rastrum_status rastrum_error_status() {
  return last_failure().status;
}

const char* rastrum_version() {
  return version().data();
}

}  // extern "C"
#pragma GCC visibility pop
}  // namespace rastrum::c
