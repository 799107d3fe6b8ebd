// SPDX-License-Identifier: BSD-3-Clause
// The writers of io.hpp that take a file name.
#include <rastrum/io.hpp>

namespace rastrum::io {
namespace {

template <class Write>
void write_whole(PathView file, Write write) {
  AtomicFile out(file);
  write(out);
  out.commit();
}

}  // namespace

void write_png(PathView file, ImageView<const Rgba8> image, int threads) {
  write_whole(file, [&](AtomicFile& out) { write_png(out, image, threads); });
}

void write_exr(PathView file, ImageView<const Vec4> image) {
  write_whole(file, [&](AtomicFile& out) { write_exr(out, image); });
}

void write_exr(PathView file, ImageView<const Vec3> image) {
  write_whole(file, [&](AtomicFile& out) { write_exr(out, image); });
}

void write_npy(PathView file, ImageView<const Vec3> image) {
  write_whole(file, [&](AtomicFile& out) { write_npy(out, image); });
}

void write_npy(PathView file, ImageView<const Vec2> image) {
  write_whole(file, [&](AtomicFile& out) { write_npy(out, image); });
}

void write_exr(PathView file, ImageView<const float> image) {
  write_whole(file, [&](AtomicFile& out) { write_exr(out, image); });
}

void write_npy(PathView file, ImageView<const Vec4> image) {
  write_whole(file, [&](AtomicFile& out) { write_npy(out, image); });
}

void write_npy(PathView file, ImageView<const float> image) {
  write_whole(file, [&](AtomicFile& out) { write_npy(out, image); });
}

void write_npy(PathView file, ImageView<const std::int64_t> image) {
  write_whole(file, [&](AtomicFile& out) { write_npy(out, image); });
}

void write_npy(PathView file, ImageView<const std::int32_t> image) {
  write_whole(file, [&](AtomicFile& out) { write_npy(out, image); });
}

void write_ply(PathView file, const Mesh& mesh) {
  write_whole(file, [&](AtomicFile& out) { write_ply(out, mesh); });
}
void write_ply(PathView file, const Points& points) {
  write_whole(file, [&](AtomicFile& out) { write_ply(out, points); });
}

}  // namespace rastrum::io
