// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include "frames.hpp"
#include "job/scene_job.hpp"
#include "nothing_seen.hpp"
#include "stats_json.hpp"

namespace rastrum::cli {
namespace {

class SceneFrames final : public Frames {
 public:
  explicit SceneFrames(SceneJob& job)
      : Frames(job.pictures.count, 0), job_(job), annotator_(job.render.threads, job.render.isa) {}

  void draw(std::size_t number, Pictures& pictures, const TakeRows& /*take*/) override {
    if (is_sequence())
      job_.progress.show("picture " + std::to_string(number + 1) + " of " + std::to_string(count));
    const auto [scene, camera] = job_.pictures.shot(number);
    const std::vector<FrameStats> drawn =
        render_frames(job_.renderer, scene, camera, job_.render,
                      wanted_of(job_.arguments, &job_.notes, &annotator_), is_timed(),
                      job_.arguments.frames.value_or(1), pictures, job_.timeline, job_.progress);
    frames_.insert(frames_.end(), drawn.begin(), drawn.end());
    cameras_.push_back(camera);
    const FrameStats& median = drawn[median_frame(drawn)];
    if (is_empty(median, job_.render) && empty_++ == 0 && !job_.quiet) {
      first_empty_ = number;
      why_ = why_empty(median, job_.render, scene, camera);
    }
    if (!is_sequence()) warn_of(median);
    job_.timeline.measure("words and effects", "annotate",
                          [&] { annotate(pictures, job_.notes, scene, job_.render, annotator_); });
  }

  [[nodiscard]] Account account() override {
    const FrameStats& median = frames_[median_frame(frames_)];
    if (is_sequence()) warn_of(median);
    Account account;
    if (job_.arguments.stats) {
      account.stats = stats_json(frames_, job_.render, job_.load_ms);
      add_inputs_and_cameras(account.stats, job_.parts, cameras_);
    }
    account.summary = (is_sequence() ? std::to_string(count) + " pictures of " : "") +
                      summary(job_.render, median.triangles.input) + ", " +
                      milliseconds(median.frame_ms) +
                      (is_sequence() ? " a picture"
                       : is_timed()  ? " a frame"
                                     : "");
    return account;
  }

 private:
  [[nodiscard]] bool is_sequence() const { return job_.arguments.is_sequence(); }
  [[nodiscard]] bool is_timed() const {
    const RenderArguments& a = job_.arguments;
    return !a.is_sequence() && (a.frames || a.stats || a.trace);
  }

  void warn_of(const FrameStats& frame) {
    job_.progress.clear();
    if (job_.quiet) return;
    if (frame.triangles.dropped != 0)
      warn(missing_triangles(frame.triangles.dropped, frame.triangles.input));
    if (empty_ != 0 && is_sequence())
      warn("nothing is seen in " + std::to_string(empty_) + " of " + std::to_string(count) +
           " pictures; in number " + std::to_string(first_empty_) + ", the first of them, " +
           why_.reason);
    else if (empty_ != 0)
      warn("nothing is seen: " + why_.reason + "; " + why_.remedy);
  }

  SceneJob& job_;
  Annotator annotator_;
  std::vector<FrameStats> frames_;
  std::vector<Camera> cameras_;
  std::size_t empty_ = 0, first_empty_ = 0;  ///< pictures without anything visible
  Emptiness why_;                            ///< of the first of them
};

}  // namespace

std::unique_ptr<Frames> frames_of(SceneJob& job) {
  return std::make_unique<SceneFrames>(job);
}

}  // namespace rastrum::cli
