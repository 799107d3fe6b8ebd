// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/large_file.hpp>

#include <cstring>
#include <exception>

#include <rastrum/core/lower.hpp>
#include <rastrum/error.hpp>
#include <rastrum/io/files.hpp>
#include <rastrum/parallel/exec.hpp>
#include <rastrum/stop.hpp>

namespace rastrum::io {
LargeFile::LargeFile(const std::filesystem::path& file)
    : name_(file.string()), extension_(lower(file.extension().string())), mapped_(file) {}

namespace {

std::unique_ptr<LargeFile> open_by_name(const std::filesystem::path& file,
                                        std::uint64_t memory_limit) {
  const std::string extension = lower(file.extension().string());
  if (extension == ".ply") return open_large_ply(file);
  if (extension == ".stl") return open_large_stl(file);
  if (extension == ".glb") return open_large_glb(file, memory_limit);
  if (extension == ".npy") return open_large_npy(file);
  throw Error(Errc::unsupported,
              file.string() + ": out of core only binary files are drawn (.ply, .stl, .glb, .npy)");
}

}  // namespace

std::unique_ptr<LargeFile> LargeFile::open(const std::filesystem::path& file,
                                           std::uint64_t memory_limit) {
  std::unique_ptr<LargeFile> large = open_by_name(file, memory_limit);
  if (large->parts_.empty()) large->parts_ = {{0, large->triangles_}};
  return large;
}

bool LargeFile::lie_far(std::size_t first, std::size_t stride, std::uint64_t count) const {
  PlaceBox box;
  WalkWindow window(mapped_, first);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::size_t at = first + static_cast<std::size_t>(i) * stride;
    Vec3d p;
    std::memcpy(&p, bytes_of_file().data() + at, sizeof(p));
    box.add(float32_of(p));
    if (box.is_near()) return false;
    if (i % (1 << 16) == 0) window.reach(at);
  }
  return box.is_far();
}

void LargeFile::fail(const std::string& message) const {
  check_length();  // lost pages read as zeros, which are wrong, too
  throw Error(Errc::bad_format, shortened(std::string(name_).append(": ").append(message)));
}

void LargeFile::refuse(const std::string& message) const {
  check_length();
  throw Error(Errc::unsupported,
              shortened(std::string(name_).append(": out of core: ").append(message)));
}

void LargeFile::walk(parallel::Threads& threads, std::size_t n,
                     const std::function<std::pair<std::size_t, std::size_t>(std::size_t)>& place,
                     const std::function<void(std::size_t)>& work,
                     const std::function<void(std::size_t, std::size_t)>& behind) const {
  // Half of a window: the next half is requested while threads work on this one.
  constexpr std::size_t kHalf = WalkWindow::kWindow / 2;
  using Place = std::pair<std::size_t, std::size_t>;
  struct Part {
    std::size_t begin, end;
    std::vector<Place> places{};
  };
  const auto part_from = [&](std::size_t begin) {
    Part part{begin, begin};
    for (std::size_t bytes = 0; part.end < n && bytes < kHalf; ++part.end) {
      const Place at = place(part.end);
      bytes += at.second;
      if (!part.places.empty() && part.places.back().first + part.places.back().second == at.first)
        part.places.back().second += at.second;
      else
        part.places.push_back(at);
    }
    for (const Place& at : part.places) mapped_.will_need(at.first, at.second);
    return part;
  };
  std::vector<std::exception_ptr> thrown;
  for (Part now = part_from(0); now.begin != now.end;) {
    throw_if_stopped();
    Part next = part_from(now.end);
    thrown.assign(now.end - now.begin, nullptr);
    parallel::for_each_index(threads, now.end - now.begin, [&](std::size_t i) {
      try {
        work(now.begin + i);
      } catch (...) {
        thrown[i] = std::current_exception();
      }
    });
    check_length();
    for (const std::exception_ptr& e : thrown)
      if (e) std::rethrow_exception(e);
    for (const Place& at : now.places) mapped_.drop(at.first, at.second);
    if (behind) behind(now.begin, now.end);
    now = std::move(next);
  }
}

void LargeFile::read_positions(parallel::Threads& threads, std::span<const std::size_t> runs,
                               const TakePositions& f) const {
  const std::size_t all = position_runs(threads);
  std::vector<FileBox> boxes;
  if (runs.size() == all && all != 0 && !run_box(0)) boxes.resize(all);
  walk(
      threads, runs.size(), [&](std::size_t i) { return place_of_run(runs[i]); },
      [&](std::size_t i) {
        FileBox box;
        read_run(runs[i], [&](std::span<const Vec3d> positions) {
          if (!boxes.empty())
            for (const Vec3d& p : positions) box.add(p);
          f(i, positions);
        });
        if (!boxes.empty()) boxes[runs[i]] = box;
      });
  if (!boxes.empty()) keep_boxes(std::move(boxes));
}

std::uint64_t BitSet::count() const {
  std::uint64_t n = 0;
  for (const std::uint64_t w : words_) n += static_cast<std::uint64_t>(std::popcount(w));
  return n;
}

std::size_t VertexSet::find_places() {
  std::size_t n = 0;
  for (std::size_t w = 0; w < words_.size(); ++w) {
    if (w % 8 == 0) places_[w / 8] = static_cast<std::uint32_t>(n);
    n += static_cast<std::size_t>(std::popcount(words_[w]));
  }
  return n;
}

std::uint32_t VertexSet::place(std::uint64_t v) const {
  const std::size_t word = v / 64;
  auto n = places_[v / 512];
  for (std::size_t w = word / 8 * 8; w < word; ++w)
    n += static_cast<std::uint32_t>(std::popcount(words_[w]));
  const std::uint64_t below = (std::uint64_t{1} << v % 64) - 1;
  return n + static_cast<std::uint32_t>(std::popcount(words_[word] & below));
}

}  // namespace rastrum::io
