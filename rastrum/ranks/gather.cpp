#include <rastrum/ranks/gather.hpp>

#include <type_traits>
#include <utility>

namespace rastrum::ranks {

std::uint32_t targets_asked(const Targets& targets) {
  std::uint32_t asked = 0;
  each_target(targets,
              [&](const auto& view, std::uint32_t bit) { asked |= view.empty() ? 0 : bit; });
  return asked;
}

Targets targets_of(const Targets& targets, std::uint32_t bits) {
  Targets some = targets;
  each_target(some, [&](auto& view, std::uint32_t bit) {
    if ((bits & bit) == 0) view = {};
  });
  return some;
}

OwnImages::OwnImages(std::uint32_t asked, raster::Rect part) {
  const int width = part.x1 - part.x0, height = part.y1 - part.y0;
  if (width == 0) return;
  each_target(targets_, [&](auto& view, std::uint32_t bit) {
    if ((asked & bit) == 0) return;
    using Pixel = std::remove_cvref_t<decltype(*view.data)>;
    auto& list = std::get<std::vector<Image<Pixel>>>(images_);
    view = list.emplace_back(width, height).view();  // an image that moves keeps its pixels' place
    // What is drawn is numbered as in the picture, so that nothing that stores has to know of
    // parts.
    view.data -= part.y0 * view.stride + part.x0;
    view.width = part.x1;
    view.height = part.y1;
  });
}

void send_pixels(const BlockGrid& grid, std::span<const BlockMask> won, const Targets& own,
                 Bytes& to) {
  for (const BlockMask& b : won) {
    put_mask(to, b);
    each_target(own, [&](const auto& view, std::uint32_t) {
      if (!view.empty()) grid.each_pixel(b, [&](int, int x, int y) { put(to, view(x, y)); });
    });
  }
}

void take_pixels(const BlockGrid& grid, Reader from, const Targets& targets) {
  while (!from.at_end()) {
    const BlockMask b = from.take_mask();
    each_target(targets, [&](const auto& view, std::uint32_t) {
      using Pixel = std::remove_cvref_t<decltype(*view.data)>;
      if (!view.empty())
        grid.each_pixel(b, [&](int, int x, int y) { view(x, y) = from.take<Pixel>(); });
    });
  }
}

}  // namespace rastrum::ranks
