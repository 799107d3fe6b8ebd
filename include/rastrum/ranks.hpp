// SPDX-License-Identifier: BSD-3-Clause
// Draws one picture of parts that lie on several ranks, which are processes or threads of one. It
// is the picture that a single renderer draws of all parts, bit for bit, however many ranks there
// are and whichever holds a part. docs/scale.md says when to use it and what it refuses,
// docs/ranks.md how it works, docs/ranks_traffic.md what is sent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/annotate.hpp>
#include <rastrum/camera.hpp>
#include <rastrum/fit.hpp>
#include <rastrum/frame.hpp>
#include <rastrum/function.hpp>
#include <rastrum/held.hpp>
#include <rastrum/render.hpp>
#include <rastrum/scene.hpp>
#include <rastrum/stop.hpp>

namespace RASTRUM_API rastrum {

/// The messages between ranks. All ranks call the same functions in the same order; each call
/// returns when its own part is done. Buffers are the caller's. A failure ends the frame on all
/// ranks, or the job: a rank never goes on alone.
class Communicator {
 public:
  virtual ~Communicator() = default;
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  /// Names the phase that all ranks begin now, for the message of a rank that waits in vain.
  virtual void begin_phase(std::string_view /*name*/) {}
  /// The greatest `value` of all ranks, on all of them.
  [[nodiscard]] virtual std::uint64_t max(std::uint64_t value) = 0;
  /// Copies the root's bytes to all ranks. All give the same number of bytes.
  virtual void broadcast(std::span<std::byte> bytes, int root) = 0;
  /// Sends a number to each rank and gets one from each; `to` and `from` have size() numbers.
  virtual void exchange_sizes(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) = 0;
  /// Sends a block to each rank and gets one from each, of the sizes that were exchanged, also 0.
  virtual void exchange(std::span<const std::span<const std::byte>> to,
                        std::span<const std::span<std::byte>> from) = 0;
  /// max() of each number at once; all ranks give as many.
  virtual void max_of_each(std::span<std::uint64_t> values) {
    for (std::uint64_t& value : values) value = max(value);
  }
  /// Memory of at least `count` numbers that all ranks read and write, as processes of one machine
  /// can; its first contents are not defined. Or nothing, on all ranks alike: that is no failure.
  /// After an agreement (max, max_of_each), all ranks see what any rank wrote before it. The memory
  /// stays until a later call returns memory; that may be the same, and then it keeps its numbers.
  /// All ranks call it together, with the same `count`.
  [[nodiscard]] virtual std::span<std::uint64_t> share(std::size_t /*count*/) { return {}; }
  /// Whether all ranks are threads of one process, so that each can read and write another's
  /// memory; the same on all. Then a rank draws into the root's picture and sends none.
  [[nodiscard]] virtual bool is_one_process() const { return false; }
};

/// Calls f() on each rank; f may call no function of `ranks`. If f throws on one rank, all ranks
/// throw the same error: "rank 3: …" (render_parts).
void do_alike(Communicator& ranks, std::string_view phase, FunctionRef<void()> f);
/// The bytes of each rank, in order, on all of them; ranks may give different numbers of bytes.
[[nodiscard]] std::vector<std::vector<std::byte>> gather_to_all(Communicator& ranks,
                                                                std::span<const std::byte> bytes);

/// Fits a camera to what all ranks hold (fit.hpp).
class FitOfRanks final : public FitRanks {
 public:
  explicit FitOfRanks(Communicator& ranks) : ranks_(ranks) {}
  void own(FunctionRef<void()> work) override { do_alike(ranks_, "fit", work); }
  [[nodiscard]] std::vector<double> gather(std::span<const double> numbers) override;

 private:
  Communicator& ranks_;
};

// Properties of the whole scene, on which ranks agree. All ranks call each of these together.

/// The mappings of this rank's scene, each with a range. A mapping with neither a range nor
/// categories takes the range of the numbers that the instances of all ranks show by the mapping of
/// the same index. Throws Error{invalid_argument} for what ScalarColors refuses. O(scalars).
[[nodiscard]] std::vector<ScalarMapping> mappings_of_ranks(Communicator& ranks,
                                                           const SceneView& scene);
/// The box about the vertices in use of all ranks: bounds() of the whole scene. O(vertices).
[[nodiscard]] Bounds bounds_of_ranks(Communicator& ranks, const SceneView& scene);
/// The lights of all ranks, those of rank 0 first. Throws Error{unsupported} for an environment.
[[nodiscard]] std::vector<Light> lights_of_ranks(Communicator& ranks, std::span<const Light> own);
/// The cameras of all ranks, those of rank 0 first.
[[nodiscard]] std::vector<Camera> cameras_of_ranks(Communicator& ranks,
                                                   std::span<const Camera> own);

/// Ranks that are threads of this process: for tests and to count what is sent.
class LocalRanks {
 public:
  /// Counts what a rank has sent to others, not to itself. An agreement counts as log N messages,
  /// and so does a broadcast at its root.
  struct Traffic {
    std::uint64_t bytes = 0, messages = 0;
  };
  /// `node`: so many ranks count as one machine. They share memory only if these are all, as
  /// processes would. 0: all. Throws Error{invalid_argument} unless 1 ≤ ranks ≤ 4096 and 0 ≤ node.
  explicit LocalRanks(int ranks, int node = 0);
  ~LocalRanks();
  /// Calls f(communicator) on the thread of each rank, which is kept, and waits for all. If f
  /// throws on a rank, or returns while others wait for that rank, the others get an Error that
  /// names it, and run() throws the exception of the first rank that left. Throws
  /// Error{invalid_argument} while it runs, also from within f. Traffic counts from 0.
  void run(FunctionRef<void(Communicator&)> f);
  [[nodiscard]] std::span<const Traffic> traffic() const;

 private:
  struct RASTRUM_INSIDE Shared;
  Owner<Shared> shared_;
};

/// How the words of a pixel (depth and part) of all ranks meet at the rank that owns the pixel. All
/// ways give the same bits.
enum class WordExchange : std::uint8_t {
  automatic,  ///< chosen by bytes and messages of the rank that sends most
  sparse,     ///< blocks of 8 × 8 pixels with what a rank has drawn in them
  /// As `sparse`, but over a rank between, which merges: √N messages, twice as many bytes. All else
  /// that ranks send to each other takes this way, too.
  two_hops,
  /// Ranks of one machine raise words in memory that they share (Communicator::share), and send
  /// nothing. Where ranks share none, it is as `automatic`.
  shared,
};
/// "automatic", "sparse", …
[[nodiscard]] std::string_view name(WordExchange exchange) noexcept;

struct RanksOptions {
  int root = 0;  ///< the rank that gets the picture
  WordExchange exchange = WordExchange::automatic;
  /// The most bytes of translucent fragments that a rank holds at once, its own and those of
  /// others. More are drawn in bands, for each of which ranks draw again. A renderer with a memory
  /// limit uses a quarter of that, if it is less. A band has at least 64 × 64 pixels.
  std::uint64_t fragment_bytes = std::uint64_t{1} << 30;
  /// For a picture that the root does not hold whole: how many rows are drawn at once, from the
  /// top, a multiple of 64; 0: all. The root's targets have this many rows, or the picture's if it
  /// has fewer. `take_rows`, which must be set if the picture has more, is called on the root when
  /// they hold its rows [first, last), from the top. `rows` also bounds the part of the picture
  /// that each rank holds. Each band is another pass over a rank's geometry.
  int rows = 0;
  Function<void(int first, int last)> take_rows{};
  /// Called on each rank that has one, from the thread that draws, as each phase begins and at the
  /// end, with what is being done, and how much of the picture is done. This never falls and ends
  /// at `all`. Ranks need not have the same.
  Function<void(std::string_view what, std::uint64_t done, std::uint64_t all)> progress{};
};

struct RanksStats {
  WordExchange exchange = WordExchange::sparse;  ///< the one that was taken
  std::uint64_t primitives = 0;                  ///< of all ranks
  std::uint64_t words = 0;                       ///< pixels in which this rank has drawn
  std::uint64_t won = 0;                         ///< pixels that show a part of this rank
  std::uint64_t fragments = 0;  ///< translucent ones that this rank has sent, also to itself
  std::uint64_t bands = 0;      ///< in which these were sent
};

/// Draws the instances of all ranks as one scene into the root's `targets`; those of other ranks
/// are not looked at. All ranks call it, with the same camera, frame and options; a rank may have
/// no instance. `parts` has a number for each instance; one renderer would draw all instances in
/// rising order of it. No number occurs twice, on any rank. It stands for InstanceView::id where
/// there is none, and ids count the primitives of all ranks in that order. Instances refer to the
/// materials and mappings of their own rank's scene. Either all ranks with instances have materials
/// or none has. Mappings without a range take that of all ranks (mappings_of_ranks).
///
/// `targets` may be all of Targets but overdraw, errors, keys and extra.
///
/// A failure on one rank (an argument, memory, what take_rows or progress throw) is thrown on all
/// ranks as the same Error, which begins with "rank 3: ". Once a stop is requested on one rank, all
/// ranks throw Stopped, after the phases in which they are; each has a `stop` of its own, or none.
/// Throws Error{unsupported} for what needs more of other ranks: translucent surfaces by another
/// method than `exact` or `none`, an environment behind and, in bands of rows, Shader::depth.
RanksStats render_parts(Communicator& ranks, Renderer& renderer, const SceneView& scene,
                        std::span<const std::uint64_t> parts, const Camera& camera,
                        const FrameOptions& frame, const Targets& targets,
                        const RanksOptions& options = {}, StopToken stop = {});

/// As above, with `annotations` in the root's colours, drawn by the root's `annotator` as by
/// Annotator::render. All ranks give the same annotations; boxes, radii and ranges are those of the
/// whole scene. Throws Error{unsupported} for bands of rows.
RanksStats render_parts(Communicator& ranks, Renderer& renderer, Annotator& annotator,
                        const SceneView& scene, std::span<const std::uint64_t> parts,
                        const Camera& camera, const FrameOptions& frame,
                        const Annotations& annotations, const Targets& targets,
                        const RanksOptions& options = {}, StopToken stop = {});

}  // namespace rastrum
