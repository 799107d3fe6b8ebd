// SPDX-License-Identifier: BSD-3-Clause
#include <papers/table/row.hpp>

namespace rastrum::family {
namespace {

class RowMethod final : public Method {
 public:
  RowMethod(const CoverageRow& coverage, const Visibility& visibility, const Tuning& tuning,
            bool hierarchical_z, MemoryAccount& memory)
      : row_(coverage),
        visibility_(visibility),
        tuning_(tuning),
        hierarchical_z_(hierarchical_z),
        coverage_(coverage.make(tuning, memory)),
        scratch_(memory) {}

  [[nodiscard]] Needs needs() const override {
    return {.rasterizer = row_.name,
            .visibility = visibility_.name,
            .surface = !row_.owns_tiles,
            .surface_bytes = visibility_.surface_bytes,
            .colors = visibility_.shades,
            .triangle_bytes = row_.triangle_bytes,
            .expands = row_.expands,
            .whole_view = visibility_.whole_view};
  }
  void draw(raster::FrameRun& under_way, std::uint64_t first, std::uint64_t last) override {
    Frame frame(under_way, tuning_, hierarchical_z_, visibility_, scratch_);
    coverage_->draw(frame, first, last);
  }
  /// Drops the regions, whose counters hold the abandoned frame's work.
  void abandon() override {
    scratch_.shared.reset();
    scratch_.workers.for_each([](Worker& worker) { worker.region.reset(); });
  }

 private:
  const CoverageRow& row_;
  const Visibility& visibility_;
  const Tuning tuning_;
  const bool hierarchical_z_;
  std::unique_ptr<Coverage> coverage_;
  FrameScratch scratch_;
};

}  // namespace

std::unique_ptr<Method> make_row(const CoverageRow& coverage, const Visibility& visibility,
                                 const Tuning& tuning, bool hierarchical_z, MemoryAccount& memory) {
  return std::make_unique<RowMethod>(coverage, visibility, tuning, hierarchical_z, memory);
}

}  // namespace rastrum::family
