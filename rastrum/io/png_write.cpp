// SPDX-License-Identifier: BSD-3-Clause
// PNG: 8-bit RGBA, straight alpha. Bands of rows are deflated in parallel, as in pigz: each has the
// last 32 KiB of the one before as its dictionary and ends on a whole byte. The file hardly grows
// (0.1 % of a rendered picture) and does not depend on the number of threads.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include <rastrum/io/rows.hpp>
#include <rastrum/parallel/exec.hpp>

namespace rastrum::io {
namespace {

/// Measured on a rendered and a photographic picture of 1920 × 1080. Level 1 with the filter UP is
/// the fastest that still filters. Level 3 takes 1.5 to 2 times as long for files 6 to 10 %
/// smaller, level 6 4 to 6 times for 15 to 35 %. Choosing SUB or UP in each row takes 1.2 to 1.4
/// times for about 0. No filter is 4 times faster on flat pictures, but photographs grow by half.
constexpr int kLevel = 1;
constexpr unsigned char kFilterUp = 2;

constexpr std::size_t kBandBytes = std::size_t{1} << 17;
constexpr std::size_t kWindow = std::size_t{1} << 15;

std::array<unsigned char, 4> big_endian(std::uint32_t v) {
  return {static_cast<unsigned char>(v >> 24), static_cast<unsigned char>(v >> 16),
          static_cast<unsigned char>(v >> 8), static_cast<unsigned char>(v)};
}

void write_number(AtomicFile& out, std::uint32_t v) {
  out.write(big_endian(v).data(), 4);
}

std::uint32_t checksum(const char (&type)[5], const unsigned char* data, std::size_t size) {
  const uLong begun = crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(type), 4);
  return static_cast<std::uint32_t>(size == 0 ? begun : crc32_z(begun, data, size));
}

void write_chunk(AtomicFile& out, const char (&type)[5], const unsigned char* data,
                 std::size_t size, std::optional<std::uint32_t> crc = {}) {
  write_number(out, static_cast<std::uint32_t>(size));
  out.write(type, 4);
  if (size != 0) out.write(data, size);
  write_number(out, crc ? *crc : checksum(type, data, size));
}

/// Row y as the file has it: its filter, then each byte less the one above.
void filter_row(ImageView<const Rgba8> image, int y, unsigned char* to) {
  const std::size_t n = static_cast<std::size_t>(image.width) * 4;
  const auto* const row = reinterpret_cast<const unsigned char*>(image.row(y));
  *to++ = kFilterUp;
  if (y == 0) {
    std::memcpy(to, row, n);
    return;
  }
  const auto* const above = reinterpret_cast<const unsigned char*>(image.row(y - 1));
  for (std::size_t i = 0; i < n; ++i) to[i] = static_cast<unsigned char>(row[i] - above[i]);
}

/// Rows [first, last), deflated.
class Band {
 public:
  /// `before`: rows before the first, for the dictionary.
  void begin(ImageView<const Rgba8> image, int first, int last, int before) {
    first_ = first;
    last_ = last;
    from_ = std::max(0, first - before);
    const std::size_t row = static_cast<std::size_t>(image.width) * 4 + 1;
    raw_.resize(static_cast<std::size_t>(last - from_) * row);
    // At worst stored blocks with their heads, and the band's end.
    data_.resize(raw_.size() + raw_.size() / 1000 + 1024);
  }

  void deflate(ImageView<const Rgba8> image) noexcept {
    const std::size_t row = static_cast<std::size_t>(image.width) * 4 + 1;
    for (int y = from_; y < last_; ++y)
      filter_row(image, y, raw_.data() + static_cast<std::size_t>(y - from_) * row);
    const std::size_t begin = static_cast<std::size_t>(first_ - from_) * row;
    z_stream z{};
    // Raw, because the file has one header. Memory and strategy are libpng's.
    done_ = deflateInit2(&z, kLevel, Z_DEFLATED, -15, 8, Z_FILTERED) == Z_OK;
    if (!done_) return;
    const std::size_t known = std::min(begin, kWindow);
    if (known != 0) deflateSetDictionary(&z, raw_.data() + begin - known, static_cast<uInt>(known));
    const bool is_first = first_ == 0, is_last = last_ == image.height;
    std::size_t head = 0;
    if (is_first) {  // deflate, 32 KiB, fastest
      data_[head++] = 0x78;
      data_[head++] = 0x01;
    }
    z.next_in = raw_.data() + begin;
    z.avail_in = static_cast<uInt>(raw_.size() - begin);
    z.next_out = data_.data() + head;
    z.avail_out = static_cast<uInt>(data_.size() - head);
    const int said = ::deflate(&z, is_last ? Z_FINISH : Z_SYNC_FLUSH);
    done_ = z.avail_in == 0 && z.avail_out != 0 && said == (is_last ? Z_STREAM_END : Z_OK);
    size_ = data_.size() - z.avail_out;
    deflateEnd(&z);
    crc_ = checksum("IDAT", data_.data(), size_);
    adler_ = adler32_z(adler32_z(0, nullptr, 0), raw_.data() + begin, raw_.size() - begin);
    bytes_ = raw_.size() - begin;
  }

  /// `adler`: of all bands so far.
  void write(AtomicFile& out, uLong& adler) const {
    if (!done_) out.fail("zlib has no memory");
    write_chunk(out, "IDAT", data_.data(), size_, crc_);
    adler = adler32_combine(adler, adler_, static_cast<z_off_t>(bytes_));
  }

 private:
  int first_ = 0, last_ = 0, from_ = 0;
  std::vector<unsigned char> raw_, data_;
  std::size_t size_ = 0, bytes_ = 0;
  std::uint32_t crc_ = 0;
  uLong adler_ = 1;
  bool done_ = false;
};

/// Rows wait until they fill enough bands for all threads. It keeps those that the next band's
/// dictionary and filter need.
class PngRows final : public RowsOf<Rgba8> {
 public:
  PngRows(AtomicFile& out, int width, int height, int threads)
      : out_(out), width_(width), height_(height) {
    const unsigned char signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    out.write(signature, sizeof signature);
    unsigned char head[13] = {};
    std::memcpy(head, big_endian(static_cast<std::uint32_t>(width)).data(), 4);
    std::memcpy(head + 4, big_endian(static_cast<std::uint32_t>(height)).data(), 4);
    head[8] = 8;  // bits
    head[9] = 6;  // RGBA
    write_chunk(out, "IHDR", head, sizeof head);
    const unsigned char perceptual = 0;
    write_chunk(out, "sRGB", &perceptual, 1);

    const std::size_t row = static_cast<std::size_t>(width) * 4 + 1;
    rows_ = static_cast<int>((kBandBytes + row - 1) / row);
    before_ = static_cast<int>((kWindow + row - 1) / row);
    const int count = (height + rows_ - 1) / rows_;
    if (threads != 1 && count > 1) pool_.emplace(threads);
    bands_.resize(static_cast<std::size_t>(std::min(count, pool_ ? 4 * pool_->concurrency() : 1)));
  }

  void add(ImageView<const Rgba8> rows) override {
    const int turn = rows_ * static_cast<int>(bands_.size());
    for (int y = 0; y < rows.height;) {
      const int n = std::min(rows.height - y, done_ + turn - end());
      for (const int last = y + n; y < last; ++y)
        kept_.insert(kept_.end(), rows.row(y), rows.row(y) + width_);
      if (end() == std::min(done_ + turn, height_)) deflate();
    }
  }

  void finish() override {
    write_chunk(out_, "IDAT", big_endian(static_cast<std::uint32_t>(adler_)).data(), 4);
    write_chunk(out_, "IEND", nullptr, 0);
  }

 private:
  [[nodiscard]] int end() const {
    return first_ + static_cast<int>(kept_.size() / static_cast<std::size_t>(width_));
  }

  void deflate() {
    const ImageView<const Rgba8> image{kept_.data() - static_cast<std::ptrdiff_t>(first_) * width_,
                                       width_, height_, width_};
    const int last = end();
    const auto n = static_cast<std::size_t>((last - done_ + rows_ - 1) / rows_);
    for (std::size_t i = 0; i < n; ++i) {
      const int first = done_ + static_cast<int>(i) * rows_;
      bands_[i].begin(image, first, std::min(first + rows_, last), before_);
    }
    if (pool_)
      parallel::for_each_index(*pool_, n, [&](std::size_t i) { bands_[i].deflate(image); });
    else
      bands_[0].deflate(image);
    for (std::size_t i = 0; i < n; ++i) bands_[i].write(out_, adler_);
    done_ = last;
    const int keep = std::max(first_, last - before_ - 1);
    kept_.erase(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(keep - first_) * width_);
    first_ = keep;
  }

  AtomicFile& out_;
  int width_, height_;
  int rows_ = 0, before_ = 0;  ///< of a band; those before it for its dictionary
  int done_ = 0;               ///< rows that are deflated
  int first_ = 0;              ///< of kept_
  std::vector<Rgba8> kept_;    ///< rows
  std::optional<parallel::Threads> pool_;
  std::vector<Band> bands_;
  uLong adler_ = 1;
};

}  // namespace

std::unique_ptr<RowsOf<Rgba8>> png_rows(AtomicFile& out, int width, int height, int threads) {
  return std::make_unique<PngRows>(out, width, height, threads);
}

void write_png(AtomicFile& out, ImageView<const Rgba8> image, int threads) {
  write_whole(out, image, [&](AtomicFile& to, int width, int height) {
    return png_rows(to, width, height, threads);
  });
}

}  // namespace rastrum::io
