// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/cull/selection.hpp>

#include <algorithm>
#include <bit>
#include <limits>

namespace rastrum::raster {
namespace {

/// Slots of a task: some 50 µs, or fewer where many threads would have too few tasks.
constexpr std::uint64_t kSlotsAtOnce = 1024, kLeastAtOnce = 64, kTasksOfThread = 4;
/// Triangles of a plain run, so that runs can be shared out.
constexpr std::uint64_t kPlainRun = 4096;

/// With this many cluster vertices for each mesh vertex, projecting the whole mesh in order is
/// faster than cluster by cluster, which scatters its results over the mesh's memory.
constexpr double kWorthAll = 0.65;

/// Whether slots are copies. They are for small meshes, since a batch of setup takes several
/// copies.
bool is_by_copies(const Draw& draw) {
  return is_projected_at_once(draw) && !draw.clusters->way.always;
}

std::uint64_t slots_of(const Draw& draw) {
  return is_by_copies(draw) ? draw.copies.count
                            : draw.copies.count * draw.clusters->clusters.size();
}

}  // namespace

/// Slots of a draw, or plain triangles.
struct Selection::Part {
  const Draw* draw = nullptr;
  std::uint64_t begin = 0, end = 0;   ///< slots of the draw; plain: ids
  std::uint64_t first_slot = 0;       ///< the draw's first slot in the frame
  std::uint64_t first = 0, last = 0;  ///< the range of ids to choose from
  bool plain = false;
  Found* found = nullptr;
  std::size_t at = 0, count = 0, to = 0;  ///< in `found`, and where they go in the end
  std::uint64_t triangles = 0, outside = 0, away = 0;
};

struct Selection::Found {
  explicit Found(MemoryAccount& memory) : list(memory) {}
  ScratchBuffer<Candidate> list;
  std::size_t count = 0;

  void add(const Candidate& candidate) {
    list.grow(count + 1, count);
    list[count++] = candidate;
  }
};

Selection::Selection(MemoryAccount& memory)
    : candidates_(memory), runs_(memory), found_([&memory] { return Found(memory); }) {}

Selection::~Selection() = default;

bool join(SetupRun& before, const SetupRun& next) {
  if (before.cluster != SetupRun::kPlain || next.cluster != SetupRun::kPlain ||
      before.first + before.count != next.first || before.count + next.count > kPlainRun)
    return false;
  before.count += next.count;
  return true;
}

void Selection::begin(const FrameContext& frame, std::uint64_t first, std::uint64_t last) {
  parts_.clear();
  slots_ = fingerprint_ = 0;
  always_ = false;
  for (const Draw& draw : frame.geometry.draws) {
    const std::uint64_t begin = std::max(first, draw.first_id);
    const std::uint64_t end = std::min(last, draw.first_id + draw.primitive_count);
    Part part{.draw = &draw, .first = begin, .last = end};
    if (draw.clusters == nullptr || !draw.visible) {
      part.plain = true;
      part.begin = begin;
      part.end = end;
      if (begin < end) parts_.push_back(part);
      continue;
    }
    const std::uint64_t slots = slots_of(draw);
    for (const std::uint64_t v : {std::uint64_t{reinterpret_cast<std::uintptr_t>(draw.clusters)},
                                  draw.first_id, std::uint64_t{draw.primitive_count}})
      fingerprint_ = (std::rotl(fingerprint_, 23) ^ v) * 0x9E3779B97F4A7C15U;
    part.first_slot = slots_;
    always_ = always_ || draw.clusters->way.always;
    const std::uint64_t at_once =
        std::clamp(slots / (kTasksOfThread * static_cast<std::uint64_t>(frame.concurrency())),
                   kLeastAtOnce, kSlotsAtOnce);
    for (std::uint64_t s = 0; s < slots && begin < end; s += at_once) {
      part.begin = s;
      part.end = std::min(slots, s + at_once);
      parts_.push_back(part);
    }
    slots_ += slots;
  }
}

void Selection::choose(FrameContext& frame, bool copies) {
  found_.for_each([](Found& f) { f.count = 0; });
  frame.for_each_index(parts_.size(), [&](std::size_t i) {
    Part& part = parts_[i];
    part.found = &found_.local();
    part.at = part.found->count;
    choose_of(frame, part, *part.found, copies);
    part.count = part.found->count - part.at;
  });
  count_ = 0;
  triangles_ = 0;
  std::uint64_t outside = 0, away = 0;
  for (Part& part : parts_) {
    part.to = count_;
    count_ += part.count;
    outside += part.outside;
    away += part.away;
  }
  candidates_.reserve(count_);
  frame.for_each_index(parts_.size(), [&](std::size_t i) {
    Part& part = parts_[i];
    const Candidate* const found = part.found->list.data() + part.at;
    std::copy_n(found, part.count, candidates_.data() + part.to);
    part.triangles = 0;
    for (std::size_t k = 0; k < part.count; ++k) part.triangles += found[k].run.count;
  });
  for (const Part& part : parts_) triangles_ += part.triangles;
  if (frame.first_band) frame.stats.triangles.culled += outside + away;
  frame.count("triangles of clusters outside", outside);
  frame.count("triangles of clusters that face away", away);
}

void Selection::project(const FrameContext& frame, double part) const {
  if (frame.projected == nullptr) return;
  for (std::size_t i = 0; i < parts_.size();) {
    const Draw* const of = parts_[i].draw;
    std::uint64_t chosen = 0;
    for (; i < parts_.size() && parts_[i].draw == of; ++i) chosen += parts_[i].triangles;
    Draw& draw = frame.request.draws[static_cast<std::size_t>(of - frame.geometry.draws.data())];
    if (draw.clusters == nullptr || draw.first_vertex == kNotProjected || draw.is_projected)
      continue;
    const double vertices = static_cast<double>(chosen) * part *
                            static_cast<double>(draw.clusters->vertex.size()) /
                            static_cast<double>(draw.own_primitives());
    if (vertices >= kWorthAll * static_cast<double>(draw.vertex_count)) frame.project(draw);
  }
}

std::span<const SetupRun> Selection::runs() {
  runs_.reserve(count_);
  std::size_t count = 0;
  for (std::size_t i = 0; i < count_; ++i)
    if (count == 0 || !join(runs_[count - 1], candidates_[i].run))
      runs_[count++] = candidates_[i].run;
  return {runs_.data(), count};
}

void Selection::choose_of(const FrameContext& frame, Part& part, Found& found, bool copies) {
  constexpr float kUnknown = std::numeric_limits<float>::infinity();
  if (part.plain) {
    for (std::uint64_t id = part.begin; id < part.end; id += kPlainRun)
      found.add({.run = {id, static_cast<std::uint32_t>(std::min(kPlainRun, part.end - id))},
                 .highest = kUnknown});
    return;
  }
  const Draw& draw = *part.draw;
  const MeshClusters& mesh = *draw.clusters;
  const Viewport viewport = frame.geometry.viewport;
  const Rect image{0, 0, frame.geometry.width, frame.geometry.height};
  const bool wide = !mesh.wide.empty();
  const Cull cull = draw.effective_cull();
  const std::uint64_t own = draw.own_primitives();
  const bool by_copies = is_by_copies(draw);
  const auto view_of = [&](std::uint64_t copy) {
    return ClusterView(draw.source.matrix_of(copy).object_to_clip, wide, viewport, !by_copies);
  };
  const auto place = [](const ClusterView& view, const auto& box) {
    return box.finite ? view.place(box.min, box.max) : BoxPlace{};
  };
  const auto is_chosen = [&](std::uint64_t id) { return id >= part.first && id < part.last; };
  // Notes what the depth test needs to know about a place in the picture.
  const auto see = [&](const ClusterView& view, const MeshCluster& c, const BoxPlace& at,
                       Candidate& candidate) {
    const Rect seen{std::max(at.pixels.x0, image.x0), std::max(at.pixels.y0, image.y0),
                    std::min(at.pixels.x1, image.x1), std::min(at.pixels.y1, image.y1)};
    if (!at.whole || seen.empty()) return;
    candidate.highest = view.highest_sample(c, at);
    candidate.leans_away = view.leans_away(c);
    candidate.bx0 = static_cast<std::uint16_t>(seen.x0 / kBlockSize);
    candidate.by0 = static_cast<std::uint16_t>(seen.y0 / kBlockSize);
    candidate.bx1 = static_cast<std::uint16_t>((seen.x1 - 1) / kBlockSize + 1);
    candidate.by1 = static_cast<std::uint16_t>((seen.y1 - 1) / kBlockSize + 1);
  };

  if (by_copies) {
    MeshCluster whole{.min = mesh.all.min, .max = mesh.all.max};
    for (const MeshCluster& c : mesh.clusters)
      whole.longest_edge = std::max(whole.longest_edge, c.longest_edge);
    for (std::uint64_t copy = part.begin; copy < part.end; ++copy) {
      const std::uint64_t begin = std::max(part.first, draw.first_id + copy * own);
      const std::uint64_t end = std::min(part.last, draw.first_id + (copy + 1) * own);
      if (begin >= end) continue;
      const auto n = static_cast<std::uint32_t>(end - begin);
      const ClusterView view = view_of(copy);
      const BoxPlace at = place(view, mesh.all);
      if (at.outside) {
        part.outside += n;
        continue;
      }
      Candidate candidate{.run = {begin, n}, .highest = kUnknown};
      if (copies) {
        candidate.slot = part.first_slot + copy;
        candidate.leans = false;
        see(view, whole, at, candidate);
        found.add(candidate);
        continue;
      }
      // Joins neighbours, up to a plain run.
      if (found.count == part.at || !join(found.list[found.count - 1].run, candidate.run))
        found.add(candidate);
    }
    return;
  }

  const std::uint64_t clusters = mesh.clusters.size();
  for (std::uint64_t slot = part.begin; slot < part.end;) {
    const std::uint64_t copy = slot / clusters;
    const std::uint64_t copy_end = std::min(part.end, (copy + 1) * clusters);
    const std::uint64_t first_id = draw.first_id + copy * own;
    const ClusterView view = view_of(copy);
    const auto leave_out = [&](std::uint64_t end) {
      for (; slot < end; ++slot) {
        const MeshCluster& c = mesh.clusters[slot % clusters];
        if (is_chosen(first_id + c.first_triangle)) part.outside += c.triangles;
      }
    };
    const BoxPlace all = place(view, mesh.all);
    if (all.outside) {
      leave_out(copy_end);
      continue;
    }
    while (slot < copy_end) {
      const std::uint64_t in_mesh = slot % clusters;
      const std::uint64_t node = in_mesh / MeshClusters::kNode;
      const std::uint64_t node_end =
          std::min(copy_end, slot - in_mesh + (node + 1) * MeshClusters::kNode);
      if (!all.inside && place(view, mesh.nodes[node]).outside) {
        leave_out(node_end);
        continue;
      }
      for (; slot < node_end; ++slot) {
        const MeshCluster& c = mesh.clusters[slot % clusters];
        if (!is_chosen(first_id + c.first_triangle)) continue;
        Candidate candidate{
            .run = {first_id, c.triangles, static_cast<std::uint32_t>(slot % clusters)},
            .slot = part.first_slot + slot,
            .highest = kUnknown};
        const BoxPlace at = place(view, c);
        if (at.outside) {
          part.outside += c.triangles;
          continue;
        }
        if (at.whole && view.faces_away(c, at, cull)) {
          part.away += c.triangles;
          continue;
        }
        see(view, c, at, candidate);
        found.add(candidate);
      }
    }
  }
}

bool has_clusters(const FrameRequest& request) {
  return std::ranges::any_of(request.draws, [](const Draw& d) { return d.clusters != nullptr; });
}

void keep_clusters(std::span<Draw> draws, bool by_clusters) {
  for (Draw& draw : draws)
    if (!by_clusters || !draw.has_kernel() || draw.cut != nullptr) draw.clusters = nullptr;
}

}  // namespace rastrum::raster
