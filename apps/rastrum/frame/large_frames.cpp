// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <rastrum/error.hpp>

#include "frames.hpp"
#include "job/large_job.hpp"
#include "stats_json.hpp"

namespace rastrum::cli {
namespace {

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string(bytes >> 20).append(" MiB");
}

/// Rows that are drawn at once; 0: all. Throws if the picture must be whole and does not fit into
/// the limit.
int rows_of(const LargeJob& job) {
  const std::uint64_t limit = job.options.memory_limit;
  const int rows = rows_at_once(job.arguments, limit / 4);
  const char* const why = why_whole(job.arguments, job.notes);
  if (rows == 0 || why == nullptr) return rows;
  if (rows_at_once(job.arguments, limit) != 0)
    throw Error(Errc::out_of_memory,
                "--memory-limit: " + mebibytes(limit) + " cannot hold a picture of " +
                    size_of(job.render) + ", but " + why +
                    " a whole picture; without that (--look plain) it is drawn in bands");
  return 0;
}

class LargeFrames final : public Frames {
 public:
  explicit LargeFrames(LargeJob& job)
      : Frames(1, rows_of(job)), job_(job), annotator_(job.render.threads, job.render.isa) {}

  void draw(std::size_t /*number*/, Pictures& pictures, const TakeRows& take) override {
    OutOfCoreOptions options = job_.options;
    options.rows = rows;
    if (rows != 0) options.take_rows = [&](int first, int last) { take(last - first); };
    const Targets targets =
        make_targets(wanted_of(job_.arguments, &job_.notes, &annotator_),
                     {job_.render.width, rows == 0 ? job_.render.height : rows}, pictures);
    pictures.camera = job_.camera;
    const double begin = job_.timeline.now_ms();
    stats_ = job_.file.render(job_.camera, job_.render, targets, options);
    ms_ = job_.timeline.now_ms() - begin;
    job_.progress.clear();
    if (!job_.quiet && stats_.dropped != 0)
      warn(missing_triangles(stats_.dropped, stats_.triangles));
    if (!job_.quiet && stats_.seen == 0) warn("nothing is seen: no triangle is in the view");
    if (rows == 0) annotate(pictures, job_.notes, SceneView{}, job_.render, annotator_);
  }

  [[nodiscard]] Account account() override {
    Account account;
    if (job_.arguments.stats) {
      FrameStats frame = stats_.frame;
      frame.triangles.input = stats_.triangles;
      frame.triangles.dropped = stats_.dropped;
      frame.frame_ms = ms_;
      account.stats = stats_json({&frame, 1}, job_.render, 0);
      account.stats["out_of_core"] = {{"chunk_triangles", stats_.chunk},
                                      {"chunks", stats_.chunks},
                                      {"skipped", stats_.skipped},
                                      {"seen_triangles", stats_.seen},
                                      {"bands", stats_.bands},
                                      {"fit_ms", job_.fit_ms},
                                      {"draw_ms", ms_}};
      add_inputs_and_cameras(account.stats, job_.parts, {&job_.camera, 1});
    }
    account.summary = summary(job_.render, stats_.triangles) + ", " + std::to_string(stats_.seen) +
                      " of them drawn, " + milliseconds(ms_) + " out of core in " +
                      mebibytes(job_.options.memory_limit);
    return account;
  }

 private:
  LargeJob& job_;
  Annotator annotator_;
  OutOfCoreStats stats_;
  double ms_ = 0;
};

}  // namespace

std::unique_ptr<Frames> frames_of(LargeJob& job) {
  return std::make_unique<LargeFrames>(job);
}

}  // namespace rastrum::cli
