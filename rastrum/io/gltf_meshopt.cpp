// SPDX-License-Identifier: BSD-3-Clause
// EXT_meshopt_compression: buffer views packed by meshoptimizer. Without the library they are
// refused with what to install.
#include <cstddef>
#include <string>

#include <rastrum/io/gltf_internal.hpp>

#ifdef RASTRUM_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace rastrum::io::gltf {
namespace {

/// Most bytes from one: the codec of attributes keeps at least a bit for eight bytes.
constexpr std::size_t kMostUnpacked = 64;

}  // namespace

void check_meshopt(const Json& view, const Json& extension) {
  const std::size_t count = extension["count"].count();
  const std::size_t stride = extension["byteStride"].count();
  const std::size_t length = view["byteLength"].count();
  const auto fail_stride = [&](const std::string& what) {
    extension["byteStride"].fail("must be " + what);
  };
  const std::string& mode = extension["mode"].string();
  const std::string filter = extension.string("filter", "NONE");
  if (mode == "ATTRIBUTES") {
    if (stride == 0 || stride > 256 || stride % 4 != 0)
      fail_stride("a multiple of 4 between 4 and 256");
    if (filter == "OCTAHEDRAL" && stride != 4 && stride != 8) fail_stride("4 or 8");
    if (filter == "QUATERNION" && stride != 8) fail_stride("8");
    if (filter != "NONE" && filter != "OCTAHEDRAL" && filter != "QUATERNION" &&
        filter != "EXPONENTIAL")
      extension["filter"].fail("must be NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL");
  } else if (mode == "TRIANGLES" || mode == "INDICES") {
    if (stride != 2 && stride != 4) fail_stride("2 or 4");
    if (mode == "TRIANGLES" && count % 3 != 0) extension["count"].fail("must be a multiple of 3");
    if (filter != "NONE") extension["filter"].fail("must be NONE unless the mode is ATTRIBUTES");
  } else {
    extension["mode"].fail("must be ATTRIBUTES, TRIANGLES or INDICES");
  }
  if (length % stride != 0 || length / stride != count)
    extension.fail("holds " + std::to_string(count) + " times " + std::to_string(stride) +
                   " bytes, but its view has " + std::to_string(length));
  if (length / kMostUnpacked > extension["byteLength"].count())
    extension.fail("cannot hold " + std::to_string(length) + " bytes in " +
                   std::to_string(extension["byteLength"].count()));
}

#ifdef RASTRUM_HAS_MESHOPTIMIZER

bool has_meshopt() {
  return true;
}

std::vector<std::byte> decode_meshopt(const Json& extension, Bytes packed) {
  const std::size_t count = extension["count"].count();
  const std::size_t stride = extension["byteStride"].count();
  const std::string& mode = extension["mode"].string();
  const std::string filter = extension.string("filter", "NONE");
  const auto* const from = reinterpret_cast<const unsigned char*>(packed.data());
  std::vector<std::byte> bytes(count * stride);
  const int failed =
      mode == "ATTRIBUTES"
          ? meshopt_decodeVertexBuffer(bytes.data(), count, stride, from, packed.size())
      : mode == "TRIANGLES"
          ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, from, packed.size())
          : meshopt_decodeIndexSequence(bytes.data(), count, stride, from, packed.size());
  if (failed != 0) extension.fail("is not a valid stream of " + mode);
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
  return bytes;
}

#else

bool has_meshopt() {
  return false;
}

std::vector<std::byte> decode_meshopt(const Json& extension, Bytes) {
  extension.fail(
      "this rastrum was built without meshoptimizer (Debian: libmeshoptimizer-dev), which unpacks "
      "it",
      Errc::unsupported);
}

#endif

}  // namespace rastrum::io::gltf
