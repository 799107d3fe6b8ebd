// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/shade/texture.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <utility>

#include <rastrum/raster/rules/srgb.hpp>

namespace rastrum::raster {
namespace {

constexpr std::size_t kRowGrain = 16;
constexpr std::size_t kFingerprintTexels = 509;

/// FNV-1a over evenly spread texels.
std::uint64_t fingerprint(std::span<const Rgba8> texels) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const std::size_t n = std::min(texels.size(), kFingerprintTexels);
  for (std::size_t i = 0; i < n; ++i) {
    const Rgba8 t = texels[i * texels.size() / n];
    for (const std::uint8_t byte : {t.r, t.g, t.b, t.a}) hash = (hash ^ byte) * 0x100000001b3U;
  }
  return hash;
}

/// The texels of one axis under texel `i` of the next level, and their weights.
struct Footprint {
  std::int32_t first = 0;
  int count = 0;
  float weight[3] = {};
};

Footprint footprint(std::int32_t i, std::int32_t size, std::int32_t next) {
  if (size == 1) return {0, 1, {1, 0, 0}};
  if (size % 2 == 0) return {2 * i, 2, {0.5F, 0.5F, 0}};
  // size = 2 next + 1: each texel covers size / next = 2 + 1 / next.
  const float whole = static_cast<float>(next) / static_cast<float>(size);
  const auto part = [&](std::int32_t k) {
    return whole * static_cast<float>(k) / static_cast<float>(next);
  };
  return {2 * i, 3, {part(next - i), whole, part(i + 1)}};
}

/// To 0 … 255; ties to even, because half of the means of two codes are ties, and rounding those up
/// would brighten each level.
std::uint8_t nearest_code(float mean) {
  constexpr float kOnes = 0x1.8p23F;  // from here on floats are whole numbers
  return static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(mean + kOnes) & 0xFFU);
}

template <TexelUse kUse>
void reduce_row(const MipLevel& from, std::int32_t next_width, std::int32_t next_height,
                std::int32_t y, Rgba8* out) {
  constexpr bool kColor = kUse == TexelUse::color;
  const std::array<float, 256>& linear = decode_tables().srgb;
  const auto value = [&](std::uint8_t code) {
    return kColor ? linear[code] : static_cast<float>(code);
  };
  const SrgbCodes& codes = srgb_codes();
  const auto encode = [&](float c) { return kColor ? codes(c) : nearest_code(c); };
  const Footprint rows = footprint(y, from.height, next_height);
  if (from.width % 2 == 0 && from.height % 2 == 0) {
    // Four texels of equal weight; as a power of 2 it changes no bit of their sum.
    const Rgba8* const top = from.texels + static_cast<std::ptrdiff_t>(2 * y) * from.width;
    const Rgba8* const bottom = top + from.width;
    for (std::int32_t x = 0; x < next_width; ++x) {
      const Rgba8 p = top[2 * x], q = top[2 * x + 1], s = bottom[2 * x], t = bottom[2 * x + 1];
      const auto mean = [](float a, float b, float c, float d) { return 0.25F * (a + b + c + d); };
      const auto alpha = [](std::uint8_t code) { return static_cast<float>(code); };
      out[x] = {encode(mean(value(p.r), value(q.r), value(s.r), value(t.r))),
                encode(mean(value(p.g), value(q.g), value(s.g), value(t.g))),
                encode(mean(value(p.b), value(q.b), value(s.b), value(t.b))),
                nearest_code(mean(alpha(p.a), alpha(q.a), alpha(s.a), alpha(t.a)))};
    }
    return;
  }
  for (std::int32_t x = 0; x < next_width; ++x) {
    const Footprint columns = footprint(x, from.width, next_width);
    float r = 0, g = 0, b = 0, a = 0;
    for (int j = 0; j < rows.count; ++j) {
      const Rgba8* const row =
          from.texels + static_cast<std::ptrdiff_t>(rows.first + j) * from.width + columns.first;
      for (int i = 0; i < columns.count; ++i) {
        const float w = rows.weight[j] * columns.weight[i];
        r += w * value(row[i].r);
        g += w * value(row[i].g);
        b += w * value(row[i].b);
        a += w * static_cast<float>(row[i].a);
      }
    }
    out[x] = {encode(r), encode(g), encode(b), nearest_code(a)};
  }
}

void reduce(const MipLevel& from, TexelUse use, std::int32_t width, std::int32_t height, Rgba8* out,
            parallel::Threads* exec) {
  const auto row = [&](std::size_t y) {
    const auto row_y = static_cast<std::int32_t>(y);
    Rgba8* const to = out + y * static_cast<std::size_t>(width);
    if (use == TexelUse::color)
      reduce_row<TexelUse::color>(from, width, height, row_y, to);
    else
      reduce_row<TexelUse::data>(from, width, height, row_y, to);
  };
  if (exec != nullptr) {
    parallel::for_each_index(*exec, static_cast<std::size_t>(height), row, kRowGrain);
  } else {
    parallel::Serial serial;
    parallel::for_each_index(serial, static_cast<std::size_t>(height), row);
  }
}

}  // namespace

struct TextureSet::Chain {
  explicit Chain(MemoryAccount& memory) : texels(memory) {}
  ScratchBuffer<Rgba8> texels;  ///< levels 1 and up, in sequence
  MipChain chain;

  void build(const Texture& texture, TexelUse use, parallel::Threads* exec) {
    static std::atomic<std::uint64_t> number = 0;
    chain.number = ++number;
    const Image<Rgba8>& image = texture.image;
    const DecodeTables& tables = decode_tables();
    chain.use = use;
    chain.decode = (use == TexelUse::color ? tables.srgb : tables.unorm).data();
    MipLevel level{image.pixels().data(), image.width(), image.height()};
    chain.level[0] = level;
    chain.levels = 1;
    if (!texture.mipmaps) return;
    std::size_t sum = 0;
    for (std::int32_t w = level.width, h = level.height; w > 1 || h > 1; ++chain.levels) {
      w = std::max(1, w / 2);
      h = std::max(1, h / 2);
      sum += static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    }
    texels.reserve(sum);
    Rgba8* out = texels.data();
    for (int i = 1; i < chain.levels; ++i) {
      const std::int32_t w = std::max(1, level.width / 2);
      const std::int32_t h = std::max(1, level.height / 2);
      reduce(level, use, w, h, out, exec);
      level = {out, w, h};
      chain.level[i] = level;
      out += static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    }
  }
};

struct TextureSet::Entry {
  const Rgba8* pixels = nullptr;
  int width = 0, height = 0;
  std::uint64_t mark = 0;
  bool mipmaps = false;
  std::unique_ptr<Chain> color, data;
};

TextureSet::TextureSet(MemoryAccount& memory) : memory_(memory) {}
TextureSet::~TextureSet() = default;

void TextureSet::update(std::span<const Texture> textures, std::span<const std::uint8_t> uses,
                        parallel::Threads* exec) {
  entries_.resize(textures.size());
  for (std::size_t i = 0; i < textures.size(); ++i) {
    Entry& entry = entries_[i];
    const Texture& texture = textures[i];
    if (uses[i] == 0 || texture.image.empty()) {
      entry = {};
      continue;
    }
    const std::span<const Rgba8> pixels = texture.image.pixels();
    const std::uint64_t mark = fingerprint(pixels);
    if (entry.pixels != pixels.data() || entry.width != texture.image.width() ||
        entry.height != texture.image.height() || entry.mark != mark ||
        entry.mipmaps != texture.mipmaps)
      entry = {pixels.data(), texture.image.width(), texture.image.height(),
               mark,          texture.mipmaps,       nullptr,
               nullptr};
    for (const auto& [use, chain] :
         {std::pair{TexelUse::color, &entry.color}, std::pair{TexelUse::data, &entry.data}}) {
      if ((uses[i] & static_cast<std::uint8_t>(use)) == 0) {
        chain->reset();
        continue;
      }
      if (*chain == nullptr) {
        auto made = std::make_unique<Chain>(memory_);
        made->build(texture, use, exec);
        *chain = std::move(made);
        ++builds_;
      }
      MipChain& c = (*chain)->chain;
      c.wrap_u = texture.wrap_u;
      c.wrap_v = texture.wrap_v;
      c.mag = texture.mag;
      c.min = texture.min;
    }
  }
}

std::uint64_t TextureSet::bytes() const noexcept {
  std::uint64_t sum = 0;
  for (const Entry& entry : entries_)
    for (const Chain* chain : {entry.color.get(), entry.data.get()})
      if (chain != nullptr) sum += chain->texels.capacity() * sizeof(Rgba8);
  return sum;
}

const MipChain* TextureSet::find(std::int32_t texture, TexelUse use) const noexcept {
  if (texture < 0 || static_cast<std::size_t>(texture) >= entries_.size()) return nullptr;
  const Entry& entry = entries_[static_cast<std::size_t>(texture)];
  const auto& chain = use == TexelUse::color ? entry.color : entry.data;
  return chain == nullptr ? nullptr : &chain->chain;
}

}  // namespace rastrum::raster
