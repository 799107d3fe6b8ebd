// NPY 1.0 (numpy.lib.format): a magic, a Python dictionary padded so that the data start at a
// multiple of 64 bytes, the rows.
#include <bit>
#include <string>

#include <rastrum/io.hpp>

namespace rastrum::io {
namespace {

template <class T>
void write(AtomicFile& out, ImageView<const T> image, const char* type, const char* inner) {
  if (image.empty() || image.width < 1 || image.height < 1)
    throw Error(Errc::invalid_argument, out.name().string() + ": an empty image cannot be written");
  check_stride(image, out.name().string());
  std::string header = std::string("{'descr': '") +
                       (std::endian::native == std::endian::little ? '<' : '>') + type +
                       "', 'fortran_order': False, 'shape': (" + std::to_string(image.height) +
                       ", " + std::to_string(image.width) + inner + "), }";
  constexpr std::size_t kPrefix = 10;
  header.append(63 - (kPrefix + header.size()) % 64, ' ').push_back('\n');
  const char prefix[kPrefix] = {'\x93',
                                'N',
                                'U',
                                'M',
                                'P',
                                'Y',
                                1,
                                0,
                                static_cast<char>(header.size() & 0xFF),
                                static_cast<char>(header.size() >> 8)};
  out.write(prefix, sizeof prefix);
  out.write(header.data(), header.size());
  for (int y = 0; y < image.height; ++y)
    out.write(image.row(y), static_cast<std::size_t>(image.width) * sizeof(T));
}

}  // namespace

void write_npy(AtomicFile& out, ImageView<const Vec4> image) {
  write(out, image, "f4", ", 4");
}

void write_npy(AtomicFile& out, ImageView<const Vec3> image) {
  write(out, image, "f4", ", 3");
}

void write_npy(AtomicFile& out, ImageView<const Vec2> image) {
  write(out, image, "f4", ", 2");
}

void write_npy(AtomicFile& out, ImageView<const float> image) {
  write(out, image, "f4", "");
}

void write_npy(AtomicFile& out, ImageView<const std::int64_t> image) {
  write(out, image, "i8", "");
}

void write_npy(AtomicFile& out, ImageView<const std::int32_t> image) {
  write(out, image, "i4", "");
}

}  // namespace rastrum::io
