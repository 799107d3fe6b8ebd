// SPDX-License-Identifier: BSD-3-Clause
// A picture of parts that lie on several ranks: of processes, or of threads in one. The picture is
// the one that a single renderer draws of all parts, bit for bit, however many ranks there are and
// whichever holds a part. docs/scale.md has when to use it and what it refuses, docs/ranks.md
// how it is done, docs/ranks_traffic.md what is sent.
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

/// The messages between ranks. All ranks call the same functions in the same order; each returns
/// when its own part is done. Buffers are the caller's. A failure ends the frame on all ranks, or
/// the job: a rank never goes on alone.
class Communicator {
 public:
  virtual ~Communicator() = default;
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  /// Names what all ranks begin now, for the message of a rank that waits in vain.
  virtual void begin_phase(std::string_view /*name*/) {}
  /// The greatest `value` of all ranks, on all of them.
  [[nodiscard]] virtual std::uint64_t max(std::uint64_t value) = 0;
  /// The root's bytes on all ranks; of one size everywhere.
  virtual void broadcast(std::span<std::byte> bytes, int root) = 0;
  /// One number to each rank, and one from each. Both have size() numbers.
  virtual void exchange_sizes(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) = 0;
  /// A block to each rank and one from each, of the sizes that were exchanged. Empty ones are
  /// legal.
  virtual void exchange(std::span<const std::span<const std::byte>> to,
                        std::span<const std::span<std::byte>> from) = 0;
  /// max() of several numbers at once, each in its place; as many on all ranks.
  virtual void max_of_each(std::span<std::uint64_t> values) {
    for (std::uint64_t& value : values) value = max(value);
  }
  /// Memory of at least `count` numbers, any number at first, that all ranks read and write, as one
  /// machine's processes can; or nothing, on all ranks alike: that is no failure. After an
  /// agreement (max, max_of_each), all ranks see what any rank wrote before it. The memory stays
  /// until a later call returns memory, which may be the same again and then begins with the same
  /// numbers. A collective, with the same `count` everywhere.
  [[nodiscard]] virtual std::span<std::uint64_t> share(std::size_t /*count*/) { return {}; }
  /// Whether all ranks are threads of one process, so that each reads and writes what another has:
  /// the same on all. Then a rank draws into the root's picture, where it would else send.
  [[nodiscard]] virtual bool is_one_process() const { return false; }
};

/// Calls f() on each rank, where it may call no function of `ranks`; what one throws, all throw, as
/// the same error: "rank 3: …" (render_parts).
void do_alike(Communicator& ranks, std::string_view phase, FunctionRef<void()> f);
/// The bytes of all ranks, one after the other, on each; any number of each.
[[nodiscard]] std::vector<std::vector<std::byte>> gather_to_all(Communicator& ranks,
                                                                std::span<const std::byte> bytes);

/// Fits a camera to what all ranks have (fit.hpp).
class FitOfRanks final : public FitRanks {
 public:
  explicit FitOfRanks(Communicator& ranks) : ranks_(ranks) {}
  void own(FunctionRef<void()> work) override { do_alike(ranks_, "fit", work); }
  [[nodiscard]] std::vector<double> gather(std::span<const double> numbers) override;

 private:
  Communicator& ranks_;
};

// Properties of the whole scene, on which ranks agree. All of them call these alike.

/// The mappings of this rank's scene, each with a range: one that has none, and no categories,
/// takes that of the numbers which the instances of all ranks show by the mapping of its index.
/// Throws Error{invalid_argument} for what ScalarColors refuses. O(scalars).
[[nodiscard]] std::vector<ScalarMapping> mappings_of_ranks(Communicator& ranks,
                                                           const SceneView& scene);
/// The box about the vertices in use of all ranks (bounds() of the whole scene). O(vertices).
[[nodiscard]] Bounds bounds_of_ranks(Communicator& ranks, const SceneView& scene);
/// The lights of all ranks, those of rank 0 first. Throws Error{unsupported} for an environment.
[[nodiscard]] std::vector<Light> lights_of_ranks(Communicator& ranks, std::span<const Light> own);
/// The cameras of all ranks, those of rank 0 first.
[[nodiscard]] std::vector<Camera> cameras_of_ranks(Communicator& ranks,
                                                   std::span<const Camera> own);

/// Ranks that are threads of this process: for tests and to count what is sent.
class LocalRanks {
 public:
  /// The messages that a rank has sent to others, not to itself. Agreements count as log N
  /// messages, and so do broadcasts at their root.
  struct Traffic {
    std::uint64_t bytes = 0, messages = 0;
  };
  /// `node`: so many of them are as if of one machine; only where all are they share memory, as
  /// processes would. 0: all. Throws Error{invalid_argument} unless 1 ≤ ranks ≤ 4096, 0 ≤ node.
  explicit LocalRanks(int ranks, int node = 0);
  ~LocalRanks();
  /// Calls f(communicator) on the thread of each rank, which is kept, and waits for all. If f
  /// throws on a rank, or returns while others wait for it, the others get an Error that names that
  /// rank, and run() throws the exception of the first rank that left. Throws
  /// Error{invalid_argument} while it runs already, also from within f. Traffic counts from 0.
  void run(FunctionRef<void(Communicator&)> f);
  [[nodiscard]] std::span<const Traffic> traffic() const;

 private:
  struct RASTRUM_INSIDE Shared;
  Owner<Shared> shared_;
};

/// How words of depth and part meet at the owner of a pixel. All give the same bits.
enum class WordExchange : std::uint8_t {
  automatic,  ///< by bytes and messages of the rank that sends most
  sparse,     ///< blocks of 8 × 8 pixels with what a rank has drawn in them
  /// The same over a rank between, which merges: √N messages, twice as many bytes. All else that
  /// ranks send to each other goes so, too.
  two_hops,
  /// Ranks of one machine raise the words of one surface (Communicator::share): nothing is sent.
  /// Where they share none, as `automatic` then.
  shared,
};
/// "automatic", "sparse", …
[[nodiscard]] std::string_view name(WordExchange exchange) noexcept;

struct RanksOptions {
  int root = 0;  ///< who gets the picture
  WordExchange exchange = WordExchange::automatic;
  /// Most that a rank holds of translucent fragments at once, its own and those of others: what is
  /// more goes in bands, for each of which ranks draw again. A renderer's memory limit leaves a
  /// quarter to them where that is less. 64 × 64 pixels are the least.
  std::uint64_t fragment_bytes = std::uint64_t{1} << 30;
  /// For pictures that the root does not hold: so many rows at once, a multiple of 64, from the
  /// top; 0: all. The root's targets have these rows, or the picture's where it has fewer, and
  /// `take_rows` is called there when they hold the rows [first, last), from the top. They also
  /// bound the part of the picture that each rank holds; each band is another pass over its
  /// geometry.
  int rows = 0;
  Function<void(int first, int last)> take_rows{};
  /// Called on each rank that has one, from the thread that draws, as each phase begins and at the
  /// end: what is being done, and how much of the picture is done, which never falls and ends at
  /// `all`. Ranks need not have the same.
  Function<void(std::string_view what, std::uint64_t done, std::uint64_t all)> progress{};
};

struct RanksStats {
  WordExchange exchange = WordExchange::sparse;  ///< what was taken
  std::uint64_t primitives = 0;                  ///< of all ranks
  std::uint64_t words = 0;                       ///< pixels that this rank has drawn something in
  std::uint64_t won = 0;                         ///< pixels whose surface is a part of this rank
  std::uint64_t fragments = 0;  ///< translucent ones that this rank has sent, to itself too
  std::uint64_t bands = 0;      ///< in which they went
};

/// Draws the instances of all ranks as one scene into the root's `targets`; those of other ranks
/// are not looked at. All ranks call it, with the same camera, frame and options; a rank may have
/// no instance. `parts`: the number of each instance, by which one renderer would draw all in
/// rising order; no number occurs twice, on any rank. It stands for InstanceView::id where there is
/// none, and ids count primitives of all ranks in that order. Instances refer to the materials and
/// mappings of their own rank's scene; either all ranks with instances have materials or none, and
/// mappings without a range have that of all ranks (mappings_of_ranks).
///
/// All targets may be asked for but overdraw, errors, keys and extra.
///
/// A failure on one rank (an argument, memory, what take_rows or progress throw) is thrown on all
/// ranks as the same Error, which begins with "rank 3: ". Once a stop is requested on one rank,
/// all ranks throw Stopped, after the phases in which they are; each has a `stop` of its own, or
/// none. Throws Error{unsupported} for what
/// needs more of other ranks: translucent surfaces by another method than `exact` or `none`, an
/// environment behind; and, in bands of rows, for the shader `depth`.
RanksStats render_parts(Communicator& ranks, Renderer& renderer, const SceneView& scene,
                        std::span<const std::uint64_t> parts, const Camera& camera,
                        const FrameOptions& frame, const Targets& targets,
                        const RanksOptions& options = {}, StopToken stop = {});

/// The same with `annotations` in the root's colours, by the root's `annotator`; all ranks give
/// the same ones. As Annotator::render: boxes, radii and ranges are of the whole scene. Throws
/// Error{unsupported} for bands of rows.
RanksStats render_parts(Communicator& ranks, Renderer& renderer, Annotator& annotator,
                        const SceneView& scene, std::span<const std::uint64_t> parts,
                        const Camera& camera, const FrameOptions& frame,
                        const Annotations& annotations, const Targets& targets,
                        const RanksOptions& options = {}, StopToken stop = {});

}  // namespace rastrum
