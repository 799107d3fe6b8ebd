// The arrays that a frame fills, by the names that Python has for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <rastrum/annotate.hpp>
#include <rastrum/image.hpp>
#include <rastrum/render.hpp>

#include "bindings.hpp"
#include "rasterize.hpp"

namespace rastrum::python {

/// Ids of 32 bits: drawn in 64, then narrowed. Numbers that do not fit were refused before.
struct Narrowed {
  std::vector<std::int64_t> wide;

  ImageView<std::int64_t> view(const FrameOptions& o);
  void into(ImageView<std::int32_t> to) const;
};

/// The scratch of who draws one picture after the other.
struct Scratch {
  explicit Scratch(const RendererOptions& o) : annotator(o.threads, o.isa) {}

  Narrowed ids{}, instances{}, primitives{};
  Annotator annotator;
  ClipRasterizer clip{};
};

/// What a frame leaves to be done with its images once it is drawn.
using Finish = std::function<void()>;

struct OutputKind {
  const char* name;
  nb::dlpack::dtype type;
  int channels;
  /// Lets the frame fill it, and says what is left to do.
  Finish (*attach)(Targets&, const Output&, std::size_t number, const FrameOptions&, Scratch&);
};

struct Wanted {
  const OutputKind* kind;
  Output array;
};

/// Checks type and shape of what is to be filled, (pictures, H, W) or (pictures, H, W, channels).
/// Throws Error{invalid_argument} that names it.
[[nodiscard]] std::vector<Wanted> wanted(const std::map<std::string, Output>& outputs,
                                         std::size_t pictures, const FrameOptions& o,
                                         std::uint64_t primitives);

}  // namespace rastrum::python
