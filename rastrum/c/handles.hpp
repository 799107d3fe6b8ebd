// SPDX-License-Identifier: BSD-3-Clause
// The contents of the C interface's handles, and how its functions begin and end: arguments are
// mapped and passed on, and what C++ throws becomes a status. Values are checked where C++ checks
// them; here are only the checks that a type of C++ makes needless (null, the number of an
// instance, the size of memory).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stop_token>
#include <type_traits>
#include <vector>

#include <rastrum.h>
#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/render.hpp>
#include <rastrum/vec.hpp>

struct rastrum_scene {
  std::vector<rastrum::InstanceView> instances;
  /// Each instance's; copies share one until an attribute of it is set.
  std::vector<std::shared_ptr<rastrum::GeometryView>> geometries;
  std::vector<rastrum::ScalarMapping> color_maps;

  [[nodiscard]] rastrum::SceneView view() const { return {instances, {}, {}, color_maps}; }
};

struct rastrum_camera {
  rastrum::Camera camera;
};

struct rastrum_frame {
  rastrum::FrameOptions options;
  rastrum::Targets targets;
  std::stop_source stop;
};

struct rastrum_renderer {
  rastrum::RendererOptions options;
  rastrum::Renderer renderer;
};

namespace rastrum::c {

/// The status of the exception that is being handled; its sentence becomes rastrum_error_text().
[[nodiscard]] rastrum_status status_of_exception() noexcept;

/// Calls f(); nothing that it throws gets out.
template <class F>
[[nodiscard]] rastrum_status guarded(const F& f) noexcept {
  const FloatScope floats;
  try {
    f();
    return RASTRUM_OK;
  } catch (...) {
    return status_of_exception();
  }
}

/// The handle that f() makes, for its caller to free; null where it throws.
template <class F>
[[nodiscard]] auto made(const F& f) noexcept -> decltype(f()) {
  decltype(f()) handle = nullptr;
  (void)guarded([&] { handle = f(); });
  return handle;
}

/// The value behind a pointer. Throws Error{invalid_argument} where that is null.
template <class T>
[[nodiscard]] T& at(T* argument, const char* name) {
  require(argument != nullptr, name, " is null");
  return *argument;
}

/// A constant of C's as the enum whose numbers it has; what the enum does not have stays out of
/// range, and is refused where it is used.
template <class E>
[[nodiscard]] E to_enum(int value) {
  static_assert(std::is_same_v<std::underlying_type_t<E>, std::uint8_t>);
  return static_cast<E>(value >= 0 && value < 255 ? value : 255);
}

[[nodiscard]] inline Vec3d vec3(const double* v, const char* name) {
  (void)at(v, name);
  return {v[0], v[1], v[2]};
}
[[nodiscard]] inline Vec4 vec4(const float* v, const char* name) {
  (void)at(v, name);
  return {v[0], v[1], v[2], v[3]};
}
[[nodiscard]] inline Mat4d matrix(const double* m, const char* name) {
  return matrix_from_rows(&at(m, name));
}

}  // namespace rastrum::c
