// One picture of a file: which triangles are seen, found chunk by chunk, and a frame of those.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <rastrum/io/large_file.hpp>
#include <rastrum/mesh.hpp>
#include <rastrum/out_of_core.hpp>
#include <rastrum/out_of_core/marks.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/raster/cull/cluster_view.hpp>
#include <rastrum/raster/frame/fragment_sink.hpp>

namespace rastrum::out_of_core {

/// Of these triangles, which rise; where there are none, of the first, since a file of none would
/// be one of points.
[[nodiscard]] io::FileSelection selection_of(const io::LargeFile& file,
                                             std::span<const std::uint64_t> triangles);
/// What the ordinary reader makes of a selection, prepared: an instance of a mesh for each part.
[[nodiscard]] Scene scene_of(const io::LargeFile& file, const io::FileSelection& selection,
                             const std::function<void(Scene&)>& prepare);

/// Walks through a file chunk after chunk; the next one is read while f(chunk) works on one.
class Chunks {
 public:
  /// Where a chunk lies: within one part.
  struct Place {
    std::size_t number = 0, part = 0;
    std::uint64_t first = 0, count = 0;
  };
  /// Whether to read a chunk at all; empty: each.
  using Wanted = std::function<bool(const Place&)>;
  using Work = std::function<void(const io::FileChunk&, const Place&)>;
  /// `triangles`: of a chunk, at most.
  Chunks(const io::LargeFile& file, std::uint64_t triangles, std::size_t vertex_bytes);
  /// f throws, or reading does: the walk ends by that.
  void walk(const Work& f, const Wanted& wanted = {}) { walk(in_file_, f, wanted); }
  /// The same in another order of all chunks, by their numbers.
  void walk(std::span<const std::size_t> order, const Work& f, const Wanted& wanted);
  [[nodiscard]] const std::vector<Place>& places() const { return places_; }
  [[nodiscard]] std::uint64_t read() const { return read_; }
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }
  /// Of the walk that has read it, or of the file's own look at all (LargeFile::box). None where
  /// nobody has, or where a vertex is not finite: such a chunk is always read, and its triangles
  /// counted.
  [[nodiscard]] std::optional<io::FileBox> box(const Place& chunk) const;

 private:
  const io::LargeFile& file_;
  std::size_t vertex_bytes_;
  std::vector<Place> places_;
  std::vector<std::size_t> in_file_;  ///< 0, 1, …
  io::FileChunk two_[2];
  std::vector<std::optional<io::FileBox>> boxes_;  ///< of chunks that were read
  std::uint64_t read_ = 0, left_out_ = 0;
};

/// Marks in `marks`, too, what shares a position with a triangle that is marked. Two walks.
void mark_neighbours(const io::LargeFile& file, Chunks& chunks, parallel::Threads& threads,
                     Marks& marks,
                     const std::function<void(std::uint64_t done, std::uint64_t all)>& progress);

class Picture {
 public:
  Picture(const io::LargeFile& file, const Camera& camera, const FrameOptions& frame,
          const Targets& targets, const OutOfCoreOptions& options);
  OutOfCoreStats draw();

 private:
  /// Rows of the picture.
  struct Rows {
    int begin, end;
  };
  /// Bytes by purpose, from the limit.
  struct Budget {
    std::uint64_t scratch = 0;    ///< of renderers
    std::uint64_t triangles = 0;  ///< of chunks, or of what is drawn in the end
  };
  class Seen;

  void check() const;
  void divide_memory();
  /// Marks what is seen in `rows`. False: it is more than fits at once, marks are of no use.
  [[nodiscard]] bool find(Rows rows);
  [[nodiscard]] bool find_by_chunks(Rows rows);
  /// What is left of the marks if only what is marked is drawn.
  void sift(Rows rows);
  /// Whether something of a box may be seen in these rows.
  [[nodiscard]] bool is_in_sight(const io::FileBox& box, std::size_t part, Rows rows) const;
  /// Draws triangles of a part, whose first id this is, for their keys.
  void survey(const MeshView& triangles, std::size_t part, std::uint64_t first_id,
              raster::FragmentSink& sink);
  /// Chunks as they lie in the file; nearest first where that may hide others.
  [[nodiscard]] std::vector<std::size_t> order() const;
  /// Whether keys of opaque surfaces hide what is behind them.
  [[nodiscard]] bool keys_hide() const;
  /// Whether no sample of a chunk can win against the keys that are there, or tie.
  [[nodiscard]] bool is_hidden(const io::FileBox& box, const Chunks::Place& at) const;
  /// Draws the rows that the targets hold.
  void draw_band();
  void draw(Rows rows);
  void split(Rows rows, std::uint64_t pieces);
  [[nodiscard]] bool is_whole() const { return options_.rows == 0; }
  [[nodiscard]] raster::Rect rect_of(Rows rows) const {
    return {0, rows.begin, frame_.width, rows.end};
  }
  /// The keys, at the pixels' places in the whole picture.
  [[nodiscard]] ImageView<const std::uint64_t> keys() const;
  void draw_marked(Rows rows);
  /// Draws a scene of a selection into targets, with the ids of the file.
  void draw_selection(const Scene& scene, const io::FileSelection& selection, Targets targets,
                      Rows rows);
  /// Draws some rows of a band into `asked`.
  void draw_part(const SceneView& scene, Rows rows, const Targets& asked);
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
  Rows band_{0, 0};
  Image<std::uint64_t> keys_;    ///< of the nearest opaque surfaces of the band, one sample a pixel
  bool keys_are_whole_ = false;  ///< all chunks are in them, and nothing is translucent
  bool translucent_ = false;
  std::uint64_t seen_ = 0;  ///< marked when find gave up
};

}  // namespace rastrum::out_of_core
