// SPDX-License-Identifier: BSD-3-Clause
// Draws a mesh file that does not fit into memory, within a memory limit. The picture is that of
// the whole file, bit for bit. Its rows are written as they come.
#include <cstdint>
#include <cstdio>

#include <rastrum/fit.hpp>
#include <rastrum/io.hpp>
#include <rastrum/out_of_core.hpp>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: out_of_core MESH OUT.png\n");
    return 2;
  }
  try {
    const rastrum::OutOfCoreFile file(argv[1]);
    const rastrum::FrameOptions frame{.width = 1280, .height = 720};
    // Reads all vertices of the file, in place of a scene's.
    rastrum::FitOfFile vertices(file);
    const rastrum::Camera along_z;
    const rastrum::Camera camera =
        rastrum::fit_picture({}, along_z, frame.width, frame.height, {.ranks = &vertices});

    constexpr int kRows = 256;  // of the picture, held at once
    rastrum::Image<rastrum::Rgba8> band(frame.width, kRows);
    rastrum::io::AtomicFile out(argv[2]);
    rastrum::io::PictureRows png(out, rastrum::io::PictureRows::Format::png, frame.width,
                                 frame.height);
    rastrum::OutOfCoreOptions options;
    options.memory_limit = std::uint64_t{64} << 20;
    options.rows = kRows;
    options.take_rows = [&](int first, int last) {
      rastrum::ImageView<const rastrum::Rgba8> rows = band;
      rows.height = last - first;
      png.add(rows);
    };
    const rastrum::OutOfCoreStats stats = file.render(camera, frame, {.color8 = band}, options);
    png.finish();
    out.commit();
    std::printf("%llu of %llu triangles drawn, in %llu pieces\n",
                static_cast<unsigned long long>(stats.seen),
                static_cast<unsigned long long>(stats.triangles),
                static_cast<unsigned long long>(stats.bands));
  } catch (const rastrum::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
