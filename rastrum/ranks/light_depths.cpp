// SPDX-License-Identifier: BSD-3-Clause
// Shadows over ranks. A light's picture holds the nearest depth at each pixel, so it is the maximum
// of the ranks' pictures: bit for bit one renderer's, whichever rank holds a part. Each row has an
// owner, which merges it and sends it to all.
#include <algorithm>
#include <cstring>
#include <optional>

#include <rastrum/ranks/parts_frame.hpp>
#include <rastrum/raster/draws/shader_table.hpp>
#include <rastrum/render/shadows.hpp>

namespace rastrum::ranks {
namespace {

/// Rows [first, last) of a picture.
struct Rows {
  std::uint32_t first = 0, last = 0;
};

Rows own_rows(std::size_t r, std::size_t n, int height) {
  const auto rows = static_cast<std::size_t>(height);
  return {static_cast<std::uint32_t>(r * rows / n), static_cast<std::uint32_t>((r + 1) * rows / n)};
}

bool is_empty(ImageView<float> depth, std::uint32_t y) {
  const float* const row = depth.row(static_cast<int>(y));
  return std::all_of(row, row + depth.width, [](float d) { return d == 0; });
}

/// Packs these rows without empty ones at either end.
void put_rows(ImageView<float> depth, Rows rows, Bytes& to) {
  while (rows.first < rows.last && is_empty(depth, rows.first)) ++rows.first;
  while (rows.first < rows.last && is_empty(depth, rows.last - 1)) --rows.last;
  if (rows.first == rows.last) return;
  const std::size_t row_bytes = static_cast<std::size_t>(depth.width) * sizeof(float);
  to.reserve(to.size() + sizeof(Rows) + (rows.last - rows.first) * row_bytes);
  put(to, rows);
  for (std::uint32_t y = rows.first; y < rows.last; ++y) {
    const auto bytes = std::as_bytes(
        std::span(depth.row(static_cast<int>(y)), static_cast<std::size_t>(depth.width)));
    to.insert(to.end(), bytes.begin(), bytes.end());
  }
}

/// Keeps the greater depths, which are not negative.
void take_rows(Reader from, ImageView<float> depth) {
  while (!from.at_end()) {
    const auto rows = from.take<Rows>();
    for (std::uint32_t y = rows.first; y < rows.last; ++y) {
      float* const row = depth.row(static_cast<int>(y));
      const auto bytes = from.take_bytes(static_cast<std::size_t>(depth.width) * sizeof(float));
      for (int x = 0; x < depth.width; ++x) {
        float theirs;
        std::memcpy(&theirs, bytes.data() + static_cast<std::size_t>(x) * sizeof(float),
                    sizeof(float));
        row[x] = std::max(row[x], theirs);
      }
    }
  }
}

class LightDepths final : public ShadowRanks {
 public:
  LightDepths(Communicator& ranks, const AtPhase& at) : ranks_(ranks), at_(at), fit_(ranks) {}
  void own(FunctionRef<void()> work) override {
    in_phase(ranks_, at_, "draw what lights see", work);
  }
  [[nodiscard]] std::vector<double> gather(std::span<const double> numbers) override {
    return fit_.gather(numbers);
  }
  void meet(ImageView<float> depth) override {
    const auto n = static_cast<std::size_t>(ranks_.size());
    const Rows mine = own_rows(static_cast<std::size_t>(ranks_.rank()), n, depth.height);
    send("pack what lights see", "make room for what lights see", [&](Mail& mail) {
      for (std::size_t r = 0; r < n; ++r) put_rows(depth, own_rows(r, n, depth.height), mail.to(r));
    });
    in_phase(ranks_, at_, "take what lights see", [&] { take_all(depth); });
    send("tell what lights see", "make room for shadows", [&](Mail& mail) {
      Bytes whole;
      put_rows(depth, mine, whole);
      for (std::size_t r = 0; r < n; ++r) mail.to(r) = whole;
    });
    in_phase(ranks_, at_, "take shadows", [&] {
      take_all(depth);
      mail_.reset();
    });
  }

 private:
  template <class F>
  void send(std::string_view pack, std::string_view room, const F& f) {
    in_phase(ranks_, at_, pack, [&] { f(mail_.emplace(ranks_.size())); });
    exchange_with_all(ranks_, at_, *mail_, room);
  }
  void take_all(ImageView<float> depth) const {
    for (std::size_t r = 0; r < mail_->ranks(); ++r) take_rows(mail_->from(r), depth);
  }

  Communicator& ranks_;
  const AtPhase& at_;
  FitOfRanks fit_;
  std::optional<Mail> mail_;
};

}  // namespace

void PartsFrame::draw_shadows(const Camera& camera) {
  if (frame_.shadows && raster::row_of(frame_.shader).lights && (asked_ & kColorTargets) != 0) {
    LightDepths depths(ranks_, at_);
    shadows_ = RendererAccess::shadows(renderer_, own_scene(), camera, frame_, depths);
  }
  // The shadows are of all ranks; no pass may make shadows from its own parts only.
  frame_.shadows = false;
}

}  // namespace rastrum::ranks
