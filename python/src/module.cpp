// SPDX-License-Identifier: BSD-3-Clause
// The module `rastrum._rastrum`: the C++ library for the package's own Python.
#include <new>
#include <string>

#include <rastrum/version.hpp>

#include "annotations.hpp"
#include "bindings.hpp"

namespace rastrum::python {
namespace {

/// The package's exceptions by code (rastrum/_errors.py); each is also the natural class.
const char* class_of(Errc code) {
  switch (code) {
    case Errc::invalid_argument:
      return "ArgumentError";
    case Errc::not_found:
      return "NotFoundError";
    case Errc::io:
      return "FileError";
    case Errc::bad_format:
      return "FormatError";
    case Errc::unsupported:
      return "UnsupportedError";
    case Errc::out_of_memory:
      return "OutOfMemoryError";
    case Errc::no_device:
      return "DeviceError";
    case Errc::stopped:
      break;  // caught where frames are drawn
  }
  return "Error";
}

void raise(const char* name, const char* what) {
  const nb::object type = nb::module_::import_("rastrum._errors").attr(name);
  PyErr_SetString(type.ptr(), what);
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& e) {
    raise(class_of(e.code()), e.what());
  } catch (const std::bad_alloc&) {
    raise(
        "OutOfMemoryError",
        "there is not enough memory; give memory_limit, and the frame is drawn in pieces that fit");
  }
}

}  // namespace
}  // namespace rastrum::python

NB_MODULE(_rastrum, m) {
  namespace py = rastrum::python;
  nanobind::register_exception_translator(py::translate);
  m.attr("version") = std::string(rastrum::version()).c_str();
  py::bind_geometries(m);
  py::bind_cameras(m);
  py::bind_scenes(m);
  py::bind_annotations(m);
  py::bind_lights(m);
  py::bind_frames(m);
  py::bind_outputs(m);
  py::bind_terrains(m);
  py::bind_ranks(m);
}
