// SPDX-License-Identifier: BSD-3-Clause
// One picture of a file: which triangles are seen, found chunk by chunk, and a frame of those.
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

/// Selects these triangles, whose numbers rise; the first one where there are none, since a file
/// without triangles would be one of points.
[[nodiscard]] io::FileSelection selection_of(const io::LargeFile& file,
                                             std::span<const std::uint64_t> triangles);
/// The scene that the ordinary reader makes of a selection, prepared: an instance of a mesh for
/// each part.
[[nodiscard]] Scene scene_of(const io::LargeFile& file, const io::FileSelection& selection,
                             FunctionRef<void(Scene&)> prepare);

[[nodiscard]] std::vector<std::uint64_t> list_of(const Marks& marks);
/// Also marks in `marks` each triangle that shares a position with a marked one. Two walks.
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
  /// Bytes by purpose, from the limit.
  struct Budget {
    std::uint64_t fixed = 0;      ///< whatever is seen
    std::uint64_t scratch = 0;    ///< of renderers
    std::uint64_t triangles = 0;  ///< of chunks, or of what is drawn in the end
  };
  class Seen;

  void check() const;
  void divide_memory();
  /// Marks the triangles that are seen in `rect`. False: they are more than fit at once, and marks
  /// are of no use.
  [[nodiscard]] bool find(Rect rect);
  void find_by_chunks(Rect rect);
  /// Draws the marked triangles alone, and keeps the marks of those that are seen then.
  void sift(Rect rect);
  /// Whether a part of a box may be seen in `rect`.
  [[nodiscard]] bool is_in_sight(const io::FileBox& box, std::size_t part, Rect rect) const;
  /// Draws triangles of a part, whose first id is `first_id`, for their keys in the bins of `rect`;
  /// half after half where their layers do not fit.
  void survey(const MeshView& triangles, std::size_t part, std::uint64_t first_id, Rect rect,
              raster::FragmentSink& sink);
  void survey_at_once(MeshView triangles, std::size_t part, std::uint64_t first_id, Rect rect,
                      raster::FragmentSink& sink);
  /// Chunks as they lie in the file; nearest first where that may hide others.
  [[nodiscard]] std::vector<std::size_t> order() const;
  /// Whether keys of opaque surfaces hide what is behind them.
  [[nodiscard]] bool keys_hide() const;
  /// Whether no sample of a chunk can win against the keys that are there, or tie.
  [[nodiscard]] bool is_hidden(const io::FileBox& box, const Chunks::Place& at) const;
  /// Draws the rows that the targets hold.
  void draw_band();
  void draw(Rect rect);
  /// Draws the pixel with the most layers where it may not fit, so that what cannot be drawn is
  /// refused before the rest is.
  void try_deepest();
  /// Draws about so many pieces of `rect`, one after the other.
  void split(Rect rect, std::uint64_t pieces);
  [[nodiscard]] bool is_whole() const { return options_.rows == 0; }
  [[nodiscard]] Rect picture() const { return {0, 0, frame_.width, frame_.height}; }
  /// The bins that `rect` touches, as far as they are of the band.
  [[nodiscard]] Rect bins_of(Rect rect) const;
  /// Keys at the places that pixels have in the picture.
  [[nodiscard]] ImageView<const std::uint64_t> keys() const;
  /// False: the renderer has no memory for their layers.
  [[nodiscard]] bool draw_marked(Rect rect);
  /// Draws a part of the picture with a scene of a selection, with the ids of the file. Pixels of
  /// targets have the places of the picture.
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

  std::vector<raster::ClusterView> views_;  ///< of each part
  Scene sample_;                            ///< of a triangle of each part: how all of them look
  std::optional<SceneBinding> sample_view_;
  FrameOptions unlit_;  ///< of passes that ask for keys
  std::optional<Renderer> renderer_;
  std::optional<parallel::Threads> threads_;
  std::optional<Chunks> chunks_;
  std::optional<Marks> marks_;
  Rect band_{};
  Image<std::uint64_t> keys_;    ///< of one sample: of the nearest opaque surfaces of the band
  Image<std::uint32_t> layers_;  ///< of each pixel of the band about how many, if translucent
  bool keys_are_whole_ = false;  ///< all chunks are in them, and nothing is translucent
  bool translucent_ = false;
  std::uint64_t seen_ = 0;  ///< marked by find, or more
};

}  // namespace rastrum::out_of_core
