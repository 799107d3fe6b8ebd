// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench ranks`: a mesh dealt to ranks that are threads of this process, beside one
// renderer with as many threads. Pictures are compared before the timing, bit for bit.
#include "ranks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include <rastrum/camera.hpp>
#include <rastrum/shapes.hpp>

#include "measure.hpp"
#include "registry.hpp"
#include "report.hpp"
#include "tables/options.hpp"

namespace rastrum::bench {

Slabs::Slabs(const Mesh& whole, std::size_t count) : triangles(whole.indices.size() / 3) {
  std::vector<std::uint32_t> order(triangles);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(
      order, {}, [&](std::uint32_t t) { return whole.positions[whole.indices[3 * t]].x; });
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> place(whole.positions.size(), kNone);
  for (std::size_t i = 0; i < count; ++i) {
    Mesh mesh;
    std::vector<std::uint32_t> used;
    for (std::size_t k = triangles * i / count; k < triangles * (i + 1) / count; ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = whole.indices[3 * std::size_t{order[k]} + c];
        if (place[v] == kNone) {
          place[v] = static_cast<std::uint32_t>(used.size());
          used.push_back(v);
          mesh.positions.push_back(whole.positions[v]);
        }
        mesh.indices.push_back(place[v]);
      }
    for (const std::uint32_t v : used) place[v] = kNone;
    if (!mesh.indices.empty()) meshes.push_back(std::move(mesh));
  }
  for (const Mesh& mesh : meshes) views.push_back(mesh.view());
  for (const MeshView& view : views) parts.push_back({view});
}

Share share_of(const Slabs& slabs, std::size_t r, std::size_t n) {
  const std::size_t begin = slabs.parts.size() * r / n, end = slabs.parts.size() * (r + 1) / n;
  Share share;
  share.scene.instances = std::span(slabs.parts).subspan(begin, end - begin);
  share.numbers.resize(end - begin);
  std::iota(share.numbers.begin(), share.numbers.end(), std::uint64_t{begin});
  return share;
}

namespace {

using Traffic = LocalRanks::Traffic;

/// The ranks of one scene. Their renderers are kept between frames.
struct Crew {
  Crew(const Slabs& slabs, std::size_t n, int threads) : ranks(static_cast<int>(n)) {
    for (std::size_t r = 0; r < n; ++r) {
      shares.push_back(share_of(slabs, r, n));
      renderers.push_back(std::make_unique<Renderer>(
          RendererOptions{.threads = std::max(1, threads / static_cast<int>(n))}));
    }
  }
  /// Returns the traffic of the rank that sends most.
  Traffic draw(const Camera& camera, const FrameOptions& frame, WordExchange exchange,
               const Targets& targets) {
    RanksOptions options;
    options.exchange = exchange;
    ranks.run([&](Communicator& c) {
      const auto r = static_cast<std::size_t>(c.rank());
      Counted counted(c, ranks);
      (void)render_parts(counted, *renderers[r], shares[r].scene, shares[r].numbers, camera, frame,
                         r == 0 ? targets : Targets{}, options);
      if (r == 0) phases = std::move(counted.phases);
    });
    Traffic most;
    for (const Traffic& t : ranks.traffic()) {
      most.bytes = std::max(most.bytes, t.bytes);
      most.messages = std::max(most.messages, t.messages);
    }
    return most;
  }

  LocalRanks ranks;
  std::vector<Share> shares;
  std::vector<std::unique_ptr<Renderer>> renderers;
  std::vector<std::pair<std::string, Traffic>> phases;  ///< of rank 0 in the last frame
};

/// A row of one scaling: the slabs on `n` ranks, opaque and translucent.
bool add_row(Document& document, Grid& grid, const char* kind, const Slabs& slabs, std::size_t n,
             const TableOptions& options, FrameOptions frame, Grid* phases, Panel* panel) {
  SceneView all;
  all.instances = slabs.parts;
  const Camera camera = fit_camera(all, 1.0472F, false, {-1, -0.7, -0.5});
  Crew crew(slabs, n, options.threads);
  Renderer one({.threads = options.threads});
  Image<Vec4> color(frame.width, frame.height), expected(frame.width, frame.height);
  std::vector<std::string> row{std::to_string(n), std::to_string(slabs.triangles)};
  bool right = true;
  for (const bool translucent : {false, true}) {
    frame.opacity = translucent ? 0.3F : 1;
    (void)one.render(all, camera, frame, {.color = expected});
    std::vector<Contender> contenders{
        {"one", [&] { (void)one.render(all, camera, frame, {.color = expected}); }}};
    std::vector<WordExchange> exchanges{WordExchange::shared};
    if (!translucent) exchanges.push_back(WordExchange::sparse);
    std::vector<Traffic> traffic;
    for (const WordExchange e : exchanges) {
      traffic.push_back(crew.draw(camera, frame, e, {.color = color}));
      right = right && same_bits(color, expected);
      contenders.push_back(
          {"ranks", [&, e] { (void)crew.draw(camera, frame, e, {.color = color}); }});
    }
    if (!right) return false;
    const std::vector<Timing> timings = measure_interleaved(contenders, options.plan());
    row.push_back(significant(timings[0].median_ms()));
    for (std::size_t i = 0; i < exchanges.size(); ++i) {
      const double ratio = median_ratio(timings[i + 1], timings[0]);
      row.push_back(significant(ratio));
      if (panel != nullptr) panel->series[translucent ? 2 : i].values.push_back(ratio);
      row.push_back(significant(static_cast<double>(traffic[i].bytes) / 1e3));
      row.push_back(std::to_string(traffic[i].messages));
      document.figures.push_back({{"kind", kind},
                                  {"ranks", n},
                                  {"translucent", translucent},
                                  {"exchange", std::string(name(exchanges[i]))},
                                  {"one_ms", timings[0].median_ms()},
                                  {"ratio", ratio},
                                  {"bytes", traffic[i].bytes},
                                  {"messages", traffic[i].messages}});
    }
    if (phases == nullptr) continue;
    (void)crew.draw(camera, frame, WordExchange::sparse, {.color = color});
    for (const auto& [phase, sent] : crew.phases)
      if (sent.bytes > 1000)
        phases->rows.push_back({translucent ? "translucent" : "opaque", phase,
                                significant(static_cast<double>(sent.bytes) / 1e3),
                                std::to_string(sent.messages)});
  }
  grid.rows.push_back(std::move(row));
  return true;
}

}  // namespace

int run_ranks(std::span<const std::string_view> arguments) {
  TableOptions options;
  OptionParser parser("ranks", "Parts on ranks that are threads, beside one renderer.");
  if (const auto status = options.read(parser, arguments)) return *status;
  FrameOptions frame = options.frame(1280, 720);
  frame.shader = Shader::lambert;
  Document document = options.document("ranks", "Parts on several ranks");
  document.notes.push_back(
      options.here(frame) +
      " shared by all ranks; a gyroid cut into slabs, float colours, which are first compared with "
      "one renderer's, bit for bit. Ranks are threads of one process, so what they send is "
      "copied once. ÷: ranks over one renderer; KB and messages are of the rank that sends most.");
  const std::vector<std::string> columns{
      "ranks", "triangles", "opaque, one ms", "shared ÷", "KB", "messages", "sparse ÷",
      "KB",    "messages",  "0.3, one ms",    "ranks ÷",  "KB", "messages"};
  Grid strong{"Strong scaling: one mesh", columns, {}};
  Grid weak{"Weak scaling: as many triangles a rank", columns, {}};
  Grid phases{"What rank 0 sends after each phase, 16 ranks, sparse words, above 1 KB",
              {"surfaces", "phase", "KB", "messages"},
              {}};
  const auto cells = [&](double triangles) {
    // A period has about 7 · cells² triangles, as measured.
    return std::max(8, static_cast<int>(std::sqrt(triangles / 14)));
  };
  const Mesh whole = shapes::gyroid(cells(static_cast<double>(options.triangles(600'000))));
  const Slabs slabs(whole, 48);
  Plot plot = options.plot(document, "ranks", "ranks ÷ one renderer");
  Panel panel{"one mesh",
              {{"opaque, shared", {}, 3}, {"opaque, sparse", {}, 0}, {"opacity 0.3", {}, 2}}};
  bool right = true;
  for (const std::size_t n : {1U, 2U, 4U, 8U, 16U}) {
    plot.places.push_back(std::to_string(n));
    progress(std::to_string(n) + " ranks");
    right = right && add_row(document, strong, "strong", slabs, n, options, frame,
                             n == 16 ? &phases : nullptr, &panel);
    const Slabs share(shapes::gyroid(cells(static_cast<double>(options.triangles(50'000) * n))),
                      48);
    right = right && add_row(document, weak, "weak", share, n, options, frame, nullptr, nullptr);
  }
  plot.panels = {std::move(panel)};
  document.plot = std::move(plot);
  document.grids = {std::move(strong), std::move(weak), std::move(phases)};
  progress("simulated ranks");
  right =
      right && add_simulated(document, whole, options.size(640), options.size(360), options.quick);
  if (!right) std::fprintf(stderr, "ranks: a picture or a count is wrong\n");
  publish(document, options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
