// OpenEXR, 32-bit float channels. Without the library at build time the functions say what to
// install.
#include <string>

#include <rastrum/io.hpp>

#ifdef RASTRUM_HAS_OPENEXR
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <exception>
#endif

namespace rastrum::io {
#ifdef RASTRUM_HAS_OPENEXR
namespace {

/// OpenEXR seeks back to fill in its table of offsets; so the target must be seekable.
class Stream final : public Imf::OStream {
 public:
  Stream(AtomicFile& file, const std::string& name) : Imf::OStream(name.c_str()), file_(file) {}
  void write(const char c[], int n) override { file_.write(c, static_cast<std::size_t>(n)); }
  std::uint64_t tellp() override {
    const long at = std::ftell(file_.stream());
    if (at < 0) file_.fail("it cannot seek");
    return static_cast<std::uint64_t>(at);
  }
  void seekp(std::uint64_t at) override {
    if (std::fseek(file_.stream(), static_cast<long>(at), SEEK_SET) != 0)
      file_.fail("it cannot seek");
  }

 private:
  AtomicFile& file_;
};

/// `names`: a channel for each float of a pixel, in order.
template <class T, std::size_t N>
void write(AtomicFile& out, ImageView<const T> image, const char* const (&names)[N]) {
  static_assert(sizeof(T) == N * sizeof(float));
  if (image.empty() || image.width < 1 || image.height < 1)
    throw Error(Errc::invalid_argument, out.name().string() + ": an empty image cannot be written");
  check_stride(image, out.name().string());
  try {
    // ZIPS compresses row by row, without loss.
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIPS_COMPRESSION;
    Imf::FrameBuffer frame;
    const auto row_bytes = static_cast<std::size_t>(image.stride) * sizeof(T);
    // The library takes a pointer to non-const and only reads.
    char* const base = const_cast<char*>(reinterpret_cast<const char*>(image.data));
    for (std::size_t c = 0; c < N; ++c) {
      header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
      frame.insert(names[c],
                   Imf::Slice(Imf::FLOAT, base + c * sizeof(float), sizeof(T), row_bytes));
    }
    Stream stream(out, out.name().string());
    Imf::OutputFile exr(stream, header);
    exr.setFrameBuffer(frame);
    exr.writePixels(image.height);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    out.fail(e.what());
  }
}

}  // namespace

void write_exr(AtomicFile& out, ImageView<const Vec4> image) {
  write(out, image, {"R", "G", "B", "A"});
}

void write_exr(AtomicFile& out, ImageView<const Vec3> image) {
  write(out, image, {"X", "Y", "Z"});
}

void write_exr(AtomicFile& out, ImageView<const float> image) {
  write(out, image, {"Z"});
}

#else
namespace {

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw Error(Errc::unsupported, file.string() +
                                     ": this build of Rastrum has no OpenEXR; install it (Debian: "
                                     "libopenexr-dev) and build again, or write .npy");
}

}  // namespace

void write_exr(AtomicFile& out, ImageView<const Vec4>) {
  fail(out.name());
}

void write_exr(AtomicFile& out, ImageView<const Vec3>) {
  fail(out.name());
}

void write_exr(AtomicFile& out, ImageView<const float>) {
  fail(out.name());
}
#endif

}  // namespace rastrum::io
