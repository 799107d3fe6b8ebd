// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench paper5-table4`: paper 5, table 4, Bunny subdivided 0 to 6 times at 1 to 128 ×
// image scale. Subdivided 6 times it has 460 million triangles; the paper's program failed there at
// scale 128. Meshes that do not fit are made in parts and drawn in passes. Each pass loads the keys
// of the one before (Pass::load), so the picture is the same.
#include <algorithm>
#include <optional>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/image.hpp>
#include <rastrum/shapes.hpp>

#include <bench/attempt.hpp>
#include <bench/contest.hpp>
#include <bench/cuda/in_place.hpp>
#include <bench/cuda/rates.hpp>
#include <bench/registry.hpp>
#include <bench/report.hpp>
#include <bench/stand_ins.hpp>
#include <bench/tables/comparison.hpp>
#include <bench/tables/options.hpp>
#include <papers/paper5/bench_data.hpp>
#include <papers/paper5/published.hpp>

namespace rastrum::bench {
namespace {

constexpr std::size_t kColumns = 7;
/// The scale at which the camera is matched. The others only have more or fewer samples.
constexpr int kMatchScale = 10;

struct Limits {
  std::uint64_t memory = std::uint64_t{2} << 30;           ///< scratch of a frame, bytes
  std::uint64_t images = std::uint64_t{6} << 30;           ///< keys and pictures held at once
  std::uint64_t part_triangles = std::uint64_t{32} << 20;  ///< of a mesh in memory
  double seconds = 120;                                    ///< of a frame
  int subdivisions = 6, scale = 128;
};

/// One figure of the table: a size, drawn in passes.
struct Cell {
  std::size_t row = 0;
  Subject subject;  ///< all but the mesh
  Image<std::uint64_t> keys;
  Image<Rgba8> picture;
  double ms = 0;
  std::vector<double> samples_ms = {};
  std::uint64_t scratch = 0;
  std::uint64_t hash = 0;    ///< of the final keys
  std::string stopped = {};  ///< the reason; empty if complete
};

std::uint64_t image_bytes(int width, int height) {
  return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
         (sizeof(std::uint64_t) + sizeof(Rgba8));
}

/// Draws one part into a cell and adds its time. Each pass has its own renderer, so that cells do
/// not keep scratch at the same time. Making it is not timed.
void draw_pass(Cell& cell, const Mesh& part, std::uint64_t first_id,
               const family::Options& options) {
  Renderer renderer = family::make_renderer(options, options);
  Subject subject = cell.subject;
  subject.mesh = part.view();
  Targets targets;
  targets.color8 = cell.picture.view();
  targets.keys = cell.keys.view();
  FrameStats stats;
  cell.ms += timed_ms([&] {
    stats = draw(renderer, subject, options, targets, {.load = first_id > 0, .first_id = first_id});
  });
  if (options.device == Device::cuda && stats.device != Device::cuda)
    throw Error(Errc::unsupported, "left to the CPU: " + stats.device_why);
  cell.scratch = std::max(cell.scratch, stats.peak_bytes);
}

/// Draws the rows of one column by one entrant, in passes. If the cells have too many pixels to
/// hold at once, they go in groups, and the parts are made again for each group.
void stream(std::vector<Cell>& cells, const Mesh& base, int times, std::size_t parts,
            const Entrant& entrant, const Limits& limits) {
  std::size_t begin = 0;
  while (begin < cells.size()) {
    std::size_t end = begin;
    for (std::uint64_t held = 0; end < cells.size(); ++end) {
      const Subject& s = cells[end].subject;
      held += image_bytes(s.width, s.height);
      if (held > limits.images && end > begin) break;
      cells[end].keys = Image<std::uint64_t>(s.width, s.height);
      cells[end].picture = Image<Rgba8>(s.width, s.height);
    }
    std::uint64_t first_id = 0;
    for (std::size_t k = 0; k < parts; ++k) {
      progress("  part " + std::to_string(k + 1) + " of " + std::to_string(parts));
      const Mesh part = subdivided_part(base, times, k, parts);
      for (std::size_t i = begin; i < end; ++i) {
        Cell& cell = cells[i];
        if (!cell.stopped.empty()) continue;
        cell.stopped = attempt([&]() -> std::string {
          draw_pass(cell, part, first_id, entrant.options);
          return "";
        });
        if (cell.stopped.empty() && cell.ms > limits.seconds * 1000 && k + 1 < parts)
          cell.stopped = "stopped after " + significant(cell.ms / 1000) + " s, at triangle " +
                         std::to_string(first_id + part.triangle_count());
      }
      first_id += part.triangle_count();
    }
    for (std::size_t i = begin; i < end; ++i) {
      cells[i].samples_ms = {cells[i].ms};
      cells[i].hash = hash_of(cells[i].keys.pixels());
      cells[i].keys = {};
      cells[i].picture = {};
    }
    begin = end;
  }
}

/// The same on a device that holds all parts at once: a frame is one pass, and entrants take turns.
void draw_in_place(std::vector<Cell>& cells, const Mesh& base, int times, std::size_t parts,
                   const Entrant& entrant, const Plan& plan) {
  MeshesInPlace meshes;
  const std::string stopped = attempt([&]() -> std::string {
    for (std::size_t k = 0; k < parts; ++k)
      meshes.add(subdivided_part(base, times, k, parts).view());
    return "";
  });
  for (Cell& cell : cells) {
    cell.stopped = stopped;
    if (!stopped.empty()) continue;
    cell.stopped = attempt([&]() -> std::string {
      InPlace frame(entrant.options, cell.subject.camera, cell.subject.width, cell.subject.height);
      FrameStats stats;
      cell.hash = hash_of(frame.keys(meshes, stats).pixels());
      cell.scratch = stats.peak_bytes;
      const Contender contender{"", [&] { static_cast<void>(frame.draw(meshes)); }};
      cell.samples_ms = measure_interleaved({&contender, 1}, plan)[0].samples_ms;
      cell.ms = median(cell.samples_ms);
      return "";
    });
  }
}

/// Converts a table of frames a second to triangles a second and multiples of the floor.
void add_rates(Document& document, const Comparison& table, const std::string& name,
               std::size_t base_triangles, const MachineLimits& device) {
  Rates rates(name, table.first_column);
  for (std::size_t r = 0; r < paper5::kScales.size(); ++r)
    for (std::size_t times = 0; times < kColumns; ++times) {
      const auto scale = static_cast<std::uint64_t>(paper5::kScales[r]);
      const auto picture = static_cast<std::uint64_t>(paper5::kBunny.width * paper5::kBunny.height);
      const std::uint64_t triangles = static_cast<std::uint64_t>(base_triangles) << (2 * times);
      const double fps = table.rows[r].ours[times].value;
      rates.add(table.rows[r].at, table.columns[times], triangles, fps > 0 ? 1000 / fps : 0,
                floor_ms(triangles, picture * scale * scale, device));
    }
  rates.add_to(document);
}

}  // namespace

int run_paper5_table4(std::span<const std::string_view> arguments) {
  TableOptions options;
  options.rounds = 3;
  Limits limits;
  OptionParser parser("paper5-table4",
                      "Paper 5, table 4: Bunny by subdivisions and image scale, streamed where it "
                      "does not fit.");
  options.add_device(parser);
  parser
      .add_option("--memory-limit", limits.memory,
                  "most scratch memory of a frame, in bytes (default: 2 GiB)")
      ->as_size();
  parser
      .add_option("--image-memory", limits.images,
                  "most memory of keys and pictures at once, in bytes (default: 6 GiB)")
      ->as_size();
  parser
      .add_option("--part", limits.part_triangles,
                  "most triangles of a mesh in memory (default: 32 Mi)")
      ->range(std::uint64_t{1000}, std::uint64_t{1} << 32);
  parser.add_option("--seconds", limits.seconds,
                    "seconds after which a frame is stopped (default: 120)");
  parser.add_option("--subdivisions", limits.subdivisions, "most subdivisions (default: 6)")
      ->range(0, 6);
  parser.add_option("--scale", limits.scale, "largest image scale (default: 128)")->range(1, 128);
  if (const auto status = options.read(parser, arguments, true)) return *status;
  if (options.quick) {
    // Small, but with parts, so that every path runs.
    limits.subdivisions = std::min(limits.subdivisions, 2);
    limits.scale = std::min(limits.scale, 4);
    limits.part_triangles = std::min<std::uint64_t>(limits.part_triangles, 20000);
  }

  const paper5::DataSet& bunny = paper5::kBunny;
  const Paper5Scene matched = paper5_scene(bunny, kMatchScale, options);
  const std::size_t base_triangles = matched.mesh.triangle_count();

  Document document =
      options.document("paper5-table4", "Paper 5, table 4: subdivisions and image scale");
  document.notes.push_back(paper5_note(options));
  document.notes.push_back(describe(bunny, matched) + "; subdivided, each triangle becomes four.");
  document.notes.push_back(
      "Up to " + std::to_string(limits.part_triangles) +
      " triangles the mesh is in memory and the choices take turns; beyond, it is made part by "
      "part, each part is one pass into the picture, and only the passes are timed, once. The "
      "threads' scratch is limited to " +
      significant(static_cast<double>(limits.memory) / 1e9) +
      " GB; the picture and its keys (12 bytes a pixel) are the caller's. A whole frame of both "
      "choices has the same ids in every cell.");

  std::vector<Entrant> entrants{entrant(options, "scanline", "sorted"), entrant(options, "auto")};
  for (Entrant& e : entrants) e.options.memory_limit = limits.memory;
  MachineLimits device;
  if (options.on_cuda()) {
    entrants.erase(entrants.begin());
    for (Entrant& e : device_entrants(options, entrant(options, "scanline", "sorted")))
      entrants.push_back(std::move(e));
    device = measure_device(options);
    document.notes.push_back(device_note(options, device));
  }
  std::vector<Comparison> tables;
  for (const Entrant& e : entrants) {
    Comparison c{
        "Frames a second, " + e.name, "FPS", "paper, A100", options.here(), "image scale", {}, {}};
    for (std::size_t s = 0; s < kColumns; ++s)
      c.columns.push_back(std::to_string(s) + " (" + std::to_string(base_triangles << (2 * s)) +
                          ")");
    for (const auto& row : paper5::kTable4) c.rows.push_back(row_of(row));
    tables.push_back(std::move(c));
  }

  bool right = true;
  for (std::size_t times = 0; times < kColumns; ++times) {
    const std::uint64_t triangles = static_cast<std::uint64_t>(base_triangles) << (2 * times);
    const auto parts =
        static_cast<std::size_t>((triangles + limits.part_triangles - 1) / limits.part_triangles);
    const bool asked = static_cast<int>(times) <= limits.subdivisions;
    progress(std::to_string(times) + " subdivisions, " + std::to_string(triangles) + " triangles");
    std::optional<Mesh> whole;
    if (asked && parts == 1) whole = shapes::subdivide(matched.mesh, static_cast<int>(times));
    std::vector<Cell> cells;
    for (std::size_t r = 0; r < paper5::kScales.size(); ++r) {
      const int scale = paper5::kScales[r];
      if (!asked || scale > limits.scale) continue;
      Subject subject = matched.subject();
      subject.width = bunny.width * scale;
      subject.height = bunny.height * scale;
      subject.facade_shader = options.on_cuda();
      if (whole) {
        progress("  scale " + std::to_string(scale));
        subject.mesh = whole->view();
        const std::vector<Result> results = contest(subject, entrants, options.plan());
        for (std::size_t e = 0; e < entrants.size(); ++e) {
          tables[e].rows[r].ours[times] = measured_fps(results[e], subject);
          right = right && !results[e].wrong;
        }
      } else if (image_bytes(subject.width, subject.height) > limits.images) {
        for (Comparison& c : tables)
          c.rows[r].ours[times].not_run =
              "keys and picture take " +
              significant(static_cast<double>(image_bytes(subject.width, subject.height)) / 1e9) +
              " GB";
      } else {
        cells.push_back({r, subject, {}, {}});
      }
    }
    std::vector<std::optional<std::uint64_t>> seen(cells.size());
    for (std::size_t e = 0; e < entrants.size(); ++e) {
      std::vector<Cell> run = cells;
      progress("  " + entrants[e].name);
      if (entrants[e].in_place)
        draw_in_place(run, matched.mesh, static_cast<int>(times), parts, entrants[e],
                      options.plan());
      else
        stream(run, matched.mesh, static_cast<int>(times), parts, entrants[e], limits);
      for (std::size_t i = 0; i < run.size(); ++i) {
        Measured& m = tables[e].rows[run[i].row].ours[times];
        m.not_run = run[i].stopped;
        if (!m.not_run.empty()) continue;
        if (!seen[i]) seen[i] = run[i].hash;
        if (*seen[i] != run[i].hash) {
          m.not_run = "WRONG PICTURE";
          right = false;
          continue;
        }
        m.value = 1000 / run[i].ms;
        m.scratch_bytes = run[i].scratch;
        m.samples_ms = run[i].samples_ms;
      }
    }
  }
  for (const Comparison& c : tables) add(document, c);
  for (std::size_t e = 1; options.on_cuda() && e < entrants.size(); ++e)
    add_rates(document, tables[e], entrants[e].name, base_triangles, device);
  document.plot = lines_of(tables.back(), "image scale");
  publish(document, options.out);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
