// SPDX-License-Identifier: BSD-3-Clause
// Primitives to pieces on a device: assemble_primitive (assemble.hpp) with the clipper, a thread a
// primitive, in order of submission: counted, scanned, written. For the papers' rows, and for
// pieces without room in by-size's queues (by_size.cuh makes the others where it draws them).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <rastrum/error.hpp>
#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/geometry.cuh>
#include <rastrum/raster/cuda/sample_pattern.hpp>
#include <rastrum/raster/rules/coverage.hpp>
#include <rastrum/raster/setup/assemble.hpp>

namespace rastrum::raster {

struct Outcome {
  std::uint8_t pieces = 0;  ///< to be written
  Fate fate = Fate::culled;
  bool valid = true;  ///< its indices and its material's number are in range
};

struct Outcomes {
  std::uint64_t dropped = 0, culled = 0, clipped = 0, invalid = 0;
  std::uint64_t pieces = 0;

  Outcomes() = default;
  RASTRUM_HD explicit Outcomes(const Outcome& o)
      : dropped(o.fate == Fate::dropped),
        culled(o.fate == Fate::culled),
        clipped(o.fate == Fate::clipped),
        invalid(!o.valid),
        pieces(o.pieces) {}
};
struct AddOutcomes {
  RASTRUM_HD Outcomes operator()(Outcomes a, const Outcomes& b) const {
    a.dropped += b.dropped;
    a.culled += b.culled;
    a.clipped += b.clipped;
    a.invalid += b.invalid;
    a.pieces += b.pieces;
    return a;
  }
};

/// Primitives [first, …) of a frame.
struct Assembly {
  DeviceGeometry geometry;
  std::uint64_t first = 0;
  SamplePattern samples{};

  /// Whether a primitive's indices and its material's number are in range.
  [[nodiscard]] RASTRUM_HD static bool is_valid(const Draw& draw, std::uint64_t p) {
    bool valid = true;
    for (int corner = 0; corner < static_cast<int>(draw.topology); ++corner)
      valid = valid && draw.vertex(p, corner) < draw.vertex_count;
    if (!draw.material_flags.empty())
      valid = valid && p < draw.face_materials.size() &&
              draw.face_materials[static_cast<std::size_t>(p)] < draw.material_flags.size();
    return valid;
  }

  /// Calls emit(piece) for the pieces of primitive first + i whose box has a sample of the image.
  /// They are relative to pixel centres; moved() (samples.hpp) moves them for a sample. Does not
  /// set `pieces` of the result.
  template <class Emit>
  RASTRUM_HD Outcome assemble(std::size_t i, Emit&& emit) const {
    const std::uint64_t id = first + i;
    const Draw& draw = geometry.draw_of(id);
    const std::uint64_t p = id - draw.first_id;
    Outcome out;
    out.valid = is_valid(draw, p);
    if (!out.valid) return out;
    const Rect image{0, 0, geometry.width, geometry.height};
    for (int s = 0; s < samples.count; ++s) {
      const SampleOffset at = samples.at[s];
      const auto emit_new = [&](const Piece& seen) {
        const Piece piece = moved(seen, {-at.x, -at.y});
        for (int t = 0; t < s; ++t)
          if (!piece_bounds(moved(piece, samples.at[t]), image).empty()) return;
        emit(piece);
      };
      // Setup leaves out boxes without a sample, so other samples may see what the first does not.
      // A primitive that was drawn has all its pieces.
      const Fate here = assemble_primitive(geometry, draw, p, emit_new, 0, at);
      if (here != Fate::culled) out.fate = here;
      if (here == Fate::drawn || here == Fate::dropped) break;
    }
    return out;
  }
};

namespace cuda_detail {

struct PiecesOf {
  RASTRUM_HD std::size_t operator()(const Outcome& o) const { return o.pieces; }
};
template <class Keep>
struct CountPieces {
  Assembly assembly;
  Keep keep;
  RASTRUM_HD Outcome operator()(std::size_t i) const {
    std::uint8_t pieces = 0;
    Outcome out = assembly.assemble(i, [&](const Piece& piece) { pieces += keep(piece); });
    out.pieces = pieces;
    return out;
  }
};

struct HasPieces {
  std::span<const Outcome> outcomes;
  RASTRUM_HD bool operator()(std::uint32_t i) const { return outcomes[i].pieces > 0; }
};

/// The pieces of primitive first + which[k] with keep(piece), at the places of segment k.
template <class Which, class Keep, class Places>
struct WritePieces {
  Assembly assembly;
  Which which;
  Keep keep;
  Places places;
  Piece* out;
  RASTRUM_HD void operator()(std::size_t k) const {
    std::size_t at = places.first(k);
    if (at == places.segment_end(k)) return;
    assembly.assemble(which[k], [&](const Piece& piece) {
      if (keep(piece)) out[at++] = piece;
    });
  }
};

}  // namespace cuda_detail

/// Writes the pieces of primitives first + which[k] with keep(piece), in order; `pieces_of[k]` is
/// the number of each. Work O(size + pieces). Memory: 48 B a piece and 8 B a primitive. Waits.
template <class Exec, class Which, class PieceCounts, class Keep>
[[nodiscard]] auto write_pieces(Exec& exec, const Assembly& assembly, const Which& which,
                                const PieceCounts& pieces_of, Keep keep) {
  const auto places = parallel::make_expansion(exec, pieces_of, cuda_detail::PiecesOf{});
  auto pieces = parallel::make_buffer<Piece>(exec, places.size());
  const auto view = parallel::view_of(which);
  parallel::for_each_index(
      exec, std::size(which),
      cuda_detail::WritePieces<std::remove_cvref_t<decltype(view)>, Keep, decltype(places.view())>{
          assembly, view, keep, places.view(), pieces.data()});
  return pieces;
}

/// Throws Error{invalid_argument}: an index or a face material is out of range.
inline void check_valid(std::uint64_t invalid) {
  if (invalid > 0)
    throw Error(Errc::invalid_argument,
                std::to_string(invalid).append(
                    " primitives have an index or a face material that is out of range"));
}

}  // namespace rastrum::raster

namespace rastrum::parallel {
template <>
inline constexpr bool kAnyOrder<raster::Outcomes, raster::AddOutcomes> = true;
}  // namespace rastrum::parallel
