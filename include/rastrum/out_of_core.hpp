// SPDX-License-Identifier: BSD-3-Clause
// Pictures of mesh files that are larger than memory. The file is mapped, and its triangles are
// looked at in chunks, one after the other. The triangles that are seen are drawn as if a file held
// them alone. The picture is that of the whole file, bit for bit. docs/large_files.md says when to
// use it, what it costs and what it refuses.
#pragma once

#include <cstdint>
#include <limits>
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
  /// Bytes for everything: mapped pages in use, copies, scratch and the caller's targets. A picture
  /// that does not fit at once is drawn in pieces. The process itself (code, thread stacks, the
  /// allocator's leftovers) takes some 100 MB more.
  std::uint64_t memory_limit = std::uint64_t{2} << 30;
  std::uint64_t chunk_triangles = 0;  ///< looked at together; 0: as the limit suggests
  std::uint64_t band_triangles = 0;   ///< drawn together; 0: as many as the limit allows
  /// Changes the scene that the reader makes of the visible triangles, before it is drawn: it may
  /// place it, paint it or add normals. It is called several times, for parts of the file, and must
  /// do the same to each. It must not change triangles.
  Function<void(Scene&)> prepare{};
  /// Whether `prepare` looks at the triangles around points (vertex_normals, crease_normals). Then
  /// it is also given the triangles that share a position with one that is seen.
  bool neighbours = false;
  /// Called now and then from the caller's thread: what is being done, and how much of it is.
  Function<void(std::string_view what, std::uint64_t done, std::uint64_t all)> progress{};
  RendererOptions renderer{};  ///< its memory limit is not used
  /// For a picture that is not held whole, as in RanksOptions: how many rows are drawn at once,
  /// from the top, a multiple of 64; 0: all. The targets have this many rows, or the picture's if
  /// it has fewer. `take_rows` is called when they hold its rows [first, last). Each such band
  /// reads the parts of the file that it shows again.
  int rows = 0;
  Function<void(int first, int last)> take_rows{};
};

struct OutOfCoreStats {
  FrameStats frame;             ///< of the last piece that was drawn
  std::uint64_t triangles = 0;  ///< in the file
  std::uint64_t chunk = 0;      ///< triangles looked at together
  std::uint64_t chunks = 0;     ///< looked at, in all passes
  std::uint64_t skipped = 0;    ///< chunks that a pass left out as not needed
  std::uint64_t seen = 0;       ///< triangles that were drawn
  std::uint64_t bands = 0;      ///< pieces of the picture, drawn one after the other
  std::uint64_t dropped = 0;    ///< triangles with a vertex that is not finite
  std::uint64_t pixels_covered = 0;
};

/// A mesh file that is mapped, not read: binary PLY with triangles, binary STL, NPY of triangles,
/// or GLB whose meshes are of indexed triangles and do not move. Its functions may be called by one
/// thread at a time.
class OutOfCoreFile {
 public:
  /// Looks at the header. Throws Error as io::read_scene, Error{unsupported} that says why the file
  /// cannot be drawn this way, and Error{out_of_memory} if a GLB's JSON alone takes more than
  /// `memory_limit`. OutOfCoreOptions::memory_limit counts it, too, but is known later.
  explicit OutOfCoreFile(PathView file,
                         std::uint64_t memory_limit = std::numeric_limits<std::uint64_t>::max());
  ~OutOfCoreFile();
  OutOfCoreFile(OutOfCoreFile&&) noexcept;
  OutOfCoreFile& operator=(OutOfCoreFile&&) noexcept;

  [[nodiscard]] std::uint64_t triangles() const;
  [[nodiscard]] std::uint64_t vertices() const;
  [[nodiscard]] bool has_normals() const;
  [[nodiscard]] bool has_materials() const;
  /// About how much memory its mesh would take; if you have more than that, read the file instead.
  [[nodiscard]] std::uint64_t bytes_in_memory() const;

  /// The scene that `prepare` makes of one triangle of each mesh, with the materials.
  [[nodiscard]] Scene sample(FunctionRef<void(Scene&)> prepare) const;

  /// Draws what a Renderer draws of the scene of io::read_scene after `prepare`, bit for bit, ids
  /// included. `targets` may be all of Targets but keys, overdraw, errors, extra, ids32,
  /// instances32 and primitives32.
  ///
  /// Cost: the file is read once to find what is seen and once to draw it, and twice more with
  /// `neighbours`. Several samples or translucent surfaces that are drawn in pieces read it once
  /// more for each piece. Throws as Renderer::render; Error{unsupported} for what needs all
  /// triangles at once: shadows, Shader::id, CUDA; Error{out_of_memory}, with the limit that would
  /// do, if even the layers of one pixel do not fit, or with Shader::depth the whole picture;
  /// Error{bad_format} as io::read_scene for an error in the file, before a target is touched.
  OutOfCoreStats render(const Camera& camera, const FrameOptions& frame, const Targets& targets,
                        const OutOfCoreOptions& options, StopToken stop = {}) const;

 private:
  friend class FitOfFile;
  Held<Owner<io::LargeFile>> file_;
};

/// Fits a camera to all vertices that the file's triangles use (fit.hpp): give it to the fit with
/// an empty scene. The first fit looks at all indices and vertices, on several threads. Whatever is
/// asked after that is read only from those parts of the file whose boxes may have an answer.
class FitOfFile final : public FitRanks {
 public:
  /// `prepare` as in OutOfCoreOptions; its placing of the meshes counts. `threads` as in
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
