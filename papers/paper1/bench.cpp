// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench paper1-table1 … paper1-table6`: the tables of paper 1, section 4.2, beside ours.
// As there, every frame is depth-shaded, grey = depth³, by a programmable shader.
#include <vector>

#include <bench/contest.hpp>
#include <bench/registry.hpp>
#include <bench/scenes.hpp>
#include <bench/stand_ins.hpp>
#include <bench/tables/comparison.hpp>
#include <bench/tables/options.hpp>
#include <papers/paper1/published.hpp>
#include <rastrum/io.hpp>

namespace rastrum::bench {
namespace {

using paper1::kModels;

/// The paper's rasterizers in the order of its tables: immediate scanline, immediate, tiled and
/// hybrid Pineda. The immediate ones use the 64-bit visibility buffer (section 3.2.3).
constexpr std::array kRasterizers{"scanline", "pineda", "tiled", "hybrid"};

/// The smallest limit, since 0 is the default: only triangles of one pixel take the small stage.
constexpr int kAlmostNoSmallStage_px = 1;

/// The stand-ins of the columns, made on first use.
class Meshes {
 public:
  explicit Meshes(const TableOptions& options) : options_(options), meshes_(kModels.size()) {
    if (!options.mesh.empty()) source_ = flatten(io::read_scene(options.mesh));
  }
  const Mesh& operator[](std::size_t model) {
    Mesh& mesh = meshes_[model];
    if (mesh.positions.empty()) {
      const std::size_t n = options_.triangles(kModels[model].triangles);
      mesh = options_.mesh.empty() ? ball(n) : with_triangles(source_, n);
    }
    return mesh;
  }
  [[nodiscard]] std::string note() const {
    const std::string what = options_.mesh.empty()
                                 ? "a closed, wavy ball"
                                 : "`" + options_.mesh + "`, subdivided or decimated,";
    return "Meshes: " + what +
           " of exactly the column's number of triangles, filling the frame by the default camera "
           "(the paper's models are not ours to ship). MB: mesh, picture and scratch, as `futhark "
           "profile` counts them; in brackets scratch alone. Ids were compared before timing.";
  }

 private:
  const TableOptions& options_;
  Mesh source_;
  std::vector<Mesh> meshes_;
};

std::vector<std::string> model_columns() {
  std::vector<std::string> columns;
  for (const Model& m : kModels)
    columns.push_back(std::string(m.name) + " (" + std::to_string(m.triangles) + ")");
  return columns;
}

/// A table, and whether all its pictures are right.
struct Filled {
  Comparison table;
  bool right;
};

/// Parses the options, calls `fill` with them and the meshes, and publishes the table that it
/// returns. Plots bars if `x_title` is null.
template <class Fill>
int table(const char* name, const char* title, const char* x_title,
          std::span<const std::string_view> arguments, Fill&& fill) {
  TableOptions options;
  OptionParser parser(name, title);
  if (const auto status = options.read(parser, arguments, true)) return *status;
  Meshes meshes(options);
  Document document = options.document(name, std::string("Paper 1, ") + title);
  document.notes.push_back(meshes.note());
  const auto [table, right] = fill(options, meshes, document);
  add(document, table);
  document.plot = x_title == nullptr ? bars_of(table) : lines_of(table, x_title);
  publish(document, options.out);
  return right ? 0 : 1;
}

Subject subject_of(const Mesh& mesh, int image) {
  return {mesh.view(), whole_view(mesh), image, image};
}

template <class Rows>
Comparison by_model(const TableOptions& options, const char* caption, const char* row_title,
                    const Rows& published) {
  Comparison c{caption, "ms", "paper, M2000M", options.here(), row_title, model_columns(), {}};
  for (const auto& row : published) c.rows.push_back(row_of(row));
  return c;
}

/// Each entrant draws each model `steps` times, in step s the frame frame_of(mesh, s). Entrant i's
/// figures go into row `first` + `steps` · i + s. Returns whether all pictures are right.
template <class Frame>
bool race_models(const TableOptions& options, Meshes& meshes, std::span<const Entrant> entrants,
                 Comparison& c, std::size_t first, std::size_t steps, bool memory,
                 const Frame& frame_of) {
  bool right = true;
  for (std::size_t m = 0; m < kModels.size(); ++m)
    for (std::size_t s = 0; s < steps; ++s) {
      progress(std::string(kModels[m].name) + (steps == 1 ? "" : ", " + c.rows[s].at));
      const Subject subject = frame_of(meshes[m], s);
      const std::vector<Result> results = contest(subject, entrants, options.plan());
      for (std::size_t i = 0; i < results.size(); ++i)
        c.rows[first + steps * i + s].ours[m] = measured_ms(results[i], subject, memory);
      right = right && all_right(results);
    }
  return right;
}

/// The whole mesh at the paper's size.
auto whole_image(const TableOptions& options) {
  return [&options](const Mesh& mesh, std::size_t) {
    return subject_of(mesh, options.size(paper1::kImage));
  };
}

std::vector<Entrant> rasterizers(const TableOptions& options) {
  std::vector<Entrant> entrants;
  for (const char* const name : kRasterizers) entrants.push_back(entrant(options, name));
  return entrants;
}

/// The bin × fine tile table of one rasterizer on the Dragon (tables 4 and 6).
template <class Rows>
Filled tile_sizes(const TableOptions& options, Meshes& meshes, const Rows& published,
                  const char* rasterizer, int small_px, const char* caption) {
  Comparison c{caption, "ms", "paper, M2000M", options.here(), "edge of a bin, px", {}, {}};
  for (const int tile : paper1::kFineTiles)
    c.columns.push_back("fine tile " + std::to_string(tile) + "²");
  std::vector<Entrant> entrants;
  for (const auto& row : published) {
    c.rows.push_back(row_of(row));
    for (const int tile : paper1::kFineTiles) {
      family::Tuning tuning;
      tuning.bin_px = std::stoi(std::string(row.at));
      tuning.tile_px = tile;
      tuning.small_px = small_px;
      entrants.push_back(entrant(options, rasterizer, "auto", tuning));
    }
  }
  const Subject subject = subject_of(meshes[3], options.size(paper1::kImage));
  progress("Dragon");
  // Leaves out the sizes that the paper could not run.
  std::vector<Entrant> asked;
  for (std::size_t i = 0; i < entrants.size(); ++i)
    if (c.rows[i / 3].published[i % 3].value > 0) asked.push_back(entrants[i]);
  const std::vector<Result> results = contest(subject, asked, options.plan());
  std::size_t next = 0;
  for (std::size_t i = 0; i < entrants.size(); ++i)
    if (c.rows[i / 3].published[i % 3].value > 0)
      c.rows[i / 3].ours[i % 3] = measured_ms(results[next++], subject, true);
  return {std::move(c), all_right(results)};
}

}  // namespace

int run_paper1_table1(std::span<const std::string_view> arguments) {
  return table(
      "paper1-table1", "table 1: a depth-shaded frame of 1024 × 1024 by immediate Pineda", nullptr,
      arguments, [](const TableOptions& options, Meshes& meshes, Document&) -> Filled {
        Comparison c{
            "Immediate Pineda by hardware", "ms", "paper", "here", "hardware", model_columns(), {}};
        for (const auto& row : paper1::kTable1) {
          c.rows.push_back(row_of(row));
          c.rows.back().ours.clear();
        }
        const std::size_t first = c.rows.size();
        std::vector<Entrant> entrants;
        TableOptions one = options;
        one.threads = 1;
        entrants.push_back(entrant(one, "pineda"));
        if (options.threads > 1) entrants.push_back(entrant(options, "pineda"));
        entrants.push_back(entrant(options, "auto"));
        for (const Entrant& e : entrants)
          c.rows.push_back({e.name + ", " + std::to_string(e.options.threads) +
                                (e.options.threads == 1 ? " thread" : " threads"),
                            "",
                            {},
                            std::vector<Measured>(kModels.size())});
        const bool right =
            race_models(options, meshes, entrants, c, first, 1, false, whole_image(options));
        return {std::move(c), right};
      });
}

int run_paper1_table2(std::span<const std::string_view> arguments) {
  return table("paper1-table2", "table 2: effect of the share of a model's triangles",
               "share of the triangles", arguments,
               [](const TableOptions& options, Meshes& meshes, Document& document) -> Filled {
                 document.notes.emplace_back(
                     "A share is the first part of the list of triangles; all vertices stay.");
                 Comparison c = by_model(options, "Time and peak memory by rasterizer and share",
                                         "rasterizer (share)", paper1::kTable2);
                 const bool right =
                     race_models(options, meshes, rasterizers(options), c, 0, 3, true,
                                 [&](const Mesh& mesh, std::size_t s) {
                                   Subject subject = subject_of(mesh, options.size(paper1::kImage));
                                   subject.mesh = first_part(mesh, std::array{0.25, 0.5, 1.0}[s]);
                                   return subject;
                                 });
                 return {std::move(c), right};
               });
}

int run_paper1_table3(std::span<const std::string_view> arguments) {
  return table("paper1-table3", "table 3: effect of the picture's size", "edge of the picture, px",
               arguments, [](const TableOptions& options, Meshes& meshes, Document&) -> Filled {
                 Comparison c =
                     by_model(options, "Time by rasterizer and edge of the picture in px",
                              "rasterizer (edge)", paper1::kTable3);
                 const bool right =
                     race_models(options, meshes, rasterizers(options), c, 0, 4, false,
                                 [&](const Mesh& mesh, std::size_t s) {
                                   return subject_of(mesh, options.size(std::stoi(c.rows[s].at)));
                                 });
                 return {std::move(c), right};
               });
}

int run_paper1_table4(std::span<const std::string_view> arguments) {
  return table(
      "paper1-table4", "table 4: bins and fine tiles of immediate Pineda", "edge of a bin, px",
      arguments, [](const TableOptions& options, Meshes& meshes, Document& document) {
        document.notes.emplace_back(
            "Small triangles have no stage of their own, as in the paper; here those "
            "whose bounding box is a single pixel keep it.");
        return tile_sizes(options, meshes, paper1::kTable4, "pineda", kAlmostNoSmallStage_px,
                          "Dragon, immediate Pineda without the small-triangle stage");
      });
}

int run_paper1_table5(std::span<const std::string_view> arguments) {
  return table("paper1-table5", "table 5: the threshold of small triangles", "threshold, px",
               arguments, [](const TableOptions& options, Meshes& meshes, Document&) -> Filled {
                 Comparison c = by_model(
                     options, "Time by the bounding box, in px, up to which a triangle is small",
                     "rasterizer (threshold)", paper1::kTable5);
                 std::vector<Entrant> entrants;
                 for (const auto& row : paper1::kTable5) {
                   family::Tuning tuning;
                   tuning.small_px = std::stoi(std::string(row.at));
                   entrants.push_back(entrant(options, "pineda", "auto", tuning));
                 }
                 const bool right =
                     race_models(options, meshes, entrants, c, 0, 1, false, whole_image(options));
                 return {std::move(c), right};
               });
}

int run_paper1_table6(std::span<const std::string_view> arguments) {
  return table("paper1-table6", "table 6: bins and fine tiles of tiled Pineda", "edge of a bin, px",
               arguments, [](const TableOptions& options, Meshes& meshes, Document&) {
                 return tile_sizes(options, meshes, paper1::kTable6, "tiled", 0,
                                   "Dragon, tiled Pineda");
               });
}

}  // namespace rastrum::bench
