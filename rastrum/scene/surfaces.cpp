#include <rastrum/scene.hpp>
#include <rastrum/surfaces.hpp>

#include <algorithm>

namespace rastrum {

namespace {

/// Segments of the polylines before the i-th, where each has one position at least.
std::size_t segments_before(const TubesView& tubes, std::size_t i) {
  return static_cast<std::size_t>(tubes.offsets.wide(i) - tubes.offsets.wide(0)) - i;
}

}  // namespace

std::size_t TubesView::size() const {
  if (offsets.empty()) return positions.empty() ? 0 : positions.size() - 1;
  return segments_before(*this, offsets.size() - 1);
}

std::size_t TubesView::begin(std::uint64_t segment) const {
  if (offsets.empty()) return static_cast<std::size_t>(segment);
  // The last polyline that has at most `segment` segments before it.
  std::size_t low = 0, high = offsets.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (segments_before(*this, middle) <= segment ? low : high) = middle;
  }
  return static_cast<std::size_t>(segment + offsets.wide(0)) + low;
}

std::uint64_t primitive_count(const GeometryView& geometry) {
  struct Count {
    std::uint64_t operator()(const MeshView& m) const { return m.triangle_count(); }
    std::uint64_t operator()(const PointsView& p) const { return p.size(); }
    std::uint64_t operator()(const LinesView& l) const { return l.size(); }
    std::uint64_t operator()(const SpheresView& s) const { return s.size(); }
    std::uint64_t operator()(const CylindersView& c) const { return c.size(); }
    std::uint64_t operator()(const TubesView& t) const { return t.size(); }
    std::uint64_t operator()(const DiscsView& d) const { return d.size(); }
  };
  return std::visit(Count{}, geometry);
}

}  // namespace rastrum
