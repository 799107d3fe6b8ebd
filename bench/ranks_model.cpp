// What ranks would send: one renderer plays each of them in turn, and the bytes of its words and
// fragments are counted as rastrum/ranks/ packs them (docs/scale.md). For few ranks the count is
// held against that of ranks that are threads. Times are predictions from it, and marked as such.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>

#include <rastrum/camera.hpp>

#include "ranks.hpp"
#include "report.hpp"

namespace rastrum::bench {
namespace {

/// Bytes as they go between ranks.
constexpr std::uint64_t kMask = 12, kWord = 8, kFragment = 24;

struct Loads {
  std::vector<std::uint64_t> words, blocks, won, fragments;
};

std::uint64_t greatest(const std::vector<std::uint64_t>& v) {
  return std::ranges::max(v);
}
/// The greatest over the mean of those that have something to give, all ranks counted.
std::string skew(const std::vector<std::uint64_t>& v) {
  const double sum = std::accumulate(v.begin(), v.end(), 0.0);
  if (sum == 0) return "-";
  return significant(static_cast<double>(greatest(v)) * static_cast<double>(v.size()) / sum);
}

Loads play(const Slabs& slabs, std::size_t n, const Camera& camera, const FrameOptions& frame) {
  Loads loads;
  Renderer renderer;
  Image<float> depth(frame.width, frame.height), nearest(frame.width, frame.height);
  Image<std::uint32_t> overdraw(frame.width, frame.height);
  Image<std::int32_t> winner(frame.width, frame.height);
  std::ranges::fill(winner.pixels(), -1);
  for (std::size_t r = 0; r < n; ++r) {
    const Share share = share_of(slabs, r, n);
    std::uint64_t words = 0, blocks = 0, fragments = 0;
    if (!share.numbers.empty()) {
      (void)renderer.render(share.scene, camera, frame, {.depth = depth, .overdraw = overdraw});
      for (int by = 0; by < frame.height; by += 8)
        for (int bx = 0; bx < frame.width; bx += 8) {
          bool any = false;
          for (int y = by; y < std::min(by + 8, frame.height); ++y)
            for (int x = bx; x < std::min(bx + 8, frame.width); ++x) {
              if (overdraw(x, y) == 0) continue;
              any = true;
              ++words;
              fragments += overdraw(x, y);
              if (depth(x, y) <= nearest(x, y)) continue;  // of equal ones the first part
              nearest(x, y) = depth(x, y);
              winner(x, y) = static_cast<std::int32_t>(r);
            }
          blocks += any ? 1 : 0;
        }
    }
    loads.words.push_back(words);
    loads.blocks.push_back(blocks);
    loads.fragments.push_back(fragments);
  }
  loads.won.resize(n);
  for (const std::int32_t w : winner.pixels())
    if (w >= 0) ++loads.won[static_cast<std::size_t>(w)];
  return loads;
}

/// Whether threads of this process have the same words, won pixels and fragments.
bool is_right(const Slabs& slabs, std::size_t n, const Loads& loads, const Camera& camera,
              FrameOptions frame) {
  LocalRanks ranks(static_cast<int>(n));
  std::vector<RanksStats> opaque(n), layers(n);
  Image<Rgba8> image(frame.width, frame.height);
  for (const bool translucent : {false, true}) {
    frame.transparency.method = translucent ? Transparency::exact : Transparency::none;
    frame.opacity = 0.3F;
    ranks.run([&](Communicator& c) {
      const auto r = static_cast<std::size_t>(c.rank());
      const Share share = share_of(slabs, r, n);
      Renderer renderer({.threads = 1});
      (translucent ? layers : opaque)[r] =
          render_parts(c, renderer, share.scene, share.numbers, camera, frame,
                       r == 0 ? Targets{.color8 = image} : Targets{});
    });
  }
  for (std::size_t r = 0; r < n; ++r)
    if (opaque[r].words != loads.words[r] || opaque[r].won != loads.won[r] ||
        layers[r].fragments != loads.fragments[r])
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
    if (c.rank() == 0) model = {small, static_cast<double>(large) / std::max(big - small, 1e-3)};
  });
  return model;
}

bool add_simulated(Document& document, const Mesh& mesh, int width, int height, bool quick) {
  const LogGP model = measure_messages(quick);
  FrameOptions frame;
  frame.width = width;
  frame.height = height;
  frame.shader = Shader::flat;
  frame.transparency.method = Transparency::none;
  const Slabs slabs(mesh, quick ? 64 : 16384);
  SceneView all;
  all.instances = slabs.parts;
  const Camera camera = fit_camera(all, 1.0472F, false, {-1, -0.7, -0.5});
  Grid grid{
      "Simulated ranks: bytes are counted, **times are predicted** from them (µs a message " +
          significant(model.message_us) + ", " + significant(model.bytes_per_us / 1e3) +
          " GB/s, both of threads of this process): of the rank that sends most, its messages "
          "and bytes one after the other; drawing, blending and the root's picture left out",
      {"ranks", "words, max ÷ mean", "KB sparse", "KB dense", "won, max ÷ mean",
       "fragments, max ÷ mean", "KB fragments", "messages ≤", "sparse ms, predicted",
       "dense ms, predicted", "fragments ms, predicted"},
      {}};
  bool right = true;
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  for (std::size_t n = 1; n <= slabs.parts.size(); n *= 4) {
    const Loads loads = play(slabs, n, camera, frame);
    if (n <= 16) right = right && is_right(slabs, n, loads, camera, frame);
    std::uint64_t sparse = 0;
    for (std::size_t r = 0; r < n; ++r)
      sparse = std::max(sparse, loads.blocks[r] * kMask + loads.words[r] * kWord);
    const std::uint64_t dense = pixels * kWord / n * (n - 1);
    const std::uint64_t fragments = greatest(loads.fragments) * kFragment;
    const std::uint64_t most_blocks = greatest(loads.blocks);
    // A rank has no more owners to send to than blocks.
    const auto messages = static_cast<double>(std::min<std::uint64_t>(n - 1, most_blocks));
    const auto ms = [&](double sent, std::uint64_t bytes) {
      return n == 1 ? 0.0
                    : (sent * model.message_us + static_cast<double>(bytes) / model.bytes_per_us) /
                          1e3;
    };
    grid.rows.push_back(
        {std::to_string(n), skew(loads.words), significant(static_cast<double>(sparse) / 1e3),
         significant(static_cast<double>(dense) / 1e3), skew(loads.won), skew(loads.fragments),
         significant(static_cast<double>(fragments) / 1e3), significant(messages),
         significant(ms(messages, sparse)), significant(ms(static_cast<double>(n - 1), dense)),
         significant(ms(messages, fragments))});
    document.figures.push_back({{"kind", "simulated"},
                                {"ranks", n},
                                {"sparse_bytes", sparse},
                                {"dense_bytes", dense},
                                {"fragment_bytes", fragments},
                                {"message_us", model.message_us},
                                {"bytes_per_us", model.bytes_per_us}});
  }
  document.grids.push_back(std::move(grid));
  return right;
}

}  // namespace rastrum::bench
