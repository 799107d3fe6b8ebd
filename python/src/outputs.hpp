// SPDX-License-Identifier: BSD-3-Clause
// The arrays that a frame fills, by their names in Python.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/annotate.hpp>
#include <rastrum/image.hpp>
#include <rastrum/render.hpp>

#include "bindings.hpp"
#include "rasterize.hpp"

namespace rastrum::python {

/// Scratch for pictures that are drawn one after the other.
struct Scratch {
  explicit Scratch(const RendererOptions& o) : annotator(o.threads, o.isa) {}

  Annotator annotator;
  ClipRasterizer clip{};
  std::vector<InstanceView> instances{};
};

struct OutputKind {
  std::string_view name;
  nb::dlpack::dtype type;
  int channels;
  std::function<void(Targets&, const Output&, std::size_t number, const FrameOptions&)> attach;
};

struct Wanted {
  const OutputKind* kind;
  Output array;
};

/// Checks type and shape of the arrays, (pictures, H, W) or (pictures, H, W, channels). Throws
/// Error{invalid_argument} that names one.
[[nodiscard]] std::vector<Wanted> wanted(const std::map<std::string, Output>& outputs,
                                         std::size_t pictures, const FrameOptions& o,
                                         std::uint64_t primitives);

}  // namespace rastrum::python
