// SPDX-License-Identifier: BSD-3-Clause
// One rank's frame. All ranks go through the same phases in the same order.
#pragma once

#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <rastrum/parallel/exec.hpp>
#include <rastrum/ranks/agree.hpp>
#include <rastrum/ranks/blocks.hpp>
#include <rastrum/ranks/fragments.hpp>
#include <rastrum/ranks/gather.hpp>
#include <rastrum/ranks/hops.hpp>
#include <rastrum/ranks/layer_merge.hpp>
#include <rastrum/ranks/part_list.hpp>
#include <rastrum/ranks/render_parts.hpp>
#include <rastrum/ranks/root_picture.hpp>
#include <rastrum/ranks/shared_layers.hpp>
#include <rastrum/ranks/sparse_blocks.hpp>
#include <rastrum/ranks/word_exchange.hpp>
#include <rastrum/render/access.hpp>
#include <rastrum/render/tone_pass.hpp>

namespace rastrum::ranks {

class PartsFrame {
 public:
  PartsFrame(Communicator& ranks, Renderer& renderer, const FrameOptions& frame,
             const RanksOptions& options, const AtPhase& at, const EdgesOfParts* edges)
      : ranks_(ranks),
        renderer_(renderer),
        frame_(frame),
        options_(options),
        at_([this, &at](std::string_view phase, int rank) {
          tell(phase);
          if (at) at(phase, rank);
        }),
        edges_(edges) {}
  PartsFrame(const PartsFrame&) = delete;
  PartsFrame& operator=(const PartsFrame&) = delete;

  RanksStats draw(const SceneView& scene, std::span<const std::uint64_t> parts,
                  const Camera& camera, const Targets& targets);

 private:
  void tell(std::string_view what) const {
    if (options_.progress)
      options_.progress(what, static_cast<std::uint64_t>(rows_done_),
                        static_cast<std::uint64_t>(frame_.height));
  }
  /// Also reports progress, so call it where a failure is agreed on.
  void finish_rows(std::string_view what, int done) {
    rows_done_ = done;
    tell(what);
  }
  [[nodiscard]] bool is_root() const { return ranks_.rank() == options_.root; }
  [[nodiscard]] std::size_t own_rank() const { return static_cast<std::size_t>(ranks_.rank()); }
  [[nodiscard]] std::size_t root() const { return static_cast<std::size_t>(options_.root); }
  /// A phase without an agreement: the next one reports its failure. Code in between must neither
  /// make a collective call nor need f()'s result.
  template <class F>
  void locally(std::string_view name, const F& f) {
    ranks::locally(ranks_, at_, name, f, failure_);
  }
  /// A phase, then an agreement on its success, that of local phases before it, and the greatest of
  /// each of `numbers`, which f() may set.
  template <class F>
  void phase(std::string_view name, const F& f, std::span<std::uint64_t> numbers = {}) {
    locally(name, f);
    agree(ranks_, std::exchange(failure_, nullptr), numbers);
  }
  /// Calls f(0) to f(n − 1) on the renderer's threads, `grain` at once.
  template <class F>
  void for_each(std::size_t n, const F& f, std::size_t grain = 1) const {
    parallel::for_each_index(RendererAccess::threads(renderer_), n, f, grain);
  }
  /// Sends packed `mail`; `room` names the phase that makes room.
  void exchange(Mail& mail, std::string_view room);
  [[nodiscard]] bool takes_hops(Mail& mail);
  /// A phase in which f(Mail&) packs mail.
  template <class F>
  [[nodiscard]] Mail packed(std::string_view name, const F& f,
                            std::span<std::uint64_t> numbers = {}) {
    std::optional<Mail> mail;
    phase(
        name, [&] { f(mail.emplace(ranks_.size())); }, numbers);
    return std::move(*mail);
  }
  /// Sends what f(Bytes&) packs to the root.
  template <class F>
  [[nodiscard]] Mail sent_to_root(std::string_view name, std::string_view room, const F& f) {
    Mail mail = packed(name, [&](Mail& all) { f(all.to(root())); });
    exchange_among(ranks_, at_, mail, only_root_, senders_to_me_, room);
    return mail;
  }

  // Agreements before anything is drawn.
  void begin(const SceneView& scene, std::span<const std::uint64_t> parts, const Camera& camera);
  void ask(const Targets& callers);
  void list_parts();
  /// Decides whether words meet in shared memory.
  void share_words(std::uint64_t least_limit);
  [[nodiscard]] bool finds_layers(const Camera& camera, Transparency method);
  void refuse_approximations(const Camera& camera);
  /// Draws what lights see of all ranks' parts, if the frame has shadows (light_depths.cpp).
  void draw_shadows(const Camera& camera);

  /// For a single rank, which has all parts.
  void draw_alone(const Camera& camera, const Targets& targets);
  void draw_band_alone(const Camera& camera);
  /// Draws the rows of band_ with all ranks' parts into the root's `targets` for these rows.
  void draw_rows(const Camera& camera, const Targets& targets);
  void draw_surfaces_of_rows(const Camera& camera);
  /// The part of the picture that passes draw; null: all of it.
  [[nodiscard]] std::optional<raster::Rect> part() const {
    return options_.rows == 0 ? std::nullopt : std::optional(band_);
  }
  /// Draws own parts with a sink; keys of opaque surfaces go to keys_.
  FrameStats draw_own(const Camera& camera, const FrameOptions& frame, KeySink& sink,
                      std::span<const raster::LightShadow> shadows = {});
  [[nodiscard]] SparseBlocks* keys_of_sink();
  /// Finds the keys of the rank's opaque surfaces and, if they fit, its fragments. Returns whether
  /// any rank has translucent surfaces.
  [[nodiscard]] bool draw_surfaces(const Camera& camera);
  /// Finds the keys of the rank's nearest surfaces, as if all were opaque.
  void draw_as_opaque(const Camera& camera);
  /// Finds the nearest surfaces of all ranks from their keys_. Ends with a local phase.
  [[nodiscard]] Words::Won meet();
  /// Clears this rank's blocks of the shared surface, if any, in the phase before words are raised.
  void clear_own_words();
  /// Fills pixels_ for the targets of `asked` where this rank has won; gather() brings them to the
  /// root.
  void shade(const Camera& camera, const FrameOptions& frame, std::uint32_t asked,
             std::span<const BlockMask> won);
  void tell_known(std::span<const BlockMask> won);
  void gather(std::span<const BlockMask> won, std::uint32_t asked);
  void show_nothing(const Targets& targets) const;
  void finish(const Targets& targets);
  /// Sends the edges at won pixels to the root, if edges are asked for (edges_of_parts.cpp).
  void send_edges(const Camera& camera, std::span<const BlockMask> won);
  /// The same for the whole picture of a single rank.
  void draw_edges_alone(const Camera& camera, ImageView<const std::int64_t> ids);
  void note(const Words::Won& won);

  // Colours of a picture with layers (layers.cpp).
  void layers(const Camera& camera);
  void begin_picture();
  void hold_fragments(const Camera& camera);
  void gather_behind(std::span<const BlockMask> won);
  void ask_what_hides(const Words::Won& won);
  void ask_owners_what_hides(const std::vector<std::uint64_t>& own_words);
  void note_asks();
  [[nodiscard]] Hides hides() const { return {asks_, answers_, hides_}; }
  /// The most bytes of fragments that this rank may hold, its own and others'.
  [[nodiscard]] std::uint64_t most_fragment_bytes() const;
  [[nodiscard]] std::vector<raster::Rect> plan_bands();
  void blend_held();
  [[nodiscard]] SharedLayers shared_layers() const;
  void share_layers();
  void blend_on_shared();
  [[nodiscard]] LayerMerge layer_merge() const;
  void draw_bands(const Camera& camera);
  void draw_band(const Camera& camera, raster::Rect band, Mail& mail);
  /// Blends all ranks' packed fragments at the owners, and stores the result at the root.
  void blend_fragments(Mail fragments);
  void finish_picture();
  [[nodiscard]] Image<std::uint64_t> keys_that_hide(raster::Rect band, std::size_t first) const;

  /// The first id in a pass over own parts that begins with part `first`.
  [[nodiscard]] std::uint64_t first_id_of(std::size_t first) const {
    return frame_.shader == Shader::id ? list_->parts()[places_[first]].first_id : 0;
  }
  /// The end of the parts from `first` on that one pass may draw. Shader::id needs all ranks' ids,
  /// which are consecutive only for neighbouring parts.
  [[nodiscard]] std::size_t end_of_run(std::size_t first) const;
  /// Own parts [first, last); the last come with the stand-in behind them.
  [[nodiscard]] SceneView own_scene(std::size_t first, std::size_t last) const {
    if (last == own_->parts.size()) last = own_->instances.size();
    SceneView scene = scene_;
    scene.instances = std::span(own_->instances).subspan(first, last - first);
    return scene;
  }
  [[nodiscard]] SceneView own_scene() const { return own_scene(0, own_->parts.size()); }

  /// The frame for passes that draw no colours. The root makes the greys of Shader::depth (finish).
  [[nodiscard]] FrameOptions unlit() const {
    FrameOptions frame = untoned();
    frame.lights.clear();
    return frame;
  }
  [[nodiscard]] FrameOptions unlit_opaque() const {
    FrameOptions frame = unlit();
    frame.transparency.method = Transparency::none;
    return frame;
  }
  /// The frame for colours that are blended later.
  [[nodiscard]] FrameOptions untoned() const {
    FrameOptions frame = frame_;
    frame.tone = {};
    if (frame.shader == Shader::depth) frame.shader = Shader::flat;
    return frame;
  }
  /// Draws own parts: keys into keys_, counts of fragments into survey_.
  FrameStats draw_survey(const Camera& camera);

  Communicator& ranks_;
  Renderer& renderer_;
  FrameOptions frame_;  ///< with the shader that all ranks take
  RanksOptions options_;
  const AtPhase at_;           ///< called as a phase begins: progress and the caller's hook
  int rows_done_ = 0;          ///< for progress
  const EdgesOfParts* edges_;  ///< null: none
  RanksStats stats_;
  std::exception_ptr failure_;  ///< of local work, not yet agreed on

  SceneView scene_;
  std::vector<ScalarMapping> mappings_;  ///< of scene_, if ranks had to agree on ranges
  std::optional<OwnParts> own_;
  std::optional<PartList> list_;
  std::vector<std::size_t> places_;                     ///< of own instances in the list
  std::uint32_t asked_ = 0;                             ///< targets that ranks send
  std::vector<std::size_t> only_root_, senders_to_me_;  ///< for mail to the root
  raster::Rect band_{};                                 ///< the rows drawn now
  std::optional<BlockGrid> grid_;                       ///< of these rows
  std::span<std::uint64_t> surface_{};  ///< shared by ranks, for words and then layers; empty: none
  std::size_t words_of_surface_ = 0;
  std::uint64_t most_shared_ = 0;  ///< in numbers
  bool shares_layers_ = false;     ///< all ranks' layers fit there
  SparseBlocks keys_;
  std::optional<OwnBlocks> pixels_;  ///< that this rank has won

  // With layers.
  std::optional<FragmentBytes> held_;  ///< this rank's, if all ranks' fit
  std::optional<LayerSurvey> survey_;  ///< otherwise
  bool translucent_ = false;           ///< this rank's parts
  bool in_bands_ = false;              ///< some rank's fragments do not fit
  bool any_keys_ = false;              ///< some rank has an opaque surface
  std::vector<BlockMask> asks_;        ///< pixels with fragments, by block
  std::vector<std::size_t> answers_;   ///< where each block's words begin in hides_
  std::vector<std::uint64_t> hides_;   ///< the nearest opaque words of all ranks there

  // Several samples per pixel (samples.cpp).
  void draw_samples(const Camera& camera);
  void agree_on_linear_light(const Camera& camera);
  void look_behind_samples();

  bool linear_light_ = false;                     ///< whether colours are blended in it
  std::span<const raster::LightShadow> shadows_;  ///< for passes that shade

  // On the root.
  TonePass tone_;
  bool tones_ = false;
  WideTargets wide_;
  Targets filled_;  ///< filled by ranks: the caller's, and those that greys or tones are made from
  Image<float> depth_;
  std::optional<RootPicture> picture_;  ///< with layers
};

}  // namespace rastrum::ranks
