// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/cull/seen_first.hpp>

#include <algorithm>

namespace rastrum::raster {

bool SeenFirst::choose(FrameContext& frame, std::uint64_t first, std::uint64_t last,
                       bool may_look) {
  selection_.begin(frame, first, last);
  bool looks = may_look;
  if (looks && !selection_.always()) {
    if (!seen_.knows(selection_)) wait_ = waits_ = 0;
    looks = wait_ == 0;
    if (!looks) --wait_;
  }
  // Copies are joined to long runs where none is tested alone, and where memory is planned.
  selection_.choose(frame, looks && !frame.plans_memory());
  frame.watch.lap(frame.stats, "choose");
  looks = looks && (selection_.always() || selection_.triangles() >= kLeastTriangles);
  selection_.project(frame, looks && seen_.knows(selection_) ? seen_part_ : 1);
  frame.watch.lap(frame.stats, "project");
  return looks;
}

template <class F>
void SeenFirst::for_each(const FrameContext& frame, const F& f) {
  const std::size_t count = selection_.candidates().size();
  parts_.assign((count + at_once_ - 1) / at_once_, {});
  frame.for_each_index(parts_.size(), [&](std::size_t part) {
    Part own;
    for (std::size_t i = part * at_once_; i < std::min(count, (part + 1) * at_once_); ++i)
      f(i, own);
    parts_[part] = own;
  });
}

/// The joined runs of the candidates in a state, in order.
std::span<const SetupRun> SeenFirst::collect(const FrameContext& frame, State state) {
  const std::span<const Candidate> all = selection_.candidates();
  for_each(frame, [&](std::size_t i, Part& own) {
    if (state_[i] != state || join(own.last, all[i].run)) return;
    own.last = all[i].run;
    ++own.runs;
  });
  std::size_t count = 0;
  for (Part& own : parts_) {
    own.first_run = count;
    count += own.runs;
  }
  runs_.reserve(count);
  frame.for_each_index(parts_.size(), [&](std::size_t part) {
    SetupRun* to = runs_.data() + parts_[part].first_run;
    SetupRun last{.cluster = 0};
    for (std::size_t i = part * at_once_; i < std::min(all.size(), (part + 1) * at_once_); ++i) {
      if (state_[i] != state) continue;
      if (join(last, all[i].run)) {
        to[-1] = last;
      } else {
        *to++ = last = all[i].run;
      }
    }
  });
  return {runs_.data(), count};
}

std::span<const SetupRun> SeenFirst::first(const FrameContext& frame) {
  const std::span<const Candidate> all = selection_.candidates();
  at_once_ = std::clamp<std::size_t>(
      all.size() / (4 * static_cast<std::size_t>(frame.concurrency())), 64, 1024);
  knows_ = seen_.knows(selection_);
  state_.resize(all.size());
  for_each(frame, [&](std::size_t i, Part&) {
    const Candidate& c = all[i];
    const bool asks_last = knows_ && (is_hinted_ || !c.leans);
    const bool is_first = !c.has_slot() || (asks_last ? seen_.has(c.slot) : !c.leans_away);
    state_[i] = is_first ? State::first : State::later;
  });
  depths_.begin(frame.view);
  return collect(frame, State::first);
}

std::span<const SetupRun> SeenFirst::rest(FrameContext& frame) {
  const std::span<const Candidate> all = selection_.candidates();
  for_each(frame, [&](std::size_t i, Part&) {
    if (state_[i] == State::later && depths_.hides(all[i])) state_[i] = State::hidden;
  });
  return collect(frame, State::later);
}

void SeenFirst::finish(FrameContext& frame, std::uint64_t cost) {
  const std::span<const Candidate> all = selection_.candidates();
  // The next frame need not first draw a cluster that the whole picture hides.
  for_each(frame, [&](std::size_t i, Part& own) {
    if (!all[i].has_slot()) return;
    // Clusters that were left out count as hidden, and so do those that were drawn but are hidden.
    if (state_[i] != State::hidden && depths_.hides(all[i])) state_[i] = State::hidden;
    if (state_[i] == State::hidden) {
      own.hidden += all[i].run.count;
      return;
    }
    ++own.drawn;
    own.missed += knows_ && !seen_.has(all[i].slot) ? 1U : 0U;
  });
  Part sum;
  for (const Part& own : parts_) {
    sum.drawn += own.drawn;
    sum.missed += own.missed;
    sum.hidden += own.hidden;
  }
  // After a camera's jump the clusters seen are not those of the last frame.
  is_hinted_ = sum.missed * kWorth < sum.drawn;
  seen_.begin(selection_);
  for_each(frame, [&](std::size_t i, Part&) {
    if (all[i].has_slot() && state_[i] != State::hidden) seen_.add(all[i].slot);
  });
  frame.count("triangles of hidden clusters", sum.hidden);
  seen_part_ = 1 - static_cast<double>(sum.hidden) /
                       static_cast<double>(std::max<std::uint64_t>(selection_.triangles(), 1));
  waits_ = sum.hidden < cost ? std::min(2 * waits_ + 1, kMostWaits) : 0;
  wait_ = waits_;
}

}  // namespace rastrum::raster
