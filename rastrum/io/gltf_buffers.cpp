// SPDX-License-Identifier: BSD-3-Clause
// Buffers, URIs and accessors of glTF. gltf_check.cpp has checked the document; here files and
// chunks are checked against it.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <string>

#include <rastrum/io/gltf_internal.hpp>

namespace rastrum::io::gltf {
namespace {

std::vector<std::byte> decode_base64(std::string_view text, const Json& where) {
  static constexpr auto kValues = [] {
    std::array<std::int8_t, 256> v{};
    v.fill(-1);
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < kDigits.size(); ++i)
      v[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
    return v;
  }();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    const int v = kValues[static_cast<unsigned char>(c)];
    if (v < 0) where.fail("holds a character that is not base64");
    bits = bits << 6 | static_cast<std::uint32_t>(v);
    have += 6;
    if (have < 8) continue;
    have -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> have & 0xFF));
  }
  return bytes;
}

std::string decode_percent(std::string_view s, const Json& where) {
  std::string r;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const std::string_view digits = s.substr(i + 1, 2);
    const char* const end = digits.data() + 2;
    std::uint8_t byte = 0;
    if (s[i] == '%' && digits.size() == 2 &&
        std::from_chars(digits.data(), end, byte, 16).ptr == end) {
      r += static_cast<char>(byte);
      i += 2;
    } else {
      r += s[i];
    }
  }
  if (r.find('\0') != std::string::npos) where.fail("holds a zero byte");
  return r;
}

static_assert(kLittleEndian, "glTF is little-endian");

float component(const std::byte* p, std::size_t type, bool normalized) {
  return with_component(type, [&](auto v) {
    using T = decltype(v);
    const auto x = static_cast<float>(load<T>(p));
    if (!normalized || type == kFloat) return x;
    return std::max(x / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
  });
}

std::uint32_t unsigned_component(const std::byte* p, std::size_t type) {
  return with_component(type,
                        [&](auto v) { return static_cast<std::uint32_t>(load<decltype(v)>(p)); });
}

}  // namespace

Bytes Buffers::uri(const std::string& uri, const Json& where) {
  const auto [at, is_new] = uris_.try_emplace(uri);
  if (!is_new) return at->second;
  if (uri.rfind("data:", 0) == 0) {
    const auto comma = uri.find(',');
    if (comma == std::string::npos || uri.rfind(";base64", comma) != comma - 7)
      where.fail("is a data URI that is not base64", Errc::unsupported);
    at->second =
        decoded_.emplace_back(decode_base64(std::string_view(uri).substr(comma + 1), where));
  } else {
    const auto colon = uri.find(':');
    if (colon != std::string::npos && colon < uri.find('/'))
      where.fail("is neither a data URI nor a file beside this one: " + uri.substr(0, 100),
                 Errc::unsupported);
    const std::string name = decode_percent(uri, where);
    try {
      at->second = reading_.open(reading_.beside(name));
    } catch (const Error& e) {
      uris_.erase(at);
      where.fail(e.what(), e.code());
    }
  }
  return at->second;
}

std::optional<Bytes> Buffers::buffer(std::size_t index) {
  const auto known = buffers_.find(index);
  if (known != buffers_.end()) return known->second;
  const Json b = document_["buffers"].at(index);
  std::optional<Bytes> bytes;
  if (const auto uri_member = b.get("uri")) {
    bytes = uri(uri_member->string(), *uri_member);
  } else if (index == 0 && glb_chunk_) {
    bytes = glb_chunk_;
  } else {
    warnings.push_back(b.path() + " has no uri; its bytes are taken as zeros");
  }
  const std::size_t size = b["byteLength"].count();
  if (bytes && bytes->size() < size)
    b.fail("should hold " + std::to_string(size) + " bytes, but there are " +
           std::to_string(bytes->size()));
  if (bytes) bytes = bytes->first(size);
  buffers_.emplace(index, bytes);
  return bytes;
}

/// Whether the buffer only stands for data packed elsewhere.
bool Buffers::leaves_out(std::size_t buffer) const {
  const Json b = document_["buffers"].at(buffer);
  const auto extension = b.extension(kMeshopt);
  return (extension && extension->boolean("fallback", false)) || !b.get("uri");
}

std::optional<Bytes> Buffers::view(std::size_t index) {
  const Json v = document_["bufferViews"].at(index);
  const auto extension = v.extension(kMeshopt);
  if (extension && (has_meshopt() || leaves_out(v["buffer"].count()))) {
    const auto known = unpacked_.find(index);
    if (known != unpacked_.end()) return known->second;
    const auto packed = buffer((*extension)["buffer"].count());
    if (!packed) return std::nullopt;
    reading_.budget.take(v["byteLength"].count());
    return unpacked_
        .emplace(index,
                 decode_meshopt(*extension, packed->subspan(extension->count("byteOffset", 0),
                                                            (*extension)["byteLength"].count())))
        .first->second;
  }
  const auto bytes = buffer(v["buffer"].count());
  if (!bytes) return std::nullopt;
  return bytes->subspan(v.count("byteOffset", 0), v["byteLength"].count());
}

bool Buffers::has_bytes(const Json& accessor) {
  const auto v = accessor.get("bufferView");
  return accessor.get("sparse") || (v && view(v->count()));
}

/// `convert(from, to)` makes one element of `components` values from its bytes.
template <class T, class Convert>
std::vector<T> Buffers::elements(const Json& accessor, std::optional<Bytes> packed,
                                 Convert convert) {
  const AccessorType type = accessor_type(accessor);
  const std::size_t count = accessor["count"].count();
  std::optional<Bytes> bytes = packed;
  std::size_t stride = type.element_bytes, offset = 0;
  if (packed) {
    // Packed elements have no gaps.
  } else if (const auto v = accessor.get("bufferView")) {
    bytes = view(v->count());
    offset = accessor.count("byteOffset", 0);
    stride = document_["bufferViews"].at(v->count()).count("byteStride", type.element_bytes);
  }
  reading_.budget.take(count, std::max<std::size_t>(type.components, 1) * sizeof(T));
  std::vector<T> values(count * type.components);
  if (bytes) {
    const std::byte* from = bytes->data() + offset;
    for (std::size_t i = 0; i < count; ++i)
      convert(from + i * stride, &values[i * type.components]);
  }
  const auto sparse = accessor.get("sparse");
  if (!sparse || packed) return values;
  const Json where = (*sparse)["indices"], what = (*sparse)["values"];
  const auto at = view(where["bufferView"].count());
  const auto value = view(what["bufferView"].count());
  const std::size_t n = (*sparse)["count"].count();
  const std::size_t index_bytes = component_bytes(where["componentType"]);
  const std::size_t index_type = where["componentType"].count();
  for (std::size_t k = 0; k < n && at && value; ++k) {
    const std::byte* p = at->data() + where.count("byteOffset", 0) + k * index_bytes;
    const std::size_t i = unsigned_component(p, index_type);
    if (i >= count)
      where.fail("refers to element " + std::to_string(i) + " of " + std::to_string(count));
    convert(value->data() + what.count("byteOffset", 0) + k * type.element_bytes,
            &values[i * type.components]);
  }
  return values;
}

std::vector<float> Buffers::floats(const Json& accessor, std::optional<Bytes> packed) {
  const AccessorType type = accessor_type(accessor);
  const bool normalized = accessor.boolean("normalized", false);
  if (type.component_type == kFloat)
    return elements<float>(accessor, packed, [&](const std::byte* from, float* to) {
      std::memcpy(to, from, type.components * 4);
    });
  return elements<float>(accessor, packed, [&](const std::byte* from, float* to) {
    for (std::size_t c = 0; c < type.components; ++c)
      to[c] = component(from + c * type.component_bytes, type.component_type, normalized);
  });
}

std::vector<std::uint32_t> Buffers::indices(const Json& accessor) {
  const AccessorType type = accessor_type(accessor);
  if (type.components != 1 || !is_unsigned(type.component_type))
    accessor.fail("is read as indices, but is not SCALAR of an unsigned integer");
  return elements<std::uint32_t>(accessor, std::nullopt,
                                 [&](const std::byte* from, std::uint32_t* to) {
                                   *to = unsigned_component(from, type.component_type);
                                 });
}

}  // namespace rastrum::io::gltf
