// SPDX-License-Identifier: BSD-3-Clause
// Colours of OpenEXR files, as linear light. Without the library an error says what to install.
#include <string>

#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>

#ifdef RASTRUM_HAS_OPENEXR
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>

#include <cstring>
#include <exception>
#include <stdexcept>
#include <utility>
#endif

namespace rastrum::io {
#ifdef RASTRUM_HAS_OPENEXR
namespace {

class Stream final : public Imf::IStream {
 public:
  Stream(Bytes bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}
  bool read(char to[], int n) override {
    const auto count = static_cast<std::size_t>(n);
    if (n < 0 || count > bytes_.size() - at_) throw std::runtime_error("it ends too early");
    std::memcpy(to, bytes_.data() + at_, count);
    at_ += count;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override {
    if (at > bytes_.size()) throw std::runtime_error("it points beyond its end");
    at_ = at;
  }

 private:
  Bytes bytes_;
  std::uint64_t at_ = 0;
};

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw Error(Errc::unsupported, name + ": " + what);
}

std::pair<int, int> size_of(const Imf::Header& header, std::size_t bytes, const std::string& name) {
  const Imath::Box2i& data = header.dataWindow();
  if (!(data == header.displayWindow()))
    refuse(name, "its data window is not its display window; write the whole picture");
  const auto w = std::int64_t{data.max.x} - data.min.x + 1;
  const auto h = std::int64_t{data.max.y} - data.min.y + 1;
  if (w < 1 || h < 1 || w > kMaxImageSize || h > kMaxImageSize)
    refuse(name, "its size " + std::to_string(w) + "x" + std::to_string(h) +
                     " is outside 1x1 to 32768x32768");
  // No compression packs more than some thousand bytes into one.
  if (static_cast<std::size_t>(w * h) / 2048 > bytes)
    throw Error(Errc::bad_format, name + ": is too short for its size");
  return {static_cast<int>(w), static_cast<int>(h)};
}

Image<Vec3> read(Bytes bytes, const std::string& name, Budget& budget) {
  Stream stream(bytes, name);
  Imf::InputFile exr(stream);
  const Imf::Header& header = exr.header();
  const auto [width, height] = size_of(header, bytes.size(), name);
  const Imf::ChannelList& channels = header.channels();
  const auto has = [&](const char* channel) { return channels.findChannel(channel) != nullptr; };
  const bool grey = !has("R") && has("Y") && !has("X");  // X, Y and Z are positions
  const char* names[3] = {"R", "G", "B"};
  for (const char*& channel : names) {
    if (grey) channel = "Y";
    const Imf::Channel* const found = channels.findChannel(channel);
    if (found == nullptr) refuse(name, std::string("has no channel ") + channel);
    if (found->xSampling != 1 || found->ySampling != 1)
      refuse(name, std::string("its channel ") + channel + " is not there for every pixel");
  }
  if (grey && channels.findChannel("RY") != nullptr)
    refuse(name, "has luminance and chroma; write R, G and B");
  if (Imf::hasEnvmap(header) && Imf::envmap(header) != Imf::ENVMAP_LATLONG)
    refuse(name, "is a cube; write a picture by latitude and longitude");
  Image<Vec3> image = budget.image<Vec3>(width, height);
  // The library counts from the data window's corner.
  const Imath::V2i corner = header.dataWindow().min;
  const auto row_bytes = static_cast<std::ptrdiff_t>(sizeof(Vec3)) * width;
  char* const base = reinterpret_cast<char*>(image.view().data) -
                     static_cast<std::ptrdiff_t>(sizeof(Vec3)) * corner.x - row_bytes * corner.y;
  Imf::FrameBuffer frame;
  if (grey) {
    frame.insert("Y",
                 Imf::Slice(Imf::FLOAT, base, sizeof(Vec3), static_cast<std::size_t>(row_bytes)));
  } else {
    for (std::size_t c = 0; c < 3; ++c)
      frame.insert(names[c], Imf::Slice(Imf::FLOAT, base + c * sizeof(float), sizeof(Vec3),
                                        static_cast<std::size_t>(row_bytes)));
  }
  exr.setFrameBuffer(frame);
  exr.readPixels(header.dataWindow().min.y, header.dataWindow().max.y);
  if (grey)
    for (Vec3& c : image.pixels()) c = {c.x, c.x, c.x};
  return image;
}

}  // namespace

Image<Vec3> decode_exr(Bytes bytes, const std::string& name, Budget& budget) {
  try {
    return read(bytes, name, budget);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(Errc::bad_format, name + ": is not a valid OpenEXR file: " + e.what());
  }
}

#else
Image<Vec3> decode_exr(Bytes, const std::string& name, Budget&) {
  throw Error(Errc::unsupported, name +
                                     ": this build of Rastrum has no OpenEXR; install it (Debian: "
                                     "libopenexr-dev) and build again, or take .hdr");
}
#endif

}  // namespace rastrum::io
