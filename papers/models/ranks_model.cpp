// SPDX-License-Identifier: BSD-3-Clause
// Predicts what ranks would send. One renderer plays each rank in turn, and the bytes of its words
// and fragments are counted as rastrum/ranks/ packs them (docs/ranks_traffic.md). For few ranks the
// count is compared with real ranks on threads. Times are predictions from the count and marked so.
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <rastrum/camera.hpp>
#include <rastrum/ranks/fragments.hpp>
#include <rastrum/ranks/hops.hpp>

#include <bench/measure.hpp>
#include <bench/ranks.hpp>
#include <bench/report.hpp>

namespace rastrum::bench {
namespace {

/// Bytes on the wire.
constexpr std::uint64_t kMask = 12, kWord = 8, kFragment = 24, kPlane = 12, kSeen = 20;
/// Bytes of a two-hop letter beside its content.
constexpr std::uint64_t kLetter = 16;
/// Agreements per frame with layers, without bands, for ranks on many machines. Four of them choose
/// whether messages take two hops.
constexpr double kAgreements = 14;

struct Sent {
  explicit Sent(std::size_t n) : bytes(n), messages(n) {}
  std::vector<std::uint64_t> bytes, messages;
};

struct Loads {
  explicit Loads(std::size_t n)
      : words(n), won(n), fragments(n), direct(n), first(n), second(n), layers(n) {}
  std::vector<std::uint64_t> words, won, fragments;
  Sent direct;            ///< sparse words to their owners
  Sent first, second;     ///< the same by two hops
  Sent layers;            ///< fragments to the owners of their blocks
  double slowest_ms = 0;  ///< of the ranks' drawing, measured
};

std::uint64_t greatest(const std::vector<std::uint64_t>& v) {
  return std::ranges::max(v);
}
/// The greatest over the mean of all ranks.
std::string skew(const std::vector<std::uint64_t>& v) {
  const double sum = std::accumulate(v.begin(), v.end(), 0.0);
  if (sum == 0) return "-";
  return significant(static_cast<double>(greatest(v)) * static_cast<double>(v.size()) / sum);
}

/// One renderer that plays the ranks one after the other.
class Play {
 public:
  Play(const Slabs& slabs, std::size_t n, const Camera& camera, const FrameOptions& frame)
      : slabs_(slabs),
        camera_(camera),
        frame_(frame),
        grid_(frame.width, frame.height, static_cast<int>(n)),
        hops_(n),
        loads_(n),
        depth_(frame.width, frame.height),
        nearest_(frame.width, frame.height),
        overdraw_(frame.width, frame.height),
        winner_(frame.width, frame.height),
        of_row_(grid_.count()),
        sent_to_(n, n) {
    std::ranges::fill(winner_.pixels(), -1);
    // Plays the grid of ranks row by row. In a grid with a short last row, ranks of the row above
    // would forward its messages, so this model takes square numbers of ranks only.
    for (std::size_t r = 0; r < n; ++r) {
      const std::size_t row = hops_.via(r, 0);
      if (row == r && r > 0) end_row(r - 1);
      draw(r);
    }
    end_row(n - 1);
    for (const std::int32_t w : winner_.pixels())
      if (w >= 0) ++loads_.won[static_cast<std::size_t>(w)];
  }
  [[nodiscard]] const Loads& loads() const { return loads_; }

 private:
  void send(Sent& sent, std::size_t from, std::size_t to, std::uint64_t bytes) {
    if (from == to) return;
    sent.bytes[from] += bytes;
    // All blocks from one rank to another are one message; they are sent one after the other.
    if (sent_to_[to] == from) return;
    sent_to_[to] = from;
    ++sent.messages[from];
  }
  void forget() { std::ranges::fill(sent_to_, sent_to_.size()); }

  void draw(std::size_t r) {
    const Share share = share_of(slabs_, r, loads_.words.size());
    if (share.numbers.empty()) return;
    loads_.slowest_ms = std::max(loads_.slowest_ms, timed_ms([&] {
                                   (void)renderer_.render(share.scene, camera_, frame_,
                                                          {.depth = depth_, .overdraw = overdraw_});
                                 }));
    struct Block {
      std::uint32_t number;
      std::uint64_t words, fragments, planes;
    };
    std::vector<Block> blocks;
    for (std::size_t b = 0; b < grid_.count(); ++b) {
      Block block{static_cast<std::uint32_t>(b), 0, 0, 0};
      std::uint64_t mask = 0;
      grid_.each_pixel({~std::uint64_t{0}, block.number}, [&](int i, int x, int y) {
        const std::uint64_t layers = overdraw_(x, y);
        if (layers == 0) return;
        mask |= std::uint64_t{1} << i;
        ++block.words;
        block.fragments += layers;
        block.planes = std::max(block.planes, layers);
        if (depth_(x, y) <= nearest_(x, y)) return;  // of equal ones the first part wins
        nearest_(x, y) = depth_(x, y);
        winner_(x, y) = static_cast<std::int32_t>(r);
      });
      if (mask == 0) continue;
      of_row_[b] |= mask;
      loads_.words[r] += block.words;
      loads_.fragments[r] += block.fragments;
      blocks.push_back(block);
    }
    const auto each = [&](Sent& sent, const auto& to, const auto& bytes) {
      forget();
      for (const Block& b : blocks) send(sent, r, to(b.number), bytes(b));
    };
    const auto words = [](const Block& b) { return kMask + b.words * kWord; };
    const auto owner = [&](std::uint32_t b) { return grid_.owner(b); };
    each(loads_.direct, owner, words);
    each(
        loads_.first, [&](std::uint32_t b) { return hops_.via(r, grid_.owner(b)); }, words);
    each(
        loads_.layers, [&](std::uint32_t b) { return ranks::layer_owner(b, loads_.words.size()); },
        [](const Block& b) { return kMask + b.planes * kPlane + b.fragments * kFragment; });
  }

  /// Counts the second hop: for each column, the words that the row of ranks ending with `last` has
  /// merged.
  void end_row(std::size_t last) {
    forget();
    std::vector<std::vector<std::uint32_t>> of_rank(sent_to_.size());
    for (std::size_t b = 0; b < of_row_.size(); ++b)
      if (of_row_[b] != 0)
        of_rank[hops_.via(last, grid_.owner(static_cast<std::uint32_t>(b)))].push_back(
            static_cast<std::uint32_t>(b));
    for (std::size_t m = 0; m < of_rank.size(); ++m)
      for (const std::uint32_t b : of_rank[m])
        send(loads_.second, m, grid_.owner(b),
             kMask + kWord * static_cast<std::uint64_t>(std::popcount(of_row_[b])));
    std::ranges::fill(of_row_, 0);
  }

  const Slabs& slabs_;
  const Camera& camera_;
  const FrameOptions& frame_;
  ranks::BlockGrid grid_;
  ranks::HopGrid hops_;
  Loads loads_;
  Renderer renderer_;
  Image<float> depth_, nearest_;
  Image<std::uint32_t> overdraw_;
  Image<std::int32_t> winner_;
  std::vector<std::uint64_t> of_row_;  ///< masks of the blocks of the row of ranks
  std::vector<std::size_t> sent_to_;   ///< the rank that sent last to each rank
};

/// Whether rank r sent in a phase what was counted, besides the phase's agreement.
bool sends(const Counted& rank, const char* phase, const Sent& sent, std::size_t r) {
  LocalRanks::Traffic found;
  for (const auto& [name, traffic] : rank.phases)
    if (name == phase) found = traffic;
  const auto rounds = static_cast<std::uint64_t>(std::bit_width(sent.bytes.size() - 1));
  return found.bytes == sent.bytes[r] + rounds * sizeof(std::uint64_t) &&
         found.messages == sent.messages[r] + rounds;
}

/// Whether ranks on threads have the same words, won pixels and fragments, and send as many bytes
/// in as many messages.
bool is_right(const Slabs& slabs, std::size_t n, const Loads& loads, const Camera& camera,
              FrameOptions frame) {
  LocalRanks ranks(static_cast<int>(n));
  std::vector<RanksStats> opaque(n), layers(n);
  std::vector<std::uint8_t> equal(n, 1);
  Image<Rgba8> image(frame.width, frame.height);
  const auto draw = [&](bool translucent, WordExchange exchange, const auto& look) {
    frame.transparency.method = translucent ? Transparency::exact : Transparency::none;
    frame.opacity = 0.3F;
    RanksOptions options;
    options.exchange = exchange;
    ranks.run([&](Communicator& c) {
      const auto r = static_cast<std::size_t>(c.rank());
      const Share share = share_of(slabs, r, n);
      Renderer renderer({.threads = 1});
      Counted counted(c, ranks);
      const RanksStats stats =
          render_parts(counted, renderer, share.scene, share.numbers, camera, frame,
                       r == 0 ? Targets{.color8 = image} : Targets{}, options);
      look(r, stats, counted);
    });
  };
  draw(false, WordExchange::sparse, [&](std::size_t r, const RanksStats& stats, const Counted& c) {
    opaque[r] = stats;
    if (n > 1 && !sends(c, "make room for words", loads.direct, r)) equal[r] = 0;
  });
  draw(false, WordExchange::two_hops, [&](std::size_t r, const RanksStats&, const Counted& c) {
    if (n > 1 && !(sends(c, "make room for words", loads.first, r) &&
                   sends(c, "make room for merged words", loads.second, r)))
      equal[r] = 0;
  });
  draw(true, WordExchange::sparse, [&](std::size_t r, const RanksStats& stats, const Counted& c) {
    layers[r] = stats;
    if (n > 1 && !sends(c, "make room for fragments", loads.layers, r)) equal[r] = 0;
  });
  for (std::size_t r = 0; r < n; ++r)
    if (opaque[r].words != loads.words[r] || opaque[r].won != loads.won[r] ||
        (n > 1 && layers[r].fragments != loads.fragments[r]) || equal[r] == 0)
      return false;
  return true;
}

}  // namespace

LogGP measure_messages(bool quick) {
  LocalRanks ranks(2);
  LogGP model;
  ranks.run([&](Communicator& c) {
    using Clock = std::chrono::steady_clock;
    const auto us = [&](std::size_t bytes, int times) {
      std::vector<std::byte> out(bytes), in(bytes);
      std::vector<std::span<const std::byte>> to(2);
      std::vector<std::span<std::byte>> from(2);
      to[static_cast<std::size_t>(1 - c.rank())] = out;
      from[static_cast<std::size_t>(1 - c.rank())] = in;
      c.exchange(to, from);
      const auto begin = Clock::now();
      for (int i = 0; i < times; ++i) c.exchange(to, from);
      return std::chrono::duration<double, std::micro>(Clock::now() - begin).count() / times;
    };
    const double small = us(8, quick ? 100 : 5000);
    const std::size_t large = quick ? 1 << 20 : 16 << 20;
    const double big = us(large, quick ? 2 : 20);
    if (c.rank() == 0)
      model = {small, small, static_cast<double>(large) / std::max(big - small, 1e-3)};
  });
  return model;
}

namespace {

std::string both(std::string a, const std::string& b) {
  return a.append(" + ").append(b);
}

/// The time of one exchange: that of the rank with the most to send, messages and bytes one after
/// the other.
double ms_of(const LogGP& model, const Sent& sent, std::uint64_t more_messages) {
  double most = 0;
  for (std::size_t r = 0; r < sent.bytes.size(); ++r)
    most = std::max(most, static_cast<double>(sent.messages[r] + more_messages) * model.message_us +
                              static_cast<double>(sent.bytes[r]) / model.bytes_per_us);
  return most / 1e3;
}

/// The prediction for `n` ranks by one set of constants.
struct Predicted {
  Predicted(const LogGP& model, const Loads& loads, std::size_t n, std::uint64_t pixels) {
    if (n == 1) return;
    const ranks::HopGrid grid(n);
    const std::uint64_t peers = grid.messages() / 2, others = n - 1;
    sparse = ms_of(model, loads.direct, others);
    hops = ms_of(model, loads.first, peers) + ms_of(model, loads.second, peers);
    layers = ms_of(model, loads.layers, others);
    // Each byte is sent twice, and each letter has an address.
    Sent letters = loads.layers;
    for (std::size_t r = 0; r < n; ++r) {
      letters.bytes[r] = 2 * (letters.bytes[r] + letters.messages[r] * kLetter);
      letters.messages[r] = 2 * std::min(letters.messages[r], peers);
    }
    layers_by_hops = ms_of(model, letters, 2 * peers);
    agreements =
        kAgreements * std::ceil(std::log2(static_cast<double>(n))) * model.latency_us / 1e3;
    root = (static_cast<double>(others) * 2 * model.message_us +
            static_cast<double>(pixels * kSeen) / model.bytes_per_us) /
           1e3;
  }
  double sparse = 0, hops = 0, layers = 0, layers_by_hops = 0, agreements = 0, root = 0;
  [[nodiscard]] double translucent() const {
    return std::min(layers, layers_by_hops) + agreements + root;
  }
};

/// Typical vendor figures of a network: 2 µs latency, a new message every half microsecond, 20
/// GB/s.
constexpr LogGP kNetwork{2, 0.5, 20e3};

}  // namespace

bool add_simulated(Document& document, const Mesh& mesh, int width, int height, bool quick) {
  const LogGP here = measure_messages(quick);
  FrameOptions frame;
  frame.width = width;
  frame.height = height;
  frame.shader = Shader::flat;
  frame.transparency.method = Transparency::none;
  const Slabs slabs(mesh, quick ? 64 : 16384);
  SceneView all;
  all.instances = slabs.parts;
  const Camera camera = fit_camera(all, 1.0472F, false, {-1, -0.7, -0.5});
  Grid counted{
      "Simulated ranks, **counted**: of the rank that sends most; sizes, agreements and "
      "the root's picture left out. Two hops: the first and the second",
      {"ranks", "words, max ÷ mean", "won, max ÷ mean", "fragments, max ÷ mean", "KB sparse",
       "KB two hops", "KB fragments", "messages sparse", "messages two hops", "messages fragments"},
      {}};
  const auto titled = [](const std::string& what, const LogGP& model) {
    return Grid{std::string("Simulated ranks, **predicted, not measured**, ms: ")
                    .append(what)
                    .append(" (")
                    .append(significant(model.message_us))
                    .append(" µs a message, ")
                    .append(significant(model.bytes_per_us / 1e3))
                    .append(" GB/s): messages and bytes one after the other, sizes too"),
                {"ranks", "words sparse", "two hops", "fragments", "by two hops", "agreements",
                 "root's picture", "drawing, measured", "translucent frame"},
                {}};
  };
  Grid by_threads = titled("constants of threads of this process, measured here", here);
  Grid by_network = titled("constants of a network, as printed", kNetwork);
  bool right = true;
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  std::size_t best = 1;
  double least = 0;
  Predicted at_best(kNetwork, Loads(1), 1, pixels);
  for (std::size_t n = 1; n <= slabs.parts.size(); n *= 4) {
    const Play play(slabs, n, camera, frame);
    const Loads& loads = play.loads();
    if (n <= 16) right = right && is_right(slabs, n, loads, camera, frame);
    const auto kb = [](std::uint64_t bytes) {
      return significant(static_cast<double>(bytes) / 1e3);
    };
    counted.rows.push_back({std::to_string(n), skew(loads.words), skew(loads.won),
                            skew(loads.fragments), kb(greatest(loads.direct.bytes)),
                            both(kb(greatest(loads.first.bytes)), kb(greatest(loads.second.bytes))),
                            kb(greatest(loads.layers.bytes)),
                            std::to_string(greatest(loads.direct.messages)),
                            both(std::to_string(greatest(loads.first.messages)),
                                 std::to_string(greatest(loads.second.messages))),
                            std::to_string(greatest(loads.layers.messages))});
    for (const auto& [model, grid] : {std::pair<const LogGP&, Grid&>{here, by_threads},
                                      std::pair<const LogGP&, Grid&>{kNetwork, by_network}}) {
      const Predicted p(model, loads, n, pixels);
      const double total = loads.slowest_ms + p.translucent();
      grid.rows.push_back({std::to_string(n), significant(p.sparse), significant(p.hops),
                           significant(p.layers), significant(p.layers_by_hops),
                           significant(p.agreements), significant(p.root),
                           significant(loads.slowest_ms), significant(total)});
      if (&grid != &by_network || (n > 1 && total >= least)) continue;
      best = n;
      least = total;
      at_best = p;
    }
    document.figures.push_back({{"kind", "simulated"},
                                {"ranks", n},
                                {"sparse_bytes", greatest(loads.direct.bytes)},
                                {"first_hop_bytes", greatest(loads.first.bytes)},
                                {"second_hop_bytes", greatest(loads.second.bytes)},
                                {"fragment_bytes", greatest(loads.layers.bytes)},
                                {"message_us", here.message_us},
                                {"bytes_per_us", here.bytes_per_us}});
  }
  document.notes.push_back(
      std::string("By the network's constants a translucent frame is fastest with ")
          .append(std::to_string(best))
          .append(" ranks (")
          .append(significant(least))
          .append(" ms: fragments ")
          .append(significant(std::min(at_best.layers, at_best.layers_by_hops)))
          .append(", agreements ")
          .append(significant(at_best.agreements))
          .append(", root ")
          .append(significant(at_best.root))
          .append("); more ranks draw less each and have more messages."));
  document.grids.push_back(std::move(counted));
  document.grids.push_back(std::move(by_threads));
  document.grids.push_back(std::move(by_network));
  return right;
}

}  // namespace rastrum::bench
