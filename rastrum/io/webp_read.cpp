// SPDX-License-Identifier: BSD-3-Clause
// WebP through libwebp, to straight RGBA8. The library is loaded when first used, as GDAL is
// (height_gdal.cpp), because few files need it.
#include <string>

#include <rastrum/io/parse.hpp>
#include <rastrum/io/reading.hpp>

#ifdef RASTRUM_WEBP_LIBRARY
#include <dlfcn.h>
#include <webp/decode.h>
#endif

namespace rastrum::io {

#ifdef RASTRUM_WEBP_LIBRARY

bool has_webp() {
  return true;
}

Image<Rgba8> decode_webp(Bytes bytes, const std::string& name, Budget& budget) {
  static void* const library = ::dlopen(RASTRUM_WEBP_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  const auto find = [](const char* symbol) {
    return library == nullptr ? nullptr : ::dlsym(library, symbol);
  };
  static const auto features =
      reinterpret_cast<decltype(&WebPGetFeaturesInternal)>(find("WebPGetFeaturesInternal"));
  static const auto decode =
      reinterpret_cast<decltype(&WebPDecodeRGBAInto)>(find("WebPDecodeRGBAInto"));
  if (features == nullptr || decode == nullptr)
    throw Error(Errc::unsupported, name + ": WebP needs " RASTRUM_WEBP_LIBRARY
                                          ", which this machine lacks (Debian: libwebp7)");
  const auto fail = [&](const char* what) {
    throw Error(Errc::bad_format, name + ": is not a valid WebP picture" + what);
  };
  const auto* const from = reinterpret_cast<const std::uint8_t*>(bytes.data());
  WebPBitstreamFeatures has;
  if (features(from, bytes.size(), &has, WEBP_DECODER_ABI_VERSION) != VP8_STATUS_OK) fail("");
  if (has.has_animation != 0)
    throw Error(Errc::unsupported, name + ": is a WebP animation, which is not read");
  // libwebp needs as much again for some kinds of picture.
  Image<Rgba8> image = budget.image<Rgba8>(has.width, has.height, 2 * sizeof(Rgba8));
  const auto pixels = image.pixels();
  if (decode(from, bytes.size(), reinterpret_cast<std::uint8_t*>(pixels.data()),
             pixels.size_bytes(), has.width * 4) == nullptr)
    fail(": its pixels cannot be read");
  return image;
}

#else

bool has_webp() {
  return false;
}

Image<Rgba8> decode_webp(Bytes, const std::string& name, Budget&) {
  throw Error(
      Errc::unsupported,
      name +
          ": is a WebP picture, but this rastrum was built without libwebp (Debian: libwebp-dev)");
}

#endif

}  // namespace rastrum::io
