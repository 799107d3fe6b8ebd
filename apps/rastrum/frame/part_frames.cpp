// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frames.hpp"
#include "job/part_job.hpp"
#include "job/system.hpp"
#include "stats_json.hpp"

namespace rastrum::cli {
namespace {

/// Picture bytes that a rank may hold without a memory limit.
constexpr std::uint64_t kUsualBytes = std::uint64_t{1} << 30;

/// Rows that are drawn at once; 0: all, if they fit or something needs the whole picture.
int rows_of(const PartJob& job) {
  const std::uint64_t limit = job.render.memory_limit;
  const int rows = rows_at_once(job.arguments, limit == 0 ? kUsualBytes : limit / 4);
  const char* const why = why_whole(job.arguments, job.notes);
  if (rows == 0 || why == nullptr) return rows;
  if (!job.quiet)
    warn(std::string(why) +
         " a whole picture, so the first rank holds all of it; without that (--look plain) ranks "
         "draw it in bands of " +
         std::to_string(rows) + " rows");
  return 0;
}

class PartFrames final : public Frames {
 public:
  explicit PartFrames(PartJob& job) : Frames(1, rows_of(job)), job_(job) {}

  void draw(std::size_t /*number*/, Pictures& pictures, const TakeRows& take) override {
    std::optional<Annotator> annotator;
    Targets targets;
    do_alike(job_.ranks, "make images", [&] {
      annotator.emplace(job_.render.threads, job_.render.isa);
      if (!job_.is_writer()) return;
      job_.progress.show("rendering");
      targets = make_targets(wanted_of(job_.arguments),
                             {job_.render.width, rows == 0 ? job_.render.height : rows}, pictures);
      pictures.camera = job_.camera;
    });
    RanksOptions options;
    options.rows = rows;
    if (rows != 0) options.take_rows = [&](int first, int last) { take(last - first); };
    if (job_.is_writer())
      options.progress = [&](std::string_view what, std::uint64_t done, std::uint64_t all) {
        job_.progress.show(what, done, all);
      };
    const SceneView scene = job_.binding->view();
    const double begin = job_.timeline.now_ms();
    stats_ = job_.notes.any()
                 ? render_parts(job_.ranks, *job_.renderer, *annotator, scene, job_.instance_ids,
                                job_.camera, job_.render, job_.notes, targets, options)
                 : render_parts(job_.ranks, *job_.renderer, scene, job_.instance_ids, job_.camera,
                                job_.render, targets, options);
    ms_ = job_.timeline.now_ms() - begin;
  }

  [[nodiscard]] Account account() override {
    Account account;
    if (job_.arguments.stats) account.stats = statistics();
    account.summary = summary(job_.render, stats_.primitives) + ", " + milliseconds(ms_) + " on " +
                      std::to_string(job_.ranks.size()) + " ranks";
    return account;
  }

 private:
  /// All ranks must call it.
  [[nodiscard]] nlohmann::ordered_json statistics() {
    const RankNumbers own{job_.load_ms,
                          ms_,
                          static_cast<double>(job_.inputs.scene.primitive_count()),
                          static_cast<double>(stats_.words),
                          static_cast<double>(stats_.won),
                          static_cast<double>(stats_.fragments),
                          peak_bytes()};
    const auto bytes = gather_to_all(job_.ranks, std::as_bytes(std::span(&own, 1)));
    nlohmann::ordered_json json;
    do_alike(job_.ranks, "add statistics", [&] {
      std::vector<RankNumbers> all(bytes.size());
      for (std::size_t r = 0; r < all.size(); ++r)
        std::memcpy(&all[r], bytes[r].data(), sizeof(RankNumbers));
      json = stats_json(all, stats_, job_.render);
      add_inputs_and_cameras(json, job_.parts, {&job_.camera, 1});
      for (std::size_t i = 0; i < job_.parts.size(); ++i)
        json["inputs"][i]["rank"] = job_.rank_of_input[i];
      if (rows != 0) json["rows_at_once"] = rows;
    });
    return json;
  }

  PartJob& job_;
  RanksStats stats_;
  double ms_ = 0;
};

}  // namespace

std::unique_ptr<Frames> frames_of(PartJob& job) {
  return std::make_unique<PartFrames>(job);
}

}  // namespace rastrum::cli
