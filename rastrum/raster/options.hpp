// What a caller chooses about a draw, and what comes back beside the picture.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/core/image.hpp>

namespace rastrum {

enum class Cull : std::uint8_t { none, back, front };

/// Instruction sets that the SIMD leaves are compiled for. `scalar` is plain C++.
enum class Isa : std::uint8_t { scalar, sse4, avx2, avx512, neon };
[[nodiscard]] std::string_view name(Isa isa);
/// Those that this machine can run, slowest first; always begins with `scalar`.
[[nodiscard]] std::vector<Isa> available_isas();

/// Images to fill; an empty view is not computed. All must have the frame's size.
struct Targets {
  ImageView<Rgba8> color8;            ///< straight alpha
  ImageView<Vec4> color;              ///< premultiplied float32
  ImageView<float> depth;             ///< reversed depth in [0, 1], 0 where nothing is
  ImageView<std::int64_t> ids;        ///< triangle in submission order, −1 where nothing is
  ImageView<std::uint32_t> overdraw;  ///< fragments at each pixel
};

/// One timed part of a frame, in ms since the frame began.
struct StageTime {
  std::string name;
  double begin_ms = 0, end_ms = 0;
};

struct FrameStats {
  struct Triangles {
    std::uint64_t input = 0;    ///< as submitted
    std::uint64_t dropped = 0;  ///< with a NaN or infinite vertex
    std::uint64_t culled = 0;   ///< facing away, without area, outside the view or between samples
    std::uint64_t clipped = 0;  ///< cut by the near plane or the guard band
    std::uint64_t drawn = 0;    ///< input − dropped − culled, before any early rejection
  } triangles;
  std::uint64_t fragments = 0;       ///< samples covered, over all triangles
  std::uint64_t pixels_covered = 0;  ///< pixels that hold a surface at the end
  std::uint64_t peak_bytes = 0;      ///< scratch, beyond the caller's mesh and images
  std::vector<StageTime> stages;     ///< one after the other; they add up to the frame
  double frame_ms = 0;
  Isa isa = Isa::scalar;
  std::string rasterizer, visibility;
};

}  // namespace rastrum
