// SPDX-License-Identifier: BSD-3-Clause
// Shared by the sources of the module.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <rastrum/array.hpp>
#include <rastrum/error.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/prepared_mesh.hpp>
#include <rastrum/scalars.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::python {

namespace nb = nanobind;

/// Any array in this process's memory, which it keeps alive.
using Array = nb::ndarray<nb::ro, nb::device::cpu>;
/// A writable one.
using Output = nb::ndarray<nb::device::cpu>;

/// An instance's geometry, and the arrays that it views. It never changes, so that any number of
/// threads may draw it.
struct ArrayGeometry {
  std::shared_ptr<const GeometryView> view{};  ///< frames share it
  std::vector<Array> kept{};
  bool has_colors = false;
  std::shared_ptr<const PreparedMesh> prepared{};  ///< of a mesh, which the view then shows
};

/// The enum value at the place of `name` in `names`. Throws Error{invalid_argument} that begins
/// with `what` and lists the names.
template <class Enum, std::size_t N>
[[nodiscard]] Enum named(const char* what, const std::string& name, const char* const (&names)[N]) {
  std::string all;
  for (std::size_t i = 0; i < N; ++i) {
    if (name == names[i]) return static_cast<Enum>(i);
    all += (i > 0 ? ", " : "") + std::string(names[i]);
  }
  throw Error(Errc::invalid_argument,
              std::string(what) + ": there is no " + name + "; take one of " + all);
}

/// (N, channels) numbers, or (N,) for one channel, of any stride, as a view; nothing is copied.
/// Throws Error{invalid_argument} that begins with `name`.
template <ViewedValue T>
[[nodiscard]] ArrayView<T> values(const Array& array, const char* name);
/// (N,) numbers of any type and stride, as a view.
[[nodiscard]] ScalarView scalars(const Array& array, const char* name);
/// Any shape of integers, read in C order: (N,), or (M, K), whose rows may have gaps only if they
/// have one stride.
[[nodiscard]] IndexView indices(const Array& array, const char* name);
/// Row-major (4, 4) or (3, 4) of float64.
[[nodiscard]] Mat4d matrix(const Array& array, const char* name);
/// All numbers of a C-contiguous array of float64.
[[nodiscard]] inline std::span<const double> doubles(const Array& array) {
  return {static_cast<const double*>(array.data()), array.size()};
}

/// A signal's handler sets it, and frames read it. The kernel may run the handler on any thread,
/// and so after the frame has ended: these are static and never freed.
struct SignalFlag {
  std::atomic<bool> came{false};
  [[nodiscard]] bool stop_requested() const { return came.load(std::memory_order_relaxed); }
};
static_assert(std::atomic<bool>::is_always_lock_free);  // a handler may write it

/// Ctrl-C asks the frame to stop, while Python's own handler would only note it. Works on the
/// process's main thread only. Python's handler runs as well, so that PyErr_CheckSignals() can act
/// on it afterwards.
class StopOnInterrupt {
 public:
  StopOnInterrupt();
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
  [[nodiscard]] StopToken token() const;

 private:
  bool installed_ = false;
};

void bind_geometries(nb::module_& m);
void bind_cameras(nb::module_& m);
void bind_scenes(nb::module_& m);
void bind_frames(nb::module_& m);
void bind_outputs(nb::module_& m);
void bind_lights(nb::module_& m);
void bind_terrains(nb::module_& m);
void bind_ranks(nb::module_& m);

}  // namespace rastrum::python
