// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/ranks/gather.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

#include <rastrum/core/reject.hpp>
#include <rastrum/render/target_checks.hpp>

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

Targets in_place(const Targets& rows, int top) {
  Targets placed = rows;
  each_target(placed, [&](auto& view, std::uint32_t) { view = in_place(view, top); });
  return placed;
}

Targets first_rows(const Targets& targets, int rows) {
  Targets some = targets;
  raster::for_each_target([&](const auto& row) {
    auto& view = some.*row.image;
    view.height = std::min(view.height, rows);
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
    view = list.emplace_back(width, height).view();  // moving an image keeps its pixels in place
    // Pixels count from the picture's corner, so that code that stores them need not know about
    // parts.
    view.data -= part.y0 * view.stride + part.x0;
    view.width = part.x1;
    view.height = part.y1;
  });
}

OwnBlocks::OwnBlocks(std::uint32_t asked, std::size_t blocks) {
  if (blocks == 0) return;
  each_target(targets_, [&](auto& view, std::uint32_t bit) {
    if ((asked & bit) == 0) return;
    using Pixel = std::remove_cvref_t<decltype(*view.data)>;
    static_assert(alignof(Pixel) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__);
    pixels_.push_back(
        std::make_unique_for_overwrite<std::byte[]>(blocks * kPixels * sizeof(Pixel)));
    // As in a vector, pixels begin to live when they are stored.
    view = {reinterpret_cast<Pixel*>(pixels_.back().get()), kSide,
            static_cast<int>(blocks) * kSide};
  });
  shaded_ = targets_of(targets_, ~kKnownTargets);
}

Targets OwnBlocks::at(std::size_t k, int x0, int y0) const {
  Targets block = shaded_;
  each_target(block, [&](auto& view, std::uint32_t) {
    if (view.empty()) return;
    view.data += static_cast<std::ptrdiff_t>(k * kPixels) - (y0 * view.stride + x0);
    view.width = x0 + kSide;
    view.height = y0 + kSide;
  });
  return block;
}

void OwnBlocks::take(const BlockGrid& grid, std::span<const BlockMask> won,
                     const Targets& images) const {
  for (std::size_t k = 0; k < won.size(); ++k) {
    const Targets block = at(k, grid.x_of(won[k].block), grid.y_of(won[k].block));
    raster::for_each_target([&](const auto& row) {
      const auto &view = block.*row.image, &image = images.*row.image;
      if (row.has_ranks() && !view.empty() && !image.empty())
        grid.each_pixel(won[k], [&](int, int x, int y) { view(x, y) = image(x, y); });
    });
  }
}

namespace {

template <class Images, class F>
void each_narrow(Images& images, const F& f) {
  std::size_t k = 0;
  raster::for_each_target([&]<class T>(const raster::TargetRow<T>& row) {
    if constexpr (std::is_same_v<T, std::int64_t>)
      if (row.narrow != nullptr) f(row, images[k++]);
  });
}

}  // namespace

Targets WideTargets::widen(const Targets& targets, int width, int height) {
  Targets wide = targets;
  each_narrow(images_, [&](const auto& row, Image<std::int64_t>& image) {
    if ((wide.*row.narrow).empty()) return;
    wide.*row.narrow = {};
    if (auto& target = wide.*row.image; target.empty())
      target = image = Image<std::int64_t>(width, height);
  });
  return wide;
}

void WideTargets::narrow(const Targets& targets) const {
  each_narrow(images_, [&](const auto& row, const Image<std::int64_t>& image) {
    const ImageView<std::int32_t>& to = targets.*row.narrow;
    if (to.empty()) return;
    const ImageView<const std::int64_t> target = targets.*row.image;
    const ImageView<const std::int64_t> from = target.empty() ? image.view() : target;
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x) {
        if (!std::in_range<std::int32_t>(from(x, y)))
          reject(row.name, "32: ", from(x, y), " wants 64 bits");
        to(x, y) = static_cast<std::int32_t>(from(x, y));
      }
  });
}

void send_pixels(std::span<const BlockMask> won, const OwnBlocks& own, Bytes& to) {
  std::size_t of_pixel = 0, pixels = 0;
  each_target(own.targets(), [&](const auto& view, std::uint32_t) {
    if (!view.empty()) of_pixel += sizeof(*view.data);
  });
  for (const BlockMask& b : won) pixels += static_cast<unsigned>(std::popcount(b.mask));
  std::size_t at = to.size();
  to.resize(at + won.size() * kMaskBytes + pixels * of_pixel);
  const auto add = [&](const auto* values, std::size_t count) {
    std::memcpy(to.data() + at, values, count * sizeof(*values));
    at += count * sizeof(*values);
  };
  for (std::size_t k = 0; k < won.size(); ++k) {
    add(&won[k].mask, 1);
    add(&won[k].block, 1);
    each_target(own.targets(), [&](const auto& view, std::uint32_t) {
      if (view.empty()) return;
      const auto* const values = view.data + k * kPixels;
      if (won[k].mask == ~std::uint64_t{0}) return add(values, kPixels);
      for (std::uint64_t m = won[k].mask; m != 0; m &= m - 1) add(values + std::countr_zero(m), 1);
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
