#include <rastrum/scene.hpp>
#include <rastrum/scene/polylines.hpp>
#include <rastrum/surfaces.hpp>

namespace rastrum {

std::size_t TubesView::size() const {
  if (offsets.empty()) return positions.empty() ? 0 : positions.size() - 1;
  return polylines::segments_before(offsets, offsets.size() - 1);
}

std::size_t TubesView::begin(std::uint64_t segment) const {
  const auto s = static_cast<std::size_t>(segment);
  return offsets.empty() ? s : polylines::begin_of(offsets, s);
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
