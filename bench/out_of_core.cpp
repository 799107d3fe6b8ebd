// SPDX-License-Identifier: BSD-3-Clause
// `rastrum bench out_of_core`: a generated mesh that may be larger than memory, drawn at 1920 ×
// 1080 within a memory limit, opaque and at opacity 0.3. Shows the time, the greatest resident
// memory (including mapped pages in use) and how long it takes to read the same bytes. First a
// tenth of the mesh is drawn both ways, out of core and in memory, and the pictures are compared,
// bit for bit.
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/io.hpp>
#include <rastrum/out_of_core.hpp>

#include "measure.hpp"
#include "options.hpp"
#include "registry.hpp"
#include "report.hpp"

namespace rastrum::bench {
namespace {

constexpr int kSheets = 5, kWidth = 1920, kHeight = 1080;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Writes wavy sheets one behind the other: about `triangles` triangles in rows of squares, 12
/// bytes a vertex and 13 a face. Returns the number of triangles.
std::uint64_t write_sheets(const std::filesystem::path& file, double triangles) {
  const auto n = static_cast<std::uint64_t>(std::sqrt(triangles / 2 / kSheets)) + 1;  // squares
  const std::uint64_t vertices = kSheets * (n + 1) * (n + 1), faces = kSheets * 2 * n * n;
  std::string head = "ply\nformat binary_little_endian 1.0\ncomment ";
  std::string rest = "\nelement vertex ";
  rest.append(std::to_string(vertices));
  rest += "\nproperty float x\nproperty float y\nproperty float z\nelement face ";
  rest.append(std::to_string(faces));
  rest += "\nproperty list uchar int vertex_indices\nend_header\n";
  // The reader uses float32 in place if they lie at multiples of four.
  head.append(4 - (head.size() + rest.size()) % 4, '-').append(rest);
  io::AtomicFile out(file);
  out.write(head.data(), head.size());
  std::vector<float> wave(n + 1);
  for (std::uint64_t i = 0; i <= n; ++i)
    wave[i] =
        static_cast<float>(0.05 * std::sin(40 * static_cast<double>(i) / static_cast<double>(n)));
  std::vector<Vec3> row(n + 1);
  const auto across = [&](std::uint64_t i) {
    return static_cast<float>(2 * static_cast<double>(i) / static_cast<double>(n) - 1);
  };
  for (int s = 0; s < kSheets; ++s)
    for (std::uint64_t j = 0; j <= n; ++j) {
      for (std::uint64_t i = 0; i <= n; ++i)
        row[i] = {1.7F * across(i), across(j), wave[i] + wave[j] - 0.25F * static_cast<float>(s)};
      out.write(row.data(), row.size() * sizeof(Vec3));
    }
  std::vector<std::byte> squares(n * 26);
  for (int s = 0; s < kSheets; ++s)
    for (std::uint64_t j = 0; j < n; ++j) {
      std::byte* to = squares.data();
      const auto put = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        *to = std::byte{3};
        const std::uint32_t corners[3] = {a, b, c};
        std::memcpy(to + 1, corners, 12);
        to += 13;
      };
      auto at = static_cast<std::uint32_t>((static_cast<std::uint64_t>(s) * (n + 1) + j) * (n + 1));
      const auto down = static_cast<std::uint32_t>(n + 1);
      for (std::uint64_t i = 0; i < n; ++i, ++at) {
        put(at, at + 1, at + down);
        put(at + 1, at + down + 1, at + down);
      }
      out.write(squares.data(), squares.size());
    }
  out.commit();
  return faces;
}

Camera camera() {
  Camera c;
  c.eye = {0.1, 0.2, 1.9};
  c.target = {0, 0, -0.5};
  c.near_plane = 0.1F;
  return c;
}

FrameOptions frame_of(float opacity) {
  FrameOptions frame;
  frame.width = kWidth;
  frame.height = kHeight;
  frame.shader = Shader::phong;
  frame.opacity = opacity;
  return frame;
}

/// Writes a file to the disk and drops it from the page cache.
void forget(const std::filesystem::path& file) {
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
  ::close(fd);
}

void restart_peak() {
  std::ofstream("/proc/self/clear_refs") << "5";
}
/// The greatest resident memory since restart_peak(), MiB; 0 if the system does not say.
double peak_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

/// Seconds to read all bytes of a file once.
double read_all(const std::filesystem::path& file) {
  const double begin = now_s();
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  std::vector<char> buffer(std::size_t{1} << 22);
  while (fd >= 0 && ::read(fd, buffer.data(), buffer.size()) > 0) {
  }
  if (fd >= 0) ::close(fd);
  return now_s() - begin;
}

struct Pixels {
  Image<Rgba8> color{kWidth, kHeight};
  Image<std::int64_t> ids{kWidth, kHeight};
  Image<float> depth{kWidth, kHeight};
  [[nodiscard]] Targets targets() {
    return {.color8 = color.view(), .depth = depth.view(), .ids = ids.view()};
  }
  [[nodiscard]] bool operator==(const Pixels& o) const {
    return same_bits(color, o.color) && same_bits(ids, o.ids) && same_bits(depth, o.depth);
  }
};

/// Whether both ways give the same bits.
bool compare(const std::filesystem::path& file, float opacity, const OutOfCoreOptions& options) {
  Pixels in_memory, out_of_core;
  {
    const Scene scene = io::read_scene(file);
    const SceneBinding binding(scene);
    Renderer renderer(options.renderer);
    renderer.render(binding.view(), camera(), frame_of(opacity), in_memory.targets());
  }
  (void)OutOfCoreFile(file).render(camera(), frame_of(opacity), out_of_core.targets(), options);
  return in_memory == out_of_core;
}

}  // namespace

int run_out_of_core(std::span<const std::string_view> arguments) {
  OptionParser parser("out_of_core",
                      "A mesh larger than memory, drawn chunk by chunk within a limit");
  double millions = 20, limit_gib = 2;
  std::string folder = std::filesystem::temp_directory_path().string(), keep;
  bool warm_only = false, no_comparison = false;
  parser.add_option("--millions", millions, "millions of triangles (default: 20)");
  parser.add_option("--limit", limit_gib, "memory limit in GiB (default: 2)");
  parser.add_option("--folder", folder, "folder to which the mesh is written, 19 bytes a triangle");
  parser.add_option("--keep", keep,
                    "name of the mesh there: drawn if it exists, else made and kept");
  parser.add_flag("--warm", warm_only, "do not take the file out of the page cache first");
  parser.add_flag("--no-comparison", no_comparison, "do not draw a tenth in memory first");
  if (const auto status = parser.parse(arguments)) return *status;
  namespace fs = std::filesystem;
  std::printf("%s\n", machine_text().c_str());
  OutOfCoreOptions options;
  options.memory_limit = static_cast<std::uint64_t>(limit_gib * double{1 << 30});

  bool right = true;
  if (!no_comparison) {
    const fs::path tenth = fs::path(folder) / "rastrum_tenth.ply";
    const std::uint64_t triangles = write_sheets(tenth, millions * 1e5);
    for (const float opacity : {1.0F, 0.3F}) {
      const bool same = compare(tenth, opacity, options);
      right = right && same;
      std::printf("%.1f M triangles, opacity %.1f: the picture of both ways %s\n",
                  static_cast<double>(triangles) / 1e6, static_cast<double>(opacity),
                  same ? "is the same" : "DIFFERS");
    }
    fs::remove(tenth);
  }

  const fs::path file = fs::path(folder) / (keep.empty() ? "rastrum_large.ply" : keep);
  if (keep.empty() || !fs::exists(file)) {
    const double begin = now_s();
    write_sheets(file, millions * 1e6);
    std::printf("written in %.1f s\n", now_s() - begin);
  }
  const double gigabytes = static_cast<double>(fs::file_size(file)) / 1e9;
  std::printf("%.1f M triangles, %.2f GB, limit %.2f GiB\n",
              static_cast<double>(OutOfCoreFile(file).triangles()) / 1e6, gigabytes, limit_gib);
  const Table table({{"what", 24, true},
                     {"from", 6, true},
                     {"s", 8},
                     {"GB/s", 8},
                     {"peak MiB", 9},
                     {"drawn M", 8},
                     {"bands", 6},
                     {"chunks", 7}});
  table.print_head();
  for (const bool cold : {true, false}) {
    if (cold && warm_only) continue;
    const char* const from = cold ? "disk" : "cache";
    if (cold) forget(file);
    const double read_s = read_all(file);
    table.print_row({"reading all bytes", from, significant(read_s),
                     significant(gigabytes / read_s), "", "", "", ""});
    for (const float opacity : {1.0F, 0.3F}) {
      if (cold) forget(file);
      Pixels pixels;
      restart_peak();
      const double begin = now_s();
      const OutOfCoreStats stats =
          OutOfCoreFile(file).render(camera(), frame_of(opacity), pixels.targets(), options);
      const double s = now_s() - begin;
      table.print_row({opacity < 1 ? "opacity 0.3" : "opaque", from, significant(s),
                       significant(gigabytes / s), significant(peak_mib(), 4),
                       significant(static_cast<double>(stats.seen) / 1e6),
                       std::to_string(stats.bands), std::to_string(stats.chunks)});
    }
  }
  if (keep.empty()) fs::remove(file);
  return right ? 0 : 1;
}

}  // namespace rastrum::bench
