// SPDX-License-Identifier: BSD-3-Clause
// OpenEXR, 32-bit float channels. Without the library an error says what to install.
#include <string>

#include <rastrum/io/rows.hpp>

#ifdef RASTRUM_HAS_OPENEXR
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <array>
#include <exception>
#include <optional>
#endif

namespace rastrum::io {
#ifdef RASTRUM_HAS_OPENEXR
namespace {

/// OpenEXR seeks back to fill in its table of offsets, so the target must be seekable.
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

template <class Pixel>
constexpr std::array<const char*, 0> kNames{};
template <>
constexpr std::array<const char*, 4> kNames<Vec4>{"R", "G", "B", "A"};
template <>
constexpr std::array<const char*, 3> kNames<Vec3>{"X", "Y", "Z"};
template <>
constexpr std::array<const char*, 1> kNames<float>{"Z"};

/// ZIPS is lossless and compresses row by row.
template <class Pixel>
Imf::Header header_of(int width, int height) {
  Imf::Header header(width, height);
  header.compression() = Imf::ZIPS_COMPRESSION;
  for (const char* const channel : kNames<Pixel>)
    header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
  return header;
}

/// Calls f(). The library's exceptions become errors of `out`.
template <class F>
void guarded(AtomicFile& out, const F& f) {
  try {
    f();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    out.fail(e.what());
  }
}

template <class Pixel>
class ExrRows final : public RowsOf<Pixel> {
 public:
  ExrRows(AtomicFile& out, int width, int height) : out_(out), stream_(out, out.name()) {
    guarded(out, [&] { exr_.emplace(stream_, header_of<Pixel>(width, height)); });
  }
  void add(ImageView<const Pixel> rows) override {
    guarded(out_, [&] {
      // Rows count from the picture's top. The library takes a non-const pointer but only reads.
      char* const base = const_cast<char*>(
          reinterpret_cast<const char*>(rows.data - exr_->currentScanLine() * rows.stride));
      Imf::FrameBuffer frame;
      for (std::size_t c = 0; c < kNames<Pixel>.size(); ++c)
        frame.insert(kNames<Pixel>[c],
                     Imf::Slice(Imf::FLOAT, base + c * sizeof(float), sizeof(Pixel),
                                static_cast<std::size_t>(rows.stride) * sizeof(Pixel)));
      exr_->setFrameBuffer(frame);
      exr_->writePixels(rows.height);
    });
  }
  void finish() override {
    guarded(out_, [&] { exr_.reset(); });
  }

 private:
  AtomicFile& out_;
  Stream stream_;
  std::optional<Imf::OutputFile> exr_;
};

}  // namespace

template <class Pixel>
std::unique_ptr<RowsOf<Pixel>> exr_rows(AtomicFile& out, int width, int height) {
  return std::make_unique<ExrRows<Pixel>>(out, width, height);
}

#else
template <class Pixel>
std::unique_ptr<RowsOf<Pixel>> exr_rows(AtomicFile& out, int, int) {
  throw Error(Errc::unsupported, out.name() +
                                     ": this build of Rastrum has no OpenEXR; install it (Debian: "
                                     "libopenexr-dev) and build again, or write .npy");
}
#endif

template std::unique_ptr<RowsOf<Vec4>> exr_rows<Vec4>(AtomicFile&, int, int);
template std::unique_ptr<RowsOf<Vec3>> exr_rows<Vec3>(AtomicFile&, int, int);
template std::unique_ptr<RowsOf<float>> exr_rows<float>(AtomicFile&, int, int);

void write_exr(AtomicFile& out, ImageView<const Vec4> image) {
  write_whole(out, image, exr_rows<Vec4>);
}

void write_exr(AtomicFile& out, ImageView<const Vec3> image) {
  write_whole(out, image, exr_rows<Vec3>);
}

void write_exr(AtomicFile& out, ImageView<const float> image) {
  write_whole(out, image, exr_rows<float>);
}

}  // namespace rastrum::io
