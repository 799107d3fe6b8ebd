// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes files; the extension chooses the format. Readers keep the file's order: triangle
// ids count in it, and nothing is merged or reordered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <rastrum/held.hpp>
#include <rastrum/image.hpp>
#include <rastrum/path.hpp>
#include <rastrum/scene.hpp>

namespace RASTRUM_API rastrum {
namespace io {

class AtomicFile;

/// Limits of a reader.
struct ReadOptions {
  /// In bytes. A document may take 64 bytes of memory for each byte of it and of the files that it
  /// names, and this many on top. Reading throws Error{out_of_memory} before it takes more, so a
  /// small file cannot take all memory.
  std::uint64_t memory_limit = std::uint64_t{1} << 30;
  /// Whether a document may name files outside of its folder; a link counts as its target. Only
  /// regular files are read, no pipes and no devices.
  bool allow_outside = true;
};

/// Reads .obj (with .mtl), .ply, .stl, .off, .gltf, .glb or .npy (by extension, any case). A PLY
/// file without faces becomes points, or lines along its edges; glTF and OBJ files may have points
/// and lines beside meshes. docs/read_files.md lists what is drawn of each format. Vertices with
/// non-finite coordinates are kept (the renderer drops and counts their triangles); degenerate
/// triangles keep their numbers. Normals are the file's or none. Throws Error{not_found |
/// bad_format | unsupported | io | out_of_memory} naming the file and the place in it; io also if
/// the file becomes shorter meanwhile.
[[nodiscard]] Scene read_scene(PathView file, const ReadOptions& options = {});

/// Reads a scene from memory. `format`: obj, ply, stl, off, gltf or glb, with or without a dot.
/// `name` appears in errors; textures and other files are looked for beside it.
[[nodiscard]] Scene decode_scene(std::span<const std::byte> bytes, std::string_view format,
                                 PathView name, const ReadOptions& options = {});
/// The extensions that read_scene knows, without dots.
[[nodiscard]] std::vector<std::string_view> scene_formats();

/// Decodes a PNG, a JPEG or, where the library was built with libwebp, a WebP (by its first bytes),
/// from a file or from memory; `name` appears in errors.
[[nodiscard]] Image<Rgba8> read_image(PathView file, const ReadOptions& options = {});
[[nodiscard]] Image<Rgba8> decode_image(std::span<const std::byte> bytes, const std::string& name,
                                        const ReadOptions& options = {});

/// Reads a picture as linear light, for an Environment: Radiance's .hdr (divided by its EXPOSURE),
/// OpenEXR (R, G and B, or Y), PNG or JPEG as sRGB, by the first bytes. Throws as read_image.
[[nodiscard]] Image<Vec3> read_light(PathView file, const ReadOptions& options = {});
[[nodiscard]] Image<Vec3> decode_light(std::span<const std::byte> bytes, const std::string& name,
                                       const ReadOptions& options = {});

/// Writes a PNG. `threads` (0: all) compress bands of 128 KiB side by side; the file is the same
/// for every number. Cost: about 5 ms of one core per megabyte of pixels.
/// This and the writers below write to a temporary name beside `file` and rename it, so that a file
/// is whole or absent. They throw Error{io} naming the file, and Error{invalid_argument} for an
/// empty image or rows that overlap.
void write_png(PathView file, ImageView<const Rgba8> image, int threads = 1);
/// Writes premultiplied RGBA in float32: an RGBA EXR (32 bit), or NPY of shape (H, W, 4).
void write_exr(PathView file, ImageView<const Vec4> image);
void write_npy(PathView file, ImageView<const Vec4> image);
/// Writes x, y, z in float32: EXR channels X, Y and Z, or NPY of shape (H, W, 3); x, y: (H, W, 2).
void write_exr(PathView file, ImageView<const Vec3> image);
void write_npy(PathView file, ImageView<const Vec3> image);
void write_npy(PathView file, ImageView<const Vec2> image);
/// Writes one channel: EXR channel "Z", or NPY of shape (H, W).
void write_exr(PathView file, ImageView<const float> image);
void write_npy(PathView file, ImageView<const float> image);
void write_npy(PathView file, ImageView<const std::int64_t> image);
void write_npy(PathView file, ImageView<const std::int32_t> image);

/// Writes a binary little-endian PLY: positions (double if there are wide ones), faces, and the
/// normals, texture coordinates and colours that share the positions' indices (those with indices
/// of their own are left out). Scalars of vertices and faces become doubles of their names (a blank
/// in one is written _). Throws Error{invalid_argument} for an index out of range or fewer values
/// than positions or faces.
void write_ply(PathView file, const Mesh& mesh);
/// Writes points: a PLY without faces.
void write_ply(PathView file, const Points& points);

/// This and the next functions write into a file that the caller has begun and commits: together
/// with others, or to standard output.
void write_png(AtomicFile& out, ImageView<const Rgba8> image, int threads = 1);
void write_exr(AtomicFile& out, ImageView<const Vec4> image);
void write_npy(AtomicFile& out, ImageView<const Vec4> image);
void write_exr(AtomicFile& out, ImageView<const Vec3> image);
void write_npy(AtomicFile& out, ImageView<const Vec3> image);
void write_npy(AtomicFile& out, ImageView<const Vec2> image);
void write_exr(AtomicFile& out, ImageView<const float> image);
void write_npy(AtomicFile& out, ImageView<const float> image);
void write_npy(AtomicFile& out, ImageView<const std::int64_t> image);
void write_npy(AtomicFile& out, ImageView<const std::int32_t> image);
void write_ply(AtomicFile& out, const Mesh& mesh);
void write_ply(AtomicFile& out, const Points& points);

// A file is whole or absent: it is written under a temporary name in the same directory and
// renamed. Several become visible together: all are written before the first is renamed.

/// Chooses standard output in the place of a file.
struct StandardOutput {};

/// A file that is seen from commit() on; without it the destructor removes the temporary. A
/// symbolic link is followed, also to a file that is not there yet. A replaced file passes its mode
/// and, if permitted, its owner to the new one; a read-only file is not replaced. An existing
/// target that is not a regular file (a device) is written directly. Pipes and standard output get
/// their bytes at commit(), so nothing is sent before all is written. Every member throws Error{io}
/// naming the file.
class AtomicFile {
 public:
  explicit AtomicFile(PathView file);
  explicit AtomicFile(StandardOutput);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The open stream, which can seek. Its errors need no check: commit() finds them.
  [[nodiscard]] std::FILE* stream();
  void write(const void* data, std::size_t size);
  void commit();
  /// Finishes all files, sends those for pipes, then renames the temporaries: if one of them cannot
  /// be finished, none is seen.
  static void commit(std::span<AtomicFile* const> files);
  /// Throws Error{io} for a failure seen elsewhere; `what` is the reason.
  [[noreturn]] void fail(const char* what) const;
  /// The name as the caller gave it, for messages.
  [[nodiscard]] const std::string& name() const;

 private:
  struct RASTRUM_INSIDE Impl;
  Owner<Impl> impl_;
};

/// Writes a picture whose rows come in bands, from the top, and need not be there together: byte
/// for byte the file of the functions above. Each add() has the next rows, all of one kind: Rgba8
/// for PNG; Vec4, Vec3 or float for EXR and NPY; Vec2, int64 or int32 for NPY. `threads` as for
/// write_png. All members throw Error{io} naming the file, and Error{invalid_argument} for other
/// pixels, more rows or fewer. A PNG takes memory meanwhile: b, and 8 b for each thread, with b =
/// 128 KiB or a row, whichever is more.
class PictureRows {
 public:
  enum class Format : std::uint8_t { png, exr, npy };
  /// `out` must outlive this; the caller commits it after finish().
  PictureRows(AtomicFile& out, Format format, int width, int height, int threads = 1);
  PictureRows(PictureRows&&) noexcept;
  ~PictureRows();
  void add(ImageView<const Rgba8> rows);
  void add(ImageView<const Vec4> rows);
  void add(ImageView<const Vec3> rows);
  void add(ImageView<const Vec2> rows);
  void add(ImageView<const float> rows);
  void add(ImageView<const std::int64_t> rows);
  void add(ImageView<const std::int32_t> rows);
  /// To be called after the last row.
  void finish();

 private:
  struct RASTRUM_INSIDE Impl;
  Held<Owner<Impl>> impl_;
};

/// For a program that ends without its destructors, by a signal or MPI_Abort: removes the
/// temporaries of all unfinished files, and blocks every thread that begins or commits one from
/// then on, so that no half-written file stays. Call it from a thread, not from a signal handler,
/// and end the process next: it cannot be undone.
void abandon_files() noexcept;

/// Removes the temporaries in `folder` that killed writers of this host have left. It leaves those
/// of living writers, which are locked; those of other hosts, by their names, because not every
/// network file system shows the locks; all of them on file systems without locks; and those that
/// cannot be removed. O(names in the folder).
void remove_abandoned(PathView folder);

// The text that `rastrum info FILE` prints.

/// Describes a scene in several lines: meshes with their vertices and triangles, instances, bounds,
/// materials, textures, cameras, animations; how many triangles have a vertex that is not finite
/// (the renderer drops them) or no area; the warnings. O(triangles of all instances). Throws
/// Error{invalid_argument} for an index out of range.
[[nodiscard]] std::string describe(const Scene& scene);

// Height maps from files.

/// A grid of heights. Row 0 is at the top (north), columns go east.
struct HeightGrid {
  Image<float> heights{};  ///< as the file has them; NaN where it has none
  /// Units of `heights` that are as long as one cell is wide. Multiplying by 1 / units_per_cell
  /// gives the terrain its true proportions (DEM, GeoTIFF), or 16-bit values the range of 8-bit
  /// ones (257), which is that of the classic maps.
  double units_per_cell = 1;
  /// Whether `units_per_cell` is known: from the file (DEM, GeoTIFF), or because heights have 8
  /// bits, where a unit has been a cell since Voxel Space. Else it is a guess.
  bool scale_known = false;
};

/// Whether a height map of that name ends at its edge (.dem, .tif, .tiff; any case), so that
/// Tiling::none suits it. Other maps go on beyond their edges.
[[nodiscard]] bool ends_at_edge(PathView file);

/// Properties of a raw file, which has no header.
struct RawSize {
  int width = 0, height = 0;  ///< width 0: square
  bool big_endian = false;
};

/// Reads heights from, by extension in any case:
///   .png            8 or 16-bit grey (colour only where red = green = blue), 0 to 255 or 65,535;
///                   a hole where alpha is 0
///   .raw .bin .r16  uint16, no header, as `raw` says
///   .npy            shape (H, W): float32/64, int or uint of 8, 16 or 32 bits, any byte order
///   .dem            USGS DEM, the ASCII format of 1024-byte records
///   .tif .tiff      GeoTIFF, where the library was built with GDAL: the first band, with its scale
///                   and offset, north up
/// Up to 32,768 × 32,768. Throws Error{not_found | bad_format | unsupported | io | out_of_memory}
/// that names the file and the place in it. Cost: one pass over the file.
[[nodiscard]] HeightGrid read_heights(PathView file, RawSize raw = {},
                                      const ReadOptions& options = {});

/// Reads heights from memory, but no GeoTIFF. `format`: an extension, any case, with or without its
/// dot; `name` appears in errors.
[[nodiscard]] HeightGrid decode_heights(std::span<const std::byte> bytes, std::string_view format,
                                        const std::string& name, RawSize raw = {},
                                        const ReadOptions& options = {});

}  // namespace io
}  // namespace rastrum
