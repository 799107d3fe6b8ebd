// SPDX-License-Identifier: BSD-3-Clause
#include <papers/models/replay/simulate.hpp>

#include <algorithm>
#include <deque>
#include <queue>
#include <random>
#include <tuple>

#include <rastrum/error.hpp>

#include <bench/measure.hpp>

namespace rastrum::bench {
namespace {

/// Simulates the workers of one loop, event by event.
class Workers {
 public:
  Workers(const ReplayedLoop& loop, int count, const LoopCosts& costs)
      : loop_(loop), costs_(costs), queues_(static_cast<std::size_t>(count)) {
    // A loop in order has one share for each worker, which ends when no index is left.
    n_ = loop.in_order ? std::min(loop.n, queues_.size()) : loop.n;
    grain_ = loop.in_order ? 1 : std::max<std::size_t>(loop.grain, 1);
  }

  double run(bool sleep) {
    if (n_ == 0) return costs_.loop;
    run_range(0, {0, n_, 0}, costs_.loop);
    for (std::size_t w = 1; w < queues_.size(); ++w) {
      double at = 0;
      if (sleep)
        for (std::size_t k = w; k != 0; k = (k - 1) / 2) at += costs_.wake;
      add(at, w, Next::look);
    }
    while (!events_.empty()) {
      const Event e = events_.top();
      events_.pop();
      if (e.next == Next::claim)
        claim(e.worker, e.at);
      else
        look(e.worker, e.at);
    }
    return end_ + (last_ == 0 ? 0 : costs_.join);
  }

 private:
  struct Range {
    std::size_t begin, end;
    double up;  ///< when it was queued
  };
  enum class Next : std::uint8_t { look, claim };
  struct Event {
    double at;
    std::uint64_t number;  ///< orders events of equal time
    std::size_t worker;
    Next next;
    bool operator>(const Event& e) const { return std::tie(at, number) > std::tie(e.at, e.number); }
  };

  void add(double at, std::size_t worker, Next next) {
    events_.push({at, events_added_++, worker, next});
  }

  /// Splits the worker's range and runs its first part.
  void run_range(std::size_t w, Range r, double t) {
    while (r.end - r.begin > grain_) {
      t += costs_.task;
      const std::size_t middle = r.begin + (r.end - r.begin) / 2;
      queues_[w].push_back({middle, r.end, t});
      ++put_up_;
      r.end = middle;
      if (!idle_.empty()) {
        add(t, idle_.back(), Next::look);
        idle_.pop_back();
      }
    }
    t += costs_.task;
    if (loop_.in_order) {
      add(t, w, Next::claim);
      return;
    }
    const double ns = loop_.at[r.begin];
    if (ns < 0)
      throw Error(Errc::invalid_argument,
                  "a replayed loop has no task that begins at an index where its "
                  "ranges are split");
    finish(w, t + ns);
    add(t + ns, w, Next::look);
  }

  void claim(std::size_t w, double t) {
    t = counter_free_ = std::max(t, counter_free_) + costs_.claim;
    if (next_ == loop_.n) {
      finish(w, t);
      add(t, w, Next::look);
      return;
    }
    add(t + loop_.at[next_++], w, Next::claim);
  }

  void look(std::size_t w, double t) {
    if (!queues_[w].empty()) {
      const Range r = queues_[w].back();
      queues_[w].pop_back();
      --put_up_;
      return run_range(w, r, std::max(t, r.up));
    }
    if (put_up_ == 0) {
      idle_.push_back(w);
      return;
    }
    std::size_t victim = random_() % (queues_.size() - 1);
    victim += victim >= w ? 1 : 0;
    if (queues_[victim].empty() || queues_[victim].front().up > t)
      return add(t + std::max(costs_.look, 1.0), w, Next::look);
    const Range r = queues_[victim].front();
    queues_[victim].pop_front();
    --put_up_;
    run_range(w, r, t + costs_.take);
  }

  void finish(std::size_t w, double t) {
    if (t < end_) return;
    end_ = t;
    last_ = w;
  }

  const ReplayedLoop& loop_;
  const LoopCosts& costs_;
  std::vector<std::deque<Range>> queues_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::vector<std::size_t> idle_;
  std::minstd_rand random_{1};
  std::uint64_t events_added_ = 0;
  std::size_t n_ = 0, grain_ = 1, put_up_ = 0, next_ = 0, last_ = 0;
  double counter_free_ = 0, end_ = 0;
};

bool alike(const parallel::Recording& a, const parallel::Recording& b) {
  return std::ranges::equal(a.loops, b.loops, [](const auto& x, const auto& y) {
    return x.n == y.n && x.grain == y.grain && x.in_order == y.in_order &&
           x.tasks.size() == y.tasks.size();
  });
}

double ns_of(std::int64_t from, std::int64_t to) {
  return static_cast<double>(to - from);
}

}  // namespace

double ReplayedLoop::work() const {
  double sum = 0;
  for (const double ns : at) sum += std::max(ns, 0.0);
  return sum;
}

double ReplayedLoop::largest() const {
  return at.empty() ? 0 : std::max(0.0, *std::ranges::max_element(at));
}

std::size_t ReplayedLoop::tasks() const {
  return static_cast<std::size_t>(std::ranges::count_if(at, [](double ns) { return ns >= 0; }));
}

ReplayedFrame median_frame(std::span<const RecordedFrame> frames) {
  ReplayedFrame out;
  if (frames.empty()) return out;
  std::vector<const RecordedFrame*> same;
  for (const RecordedFrame& f : frames)
    if (alike(f.recording, frames.back().recording)) same.push_back(&f);
  const auto middle = [&](const auto& value) {
    std::vector<double> values;
    for (const RecordedFrame* f : same) values.push_back(value(*f));
    return median(std::move(values));
  };
  const std::size_t count = frames.back().recording.loops.size();
  for (std::size_t l = 0; l < count; ++l) {
    const auto& last = frames.back().recording.loops[l];
    ReplayedLoop& loop = out.loops.emplace_back();
    loop.in_order = last.in_order;
    loop.n = last.n;
    loop.grain = last.grain;
    loop.before = middle([&](const RecordedFrame& f) {
      const auto& loops = f.recording.loops;
      return ns_of(l == 0 ? f.begin_ns : loops[l - 1].end_ns, loops[l].begin_ns);
    });
    std::vector<std::vector<double>> at(last.n);
    for (const RecordedFrame* f : same)
      for (const auto& task : f->recording.loops[l].tasks)
        at[task.begin].push_back(ns_of(task.begin_ns, task.end_ns));
    for (auto& values : at) loop.at.push_back(values.empty() ? -1 : median(std::move(values)));
  }
  out.after = middle([&](const RecordedFrame& f) {
    return ns_of(count == 0 ? f.begin_ns : f.recording.loops.back().end_ns, f.end_ns);
  });
  return out;
}

double replay(const ReplayedLoop& loop, int workers, const LoopCosts& costs, bool sleep) {
  return Workers(loop, workers, costs).run(sleep);
}

Replay replay(const ReplayedFrame& frame, int workers, const LoopCosts& costs) {
  Replay out;
  bool first = true;
  for (const ReplayedLoop& loop : frame.loops) {
    const bool sleep = first || loop.before > costs.linger;
    first = false;
    out.loops.push_back(replay(loop, workers, costs, sleep));
    out.ns += loop.before + out.loops.back();
  }
  out.ns += frame.after;
  return out;
}

}  // namespace rastrum::bench
