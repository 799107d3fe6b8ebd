// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/glb.hpp>

#include <rastrum/error.hpp>
#include <rastrum/io/mapped_file.hpp>

namespace rastrum::io {

bool is_glb(Bytes bytes) {
  return as_text(bytes).starts_with("glTF");
}

Glb open_glb(Bytes bytes, const std::string& name) {
  const auto fail = [&](const std::string& what) {
    throw Error(Errc::bad_format, name + ": is not a valid GLB: " + what);
  };
  const auto u32 = [&](std::size_t at) {
    return load_little_endian<std::uint32_t>(bytes.data() + at);
  };
  if (bytes.size() < kGlbHeader) fail("its header is cut off");
  if (const std::uint32_t version = u32(4); version != 2)
    throw Error(Errc::unsupported, name + ": is GLB of version " + std::to_string(version) +
                                       "; only version 2 is read");
  const std::size_t length = u32(8);
  if (length > bytes.size())
    fail("its header says " + std::to_string(length) + " bytes, but there are " +
         std::to_string(bytes.size()));
  Glb glb;
  glb.surplus = bytes.size() - length;
  std::size_t chunks = 0;
  for (std::size_t at = kGlbHeader; at < length; ++chunks) {
    if (length - at < kGlbChunk) fail("a chunk's header is cut off");
    const std::size_t size = u32(at);
    const std::uint32_t type = u32(at + 4);
    at += kGlbChunk;
    if (size > length - at) fail("chunk " + std::to_string(chunks) + " is cut off");
    if (size % 4 != 0) fail("the length of chunk " + std::to_string(chunks) + " is not aligned");
    if ((chunks == 0) != (type == kJsonChunk)) fail("its first chunk, and no other, must be JSON");
    if (type == kBinChunk && chunks != 1) fail("a binary chunk may only be the second");
    if (type == kJsonChunk) glb.text = as_text(bytes.subspan(at, size));
    if (type == kBinChunk) glb.bin = bytes.subspan(at, size);
    at += size;
  }
  if (chunks == 0) fail("it has no chunks");
  return glb;
}

}  // namespace rastrum::io
