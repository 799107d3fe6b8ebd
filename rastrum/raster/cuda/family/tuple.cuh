// tuple on a device: every fragment is shaded, and (word, colour) pairs are reduced by their
// pixels' indices, the greater word with its colour (paper 1, section 3.2.1). No machine changes 24
// bytes at once, so reduce_by_index sorts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <rastrum/parallel/cuda/words.cuh>
#include <rastrum/raster/cuda/family/fragments.cuh>

namespace rastrum::raster::family {

/// The nearest fragment of a pixel so far.
struct Seen {
  std::uint64_t word;
  Vec4 color;
};
/// Equal words are the same fragment's, with one colour.
struct GreaterWord {
  RASTRUM_HD Seen operator()(const Seen& a, const Seen& b) const { return a.word < b.word ? b : a; }
};

}  // namespace rastrum::raster::family

namespace rastrum::parallel {
template <>
inline constexpr bool kAnyOrder<raster::family::Seen, raster::family::GreaterWord> = true;
}  // namespace rastrum::parallel

namespace rastrum::raster::family {

struct SeenOfWord {
  const std::uint64_t* words;
  RASTRUM_HD Seen operator()(std::size_t i) const { return {words[i], {}}; }
};
struct SeenOfFragment {
  const std::uint64_t* words;
  const Vec4* colors;  ///< may be null
  RASTRUM_HD Seen operator()(std::size_t k) const {
    return {words[k], colors == nullptr ? Vec4{} : colors[k]};
  }
};
struct StoreSeen {
  const Seen* seen;
  std::uint64_t* words;
  Vec4* colors;  ///< may be null
  RASTRUM_HD void operator()(std::size_t i) const {
    words[i] = seen[i].word;
    if (colors != nullptr) colors[i] = seen[i].color;
  }
};

/// Work O(fragments) shading and O(fragments · digits); 32 bytes a pixel. Counter: "fragments
/// shaded", none where the frame wants no colours or the host shades what it sees.
template <class Exec>
class TupleOnDevice final : public DeviceVisibility<Exec> {
 public:
  explicit TupleOnDevice(FamilyFrame<Exec>& frame)
      : seen_(parallel::make_buffer<Seen>(frame.exec, frame.pixel_count())) {
    parallel::tabulate(frame.exec, seen_, SeenOfWord{frame.surface.words.words});
  }
  void resolve(FamilyFrame<Exec>& frame, std::span<const Piece> pieces,
               std::span<const Block> blocks, std::uint64_t) override {
    // Its element, word and colour; sorted, its place and its element twice; its run's sum.
    constexpr std::uint64_t kFragmentBytes =
        12 + sizeof(Vec4) + 1 + 4 * sizeof(std::size_t) + sizeof(std::size_t) + sizeof(Seen) + 16;
    const auto& shade = frame.shading.shade;
    each_written_part(frame, pieces, blocks, kFragmentBytes, [&](auto& element, auto& word) {
      auto color = parallel::make_buffer<Vec4>(frame.exec, shade ? word.size() : 0);
      if (shade) {
        shade(parallel::view_of(std::as_const(element)), parallel::view_of(std::as_const(word)),
              parallel::view_of(color));
        frame.count("fragments shaded", word.size());
      }
      parallel::reduce_by_index(
          frame.exec, seen_, element,
          parallel::Computed(word.size(), SeenOfFragment{word.data(), color.data()}),
          GreaterWord{});
    });
  }
  void finish(FamilyFrame<Exec>& frame) override {
    parallel::for_each_index(
        frame.exec, seen_.size(),
        StoreSeen{seen_.data(), frame.surface.words.words,
                  frame.shading.colors.empty() ? nullptr : frame.shading.colors.data()});
  }

 private:
  decltype(parallel::make_buffer<Seen>(std::declval<Exec&>(), 0)) seen_;
};

}  // namespace rastrum::raster::family
