// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/draws/numbering.hpp>

#include <cmath>
#include <unordered_map>

#include <rastrum/core/enum.hpp>
#include <rastrum/error.hpp>
#include <rastrum/scene/mesh_checks.hpp>

namespace rastrum::raster {
namespace {

[[noreturn]] void refuse(const DrawNames& names, std::size_t draw, const std::string& problem) {
  throw Error(Errc::invalid_argument, names.of(draw).append(": ").append(problem));
}

void check_draw(const Draw& draw, const DrawNames& names, std::size_t number) {
  const auto require = [&](bool ok, const char* what) {
    if (!ok) refuse(names, number, what);
  };
  require(draw.topology >= Topology::points, "its topology is 0, which is no value of its enum");
  const auto check = [&](auto value, auto last, const char* what) {
    if (value > last)  // for a million draws, names cost time
      check_enum(value, last, names.of(number).append(what));
  };
  check(draw.topology, Topology::triangles, ": its topology");
  check(draw.cull, Cull::front, ": its cull");
  check(draw.winding, Winding::either, ": its winding");
  if (draw.quadrics != nullptr) return;
  require(bool{draw.source}, "its source is null; set it to what projects its vertices");
  if (draw.mesh != nullptr) {
    if (const std::string problem = faces_problem(*draw.mesh); !problem.empty())
      refuse(names, number, problem);
    require(draw.topology == Topology::triangles, "a mesh has triangles");
  }
  const bool indexed = !draw.indices.empty();
  const std::size_t corners = indexed ? draw.indices.size() : draw.own_vertices();
  const std::uint64_t most = draw.mesh != nullptr
                                 ? draw.mesh->triangle_count()
                                 : corners / static_cast<std::size_t>(draw.topology);
  // Points and lines are counted by their own arrays, so the number is right.
  if (draw.points == nullptr && draw.lines == nullptr && draw.own_primitives() > most)
    refuse(names, number,
           "primitive_count is " + std::to_string(draw.own_primitives()) + ", but its " +
               std::to_string(corners) + (indexed ? " indices" : " vertices") + " make up " +
               std::to_string(most));
  // A NaN fails.
  require(draw.line_width > 0 && draw.line_width <= kMaxLineWidth,
          "the line width must be > 0 and at most 4096 px");
  require(draw.point_size > 0 && draw.point_size <= kMaxPointSize,
          "the point size must be > 0 and at most 4096 px");
  require(std::isfinite(draw.depth_bias) && std::isfinite(draw.depth_bias_slope),
          "the depth bias must be finite");
  if (draw.material_flags.empty()) return;
  require(draw.face_materials.size() >=
              (draw.mesh != nullptr ? draw.mesh->face_count() : draw.own_primitives()),
          "it has flags by material, but fewer face materials than primitives");
  require(
      first_beyond(draw.face_materials, draw.material_flags.size()) == draw.face_materials.size(),
      "a face material is out of range");
}

}  // namespace

Totals number_draws(std::span<Draw> draws, std::uint64_t first_id, const DrawNames& names) {
  Totals totals;
  std::unordered_map<Shading, std::size_t, Shading::Hash> of_shading;
  std::size_t* number = nullptr;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    Draw& draw = draws[i];
    check_draw(draw, names, i);
    draw.first_id = first_id + totals.primitives;
    draw.first_vertex = totals.vertices;
    // Mostly all draws share a shading, so few look-ups are needed.
    if (i == 0 || draw.shading != draws[i - 1].shading) number = &of_shading[draw.shading];
    draw.number = (*number)++;
    totals.primitives += draw.primitive_count;
    totals.vertices += draw.vertex_count;
  }
  if (totals.primitives > kMaxId || first_id > kMaxId - totals.primitives)
    throw Error(Errc::invalid_argument,
                "the scene has " + std::to_string(first_id + totals.primitives) +
                    " primitives; at most " + std::to_string(kMaxId) + " have an id");
  return totals;
}

void check_indices(std::span<const Draw> draws, const DrawNames& names) {
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const Draw& draw = draws[i];
    const IndexView indices = draw.index_view();
    if (const std::size_t at = first_beyond(indices, draw.own_vertices()); at != indices.size())
      refuse(names, i,
             "indices[" + std::to_string(at) + "]: index " + indices.text(at) +
                 " is out of range, there are " + std::to_string(draw.own_vertices()) +
                 " vertices");
  }
}

}  // namespace rastrum::raster
