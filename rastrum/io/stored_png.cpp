// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/io/stored_png.hpp>

#include <libdeflate.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>

#include <rastrum/io.hpp>
#include <rastrum/io/mapped_file.hpp>

namespace rastrum::io {
namespace {

std::uint32_t number_at(Bytes bytes, std::size_t at) {
  return load<std::uint32_t>(bytes.data() + at, kLittleEndian);
}
void write_number(std::byte* to, std::uint32_t n) {
  for (int i = 0; i < 4; ++i) to[i] = static_cast<std::byte>(n >> (24 - 8 * i));
}
std::uint32_t crc(std::uint32_t of_before, Bytes bytes) {
  return libdeflate_crc32(of_before, bytes.data(), bytes.size());
}

/// Bytes of all rows with their filter bytes; none unless the header is of a picture without
/// interlacing.
std::optional<std::size_t> row_bytes(Bytes file) {
  constexpr std::size_t kHeaderEnd = 8 + 8 + 13 + 4;
  constexpr unsigned char kSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  if (file.size() < kHeaderEnd || std::memcmp(file.data(), kSignature, 8) != 0 ||
      number_at(file, 8) != 13 || as_text(file).substr(12, 4) != "IHDR")
    return {};
  const std::uint64_t width = number_at(file, 16), height = number_at(file, 20);
  const auto byte_at = [&](std::size_t i) { return std::to_integer<std::size_t>(file[i]); };
  const std::size_t bits = byte_at(24), type = byte_at(25);
  const bool is_interlaced = byte_at(28) != 0;
  constexpr std::size_t kChannels[] = {1, 0, 3, 1, 2, 0, 4};
  if (width == 0 || height == 0 || width > kMaxImageSize || height > kMaxImageSize || bits > 16 ||
      type > 6 || is_interlaced)
    return {};
  return ((width * bits * kChannels[type] + 7) / 8 + 1) * height;
}

struct Chunks {
  std::size_t begin, end;         ///< of all IDATs
  std::vector<std::byte> joined;  ///< their data, if they are several
  Bytes data;
};
/// The IDATs of a file, if they are whole and consecutive.
std::optional<Chunks> picture_chunks(Bytes file) {
  Chunks found{};
  std::vector<Bytes> data;
  for (std::size_t at = 8; file.size() - at >= 12;) {
    const std::size_t n = number_at(file, at);
    if (n > file.size() - at - 12) return {};
    const bool is_picture = as_text(file).substr(at + 4, 4) == "IDAT";
    if (is_picture) {
      if (crc(0, file.subspan(at + 4, n + 4)) != number_at(file, at + 8 + n)) return {};
      if (data.empty()) found.begin = at;
      data.push_back(file.subspan(at + 8, n));
      found.end = at + n + 12;
    } else if (!data.empty()) {
      break;
    }
    at += n + 12;
  }
  if (data.empty()) return {};
  if (data.size() > 1) {
    std::size_t bytes = 0;
    for (const Bytes& d : data) bytes += d.size();
    found.joined.reserve(bytes);
    for (const Bytes& d : data) found.joined.insert(found.joined.end(), d.begin(), d.end());
  }
  found.data = data.size() > 1 ? Bytes(found.joined) : data.front();
  return found;
}

/// Accepts nothing that zlib would refuse.
bool inflate(Bytes stream, std::span<std::byte> to) {
  // libdeflate does not check the window size that a stream promises.
  constexpr unsigned kFarthest = 0x78;
  if (stream.empty() || std::to_integer<unsigned>(stream[0]) != kFarthest) return false;
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>
      decompressor(libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  std::size_t taken = 0, made = 0;
  return decompressor != nullptr &&
         libdeflate_zlib_decompress_ex(decompressor.get(), stream.data(), stream.size(), to.data(),
                                       to.size(), &taken, &made) == LIBDEFLATE_SUCCESS &&
         taken == stream.size() && made == to.size();
}

}  // namespace

StoredPng::StoredPng(Bytes file) {
  store(file);
  if (parts_.empty()) parts_.push_back(file);
}

void StoredPng::store(Bytes file) {
  constexpr std::size_t kBlock = 65535, kMostRows = std::size_t{1} << 28;
  const std::optional<std::size_t> size = row_bytes(file);
  // Deflate makes at most 1,032 bytes of one, so small files cannot ask for much memory.
  if (!size || *size > kMostRows || *size / 1032 > file.size()) return;
  const std::optional<Chunks> chunks = picture_chunks(file);
  if (!chunks) return;
  rows_ = std::make_unique_for_overwrite<std::byte[]>(*size);
  const std::span rows(rows_.get(), *size);
  if (!inflate(chunks->data, rows)) return rows_.reset();

  const std::size_t blocks = (*size + kBlock - 1) / kBlock;
  const std::size_t length = 2 + 5 * blocks + *size + 4;
  write_number(head_.data(), static_cast<std::uint32_t>(length));
  std::memcpy(head_.data() + 4, "IDAT\x78\x01", 6);  // deflate, 32 KiB, fastest
  parts_.push_back(file.first(chunks->begin));
  parts_.push_back(head_);
  block_heads_.resize(blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    const Bytes block = rows.subspan(b * kBlock, std::min(kBlock, *size - b * kBlock));
    const auto n = static_cast<std::uint32_t>(block.size());
    const auto byte = [](std::uint32_t v) { return static_cast<std::byte>(v & 0xFF); };
    block_heads_[b] = {byte(b + 1 == blocks ? 1 : 0), byte(n), byte(n >> 8), byte(~n),
                       byte(~n >> 8)};
    parts_.push_back(block_heads_[b]);
    parts_.push_back(block);
  }
  write_number(end_.data(), libdeflate_adler32(1, rows.data(), rows.size()));
  std::uint32_t sum = crc(0, Bytes(head_).subspan(4));
  for (const Bytes& part : std::span(parts_).subspan(2)) sum = crc(sum, part);
  write_number(end_.data() + 4, crc(sum, Bytes(end_).first(4)));
  parts_.push_back(end_);
  parts_.push_back(file.subspan(chunks->end));
}

}  // namespace rastrum::io
