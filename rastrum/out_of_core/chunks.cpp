// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/out_of_core/chunks.hpp>

#include <algorithm>
#include <future>
#include <numeric>

#include <rastrum/stop.hpp>

namespace rastrum::out_of_core {

Chunks::Chunks(const io::LargeFile& file, std::uint64_t triangles, std::size_t vertex_bytes)
    : file_(file), vertex_bytes_(vertex_bytes) {
  triangles = std::max<std::uint64_t>(triangles, 1);
  for (std::size_t part = 0; part < file.parts().size(); ++part) {
    const auto [first, count] = file.parts()[part];
    for (std::uint64_t t = 0; t < count; t += triangles)
      places_.push_back({places_.size(), part, first + t, std::min(triangles, count - t)});
  }
  boxes_.resize(places_.size());
  in_file_.resize(places_.size());
  std::iota(in_file_.begin(), in_file_.end(), std::size_t{0});
}

void Chunks::walk(std::span<const std::size_t> order, const Work& f, const Wanted& wanted) {
  std::size_t next = 0;
  const auto begin = [&](io::FileChunk& chunk) -> std::future<void> {
    while (next < order.size()) {
      const Place& at = places_[order[next]];
      ++next;
      if (wanted && !wanted(at)) {
        ++left_out_;
        continue;
      }
      ++read_;
      return std::async(std::launch::async, [this, &at, &chunk] {
        file_.read(at.first, static_cast<std::size_t>(at.count), vertex_bytes_, chunk);
        std::optional<io::FileBox>& box = boxes_[at.number];
        if (box || file_.box(at.first, at.count)) return;
        box.emplace();
        for (std::size_t v = 0; v < chunk.positions.size(); ++v) box->add(chunk.positions.wide(v));
      });
    }
    return {};
  };
  int now = 0;
  std::future<void> coming = begin(two_[0]);
  while (coming.valid()) {
    coming.get();
    throw_if_stopped();
    const io::FileChunk& chunk = two_[now];
    const Place& at = places_[order[next - 1]];
    now = 1 - now;
    coming = begin(two_[now]);  // its destructor waits if f throws
    f(chunk, at);
    file_.check_length();  // positions are read from the mapped file
    file_.drop(chunk);
  }
}

std::optional<io::FileBox> Chunks::box(const Place& chunk) const {
  std::optional<io::FileBox> box = boxes_[chunk.number];
  if (!box) box = file_.box(chunk.first, chunk.count);
  if (box && (!box->finite || box->empty())) return {};
  return box;
}

}  // namespace rastrum::out_of_core
