// SPDX-License-Identifier: BSD-3-Clause
// One picture of a file: finds the visible triangles chunk by chunk, then draws a frame of those.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <rastrum/io/large_file.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/out_of_core.hpp>
#include <rastrum/out_of_core/chunks.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/context/fragment_sink.hpp>
#include <rastrum/raster/cull/cluster_view.hpp>

namespace rastrum::out_of_core {

/// Triangles of a file.
using Marks = io::BitSet;

/// Selects these triangles, in rising order; if there are none, the file's first, because a file
/// without triangles would be points.
[[nodiscard]] io::FileSelection selection_of(const io::LargeFile& file,
                                             std::span<const std::uint64_t> triangles);
/// The ordinary reader's scene of a selection, prepared: one instance of a mesh per part.
[[nodiscard]] Scene scene_of(const io::LargeFile& file, const io::FileSelection& selection,
                             FunctionRef<void(Scene&)> prepare);

[[nodiscard]] std::vector<std::uint64_t> list_of(const Marks& marks);
/// Marks each triangle that shares a position with a marked one. Walks through the file twice.
void mark_neighbours(const io::LargeFile& file, Chunks& chunks, parallel::Threads& threads,
                     Marks& marks,
                     FunctionRef<void(std::uint64_t done, std::uint64_t all)> progress);

class Picture {
 public:
  Picture(const io::LargeFile& file, const Camera& camera, const FrameOptions& frame,
          const Targets& targets, const OutOfCoreOptions& options);
  OutOfCoreStats draw();

 private:
  using Rect = raster::Rect;
  /// Bytes by purpose; together the limit.
  struct Budget {
    std::uint64_t fixed = 0;      ///< independent of what is visible
    std::uint64_t scratch = 0;    ///< of renderers
    std::uint64_t triangles = 0;  ///< of chunks, or of the final draw
  };
  class Seen;

  void check() const;
  void divide_memory();
  /// Marks the triangles visible in `rect`. Returns false if they do not fit at once; the marks are
  /// then useless.
  [[nodiscard]] bool find(Rect rect);
  void find_by_chunks(Rect rect);
  /// Draws the marked triangles alone, and keeps the marks of those still visible.
  void sift(Rect rect);
  /// Whether any part of a box may be visible in `rect`.
  [[nodiscard]] bool is_in_sight(const io::FileBox& box, std::size_t part, Rect rect) const;
  /// Draws triangles of a part, from id `first_id` on, to get their keys in the bins of `rect`; by
  /// halves if their layers do not fit.
  void survey(const MeshView& triangles, std::size_t part, std::uint64_t first_id, Rect rect,
              raster::FragmentSink& sink);
  void survey_at_once(MeshView triangles, std::size_t part, std::uint64_t first_id, Rect rect,
                      raster::FragmentSink& sink);
  /// Chunks in the file's order, or nearest first if near ones may hide others.
  [[nodiscard]] std::vector<std::size_t> order() const;
  [[nodiscard]] bool keys_hide() const;
  /// Whether every sample of a chunk loses against the current keys, without a tie.
  [[nodiscard]] bool is_hidden(const io::FileBox& box, const Chunks::Place& at) const;
  void draw_band();
  void draw(Rect rect);
  /// Draws the pixel with the most layers if it may not fit, to refuse an impossible picture early.
  void try_deepest();
  /// Draws `rect` in about `pieces` pieces, one after the other.
  void split(Rect rect, std::uint64_t pieces);
  [[nodiscard]] bool is_whole() const { return options_.rows == 0; }
  [[nodiscard]] Rect picture() const { return {0, 0, frame_.width, frame_.height}; }
  /// The bins that `rect` touches, within the band.
  [[nodiscard]] Rect bins_of(Rect rect) const;
  /// The keys in the picture's coordinates.
  [[nodiscard]] ImageView<const std::uint64_t> keys() const;
  /// Returns false if the renderer has no memory for the layers.
  [[nodiscard]] bool draw_marked(Rect rect);
  /// Draws a part of the picture with a selection's scene and the file's ids. Targets are in the
  /// picture's coordinates.
  void draw_selection(const Scene& scene, const io::FileSelection& selection, Targets targets,
                      Rect part);
  void draw_part(const SceneView& scene, Rect part, const Targets& all);
  [[nodiscard]] bool fits_at_once(std::uint64_t triangles) const;
  [[nodiscard]] std::uint64_t bytes_of(std::uint64_t triangles) const;
  void tell(std::string_view what, std::uint64_t done, std::uint64_t all) const {
    if (options_.progress) options_.progress(what, done, all);
  }
  [[noreturn]] void refuse_memory(std::uint64_t needed) const;

  const io::LargeFile& file_;
  const Camera& camera_;
  FrameOptions frame_;
  const Targets& targets_;
  const OutOfCoreOptions& options_;
  Budget budget_;
  OutOfCoreStats stats_;

  std::vector<raster::ClusterView> views_;  ///< by part
  Scene sample_;                            ///< a triangle of each part, with the look of all
  std::optional<SceneBinding> sample_view_;
  FrameOptions unlit_;  ///< for passes that ask for keys
  std::optional<Renderer> renderer_;
  std::optional<parallel::Threads> threads_;
  std::optional<Chunks> chunks_;
  std::optional<Marks> marks_;
  Rect band_{};
  Image<std::uint64_t> keys_;    ///< one sample: the nearest opaque surfaces of the band
  Image<std::uint32_t> layers_;  ///< about how many translucent layers each pixel of the band has
  bool keys_are_whole_ = false;  ///< they include all chunks, and nothing is translucent
  bool translucent_ = false;
  std::uint64_t seen_ = 0;  ///< marked by find, or more
};

}  // namespace rastrum::out_of_core
