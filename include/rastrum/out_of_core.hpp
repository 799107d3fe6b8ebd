// SPDX-License-Identifier: BSD-3-Clause
// Pictures of mesh files that are larger than memory: the file is mapped, its triangles are looked
// at in chunks, one after the other, and those that are seen are drawn as a file of them alone
// would be. The picture is the one of the whole file, bit for bit. docs/large_files.md has when to
// use it, what it costs, what it refuses.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/function.hpp>
#include <rastrum/held.hpp>
#include <rastrum/mat.hpp>
#include <rastrum/path.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::io {
class LargeFile;
}

namespace RASTRUM_API rastrum {

struct OutOfCoreOptions {
  /// Bytes for all of it: mapped pages in use, copies, scratch and the caller's targets. A
  /// picture that does not fit at once is drawn in pieces. The process itself (code, thread stacks,
  /// the allocator's leftovers) comes on top, some 100 MB.
  std::uint64_t memory_limit = std::uint64_t{2} << 30;
  std::uint64_t chunk_triangles = 0;  ///< at once; 0: what the limit suggests
  std::uint64_t band_triangles = 0;   ///< drawn in the end at once; 0: what the limit allows
  /// Changes the scene that the reader makes of the visible triangles, before they are drawn: it
  /// may place it, paint it, add normals. It is called several times, for parts of the file, and
  /// must do the same to each; it must not change triangles.
  Function<void(Scene&)> prepare{};
  /// Whether `prepare` looks at triangles around points (vertex_normals, crease_normals): those
  /// that share a position with one that is seen are given to it, too.
  bool neighbours = false;
  /// Called now and then from the caller's thread: what is being done, and how much of it is.
  Function<void(std::string_view what, std::uint64_t done, std::uint64_t all)> progress{};
  RendererOptions renderer{};  ///< its memory limit is not used
  /// For pictures that are not held whole, as in RanksOptions: the number of rows at once, a
  /// multiple of 64, from the top; 0: all. The targets have these rows, or the picture's where it
  /// has fewer. `take_rows` is called when they hold the rows [first, last). The parts of the file
  /// that such a band shows are read again for it.
  int rows = 0;
  Function<void(int first, int last)> take_rows{};
};

struct OutOfCoreStats {
  FrameStats frame;             ///< of what was drawn in the end, the last piece
  std::uint64_t triangles = 0;  ///< of the file
  std::uint64_t chunk = 0;      ///< triangles looked at together
  std::uint64_t chunks = 0;     ///< that were looked at, in all passes
  std::uint64_t skipped = 0;    ///< that a walk left out, having nothing of interest
  std::uint64_t seen = 0;       ///< triangles drawn in the end
  std::uint64_t bands = 0;      ///< pieces of the picture, drawn one after the other
  std::uint64_t dropped = 0;    ///< triangles with a vertex that is not finite
  std::uint64_t pixels_covered = 0;
};

/// A mesh file that is mapped and not read: binary PLY with triangles, binary STL, GLB whose meshes
/// are of indexed triangles and do not move, NPY of triangles. Its functions may be called by one
/// thread at a time.
class OutOfCoreFile {
 public:
  /// Looks at the header. Throws Error as io::read_scene, and Error{unsupported} that says why the
  /// file cannot be drawn so. Throws Error{out_of_memory} where a GLB's JSON alone takes more than
  /// `memory_limit`; that of a picture (OutOfCoreOptions) counts it, too, but is known later.
  explicit OutOfCoreFile(PathView file,
                         std::uint64_t memory_limit = std::numeric_limits<std::uint64_t>::max());
  ~OutOfCoreFile();
  OutOfCoreFile(OutOfCoreFile&&) noexcept;
  OutOfCoreFile& operator=(OutOfCoreFile&&) noexcept;

  [[nodiscard]] std::uint64_t triangles() const;
  [[nodiscard]] std::uint64_t vertices() const;
  [[nodiscard]] bool has_normals() const;
  [[nodiscard]] bool has_materials() const;
  /// About the memory that its mesh would take: with more than that, read the file instead.
  [[nodiscard]] std::uint64_t bytes_in_memory() const;

  /// The scene that `prepare` makes of one triangle of each mesh, with the materials, for instance.
  [[nodiscard]] Scene sample(FunctionRef<void(Scene&)> prepare) const;

  /// The picture that a Renderer draws of the file as io::read_scene has it, prepared, bit for bit,
  /// its ids too. `targets` are all of Targets but keys, overdraw, errors, extra, ids32,
  /// instances32 and primitives32.
  ///
  /// Cost: the file is read once for what is seen and once for what is drawn, with `neighbours`
  /// twice more; for several samples or translucent surfaces in several pieces once more a piece.
  /// Throws as Renderer::render; Error{unsupported} for what needs all triangles at once: shadows,
  /// Shader::id, CUDA; Error{out_of_memory} that says what the limit would have to be, where layers
  /// of one pixel do not fit before the other pixels are drawn; Error{bad_format} as io::read_scene
  /// for what is wrong with the file, before a target is touched.
  OutOfCoreStats render(const Camera& camera, const FrameOptions& frame, const Targets& targets,
                        const OutOfCoreOptions& options, StopToken stop = {}) const;

 private:
  friend class FitOfFile;
  Held<Owner<io::LargeFile>> file_;
};

/// Fits a camera to all that the file's triangles use (fit.hpp): give it to the fit with a scene
/// that is empty. The first fit looks at all indices and vertices, on several threads; what it, and
/// others, ask after that is read only of those parts of the file whose boxes may have an answer.
class FitOfFile final : public FitRanks {
 public:
  /// `prepare` as in OutOfCoreOptions: where it places the meshes counts. `threads` as in
  /// RendererOptions; the camera is the same for any number.
  explicit FitOfFile(const OutOfCoreFile& file, FunctionRef<void(Scene&)> prepare = {},
                     int threads = 0);
  ~FitOfFile() override;
  void own(FunctionRef<void()> work) override { work(); }
  [[nodiscard]] std::vector<double> gather(std::span<const double> numbers) override {
    return {numbers.begin(), numbers.end()};
  }
  [[nodiscard]] const FitVertices* beyond() const override;

 private:
  class RASTRUM_INSIDE Vertices;
  Owner<const Vertices> vertices_;
};

}  // namespace rastrum
