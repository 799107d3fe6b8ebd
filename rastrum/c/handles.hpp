// SPDX-License-Identifier: BSD-3-Clause
// The contents of the C interface's handles, and how its functions map arguments and turn
// exceptions into a status. C++ checks the values. Here are only checks that C++ types make
// unnecessary: null, an instance's number, the size of memory.
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
  /// One per instance; copies share one until an attribute is set.
  std::vector<std::shared_ptr<rastrum::GeometryView>> geometries;
  std::vector<rastrum::ScalarMapping> color_maps;
  /// A reader's scene, which the instances refer to; null: all arrays are the caller's.
  std::shared_ptr<const rastrum::Scene> read;

  [[nodiscard]] rastrum::SceneView view() const {
    if (read == nullptr) return {instances, {}, {}, color_maps};
    return {instances, read->materials, read->textures, color_maps};
  }
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

/// The status of the exception being handled; its text becomes rastrum_error_text().
[[nodiscard]] rastrum_status status_of_exception() noexcept;

/// Calls f() and catches all exceptions.
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

/// The handle that f() makes, for the caller to free; null if it throws.
template <class F>
[[nodiscard]] auto made(const F& f) noexcept -> decltype(f()) {
  decltype(f()) handle = nullptr;
  (void)guarded([&] { handle = f(); });
  return handle;
}

/// The value behind a pointer. Throws Error{invalid_argument} if it is null.
template <class T>
[[nodiscard]] T& at(T* argument, const char* name) {
  require(argument != nullptr, name, " is null");
  return *argument;
}

/// A C constant as the enum with the same numbers. Other values become out of range, and are
/// refused where they are used.
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
