// SPDX-License-Identifier: BSD-3-Clause
// For `rastrum bench ranks`: deals parts of a mesh to ranks and counts what they send.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <rastrum/ranks.hpp>
#include <rastrum/render.hpp>

#include "tables/document.hpp"

namespace rastrum::bench {

/// A mesh cut into slabs of space, as a simulation divides its domain.
struct Slabs {
  Slabs(const Mesh& whole, std::size_t count);
  Slabs(const Slabs&) = delete;
  Slabs& operator=(const Slabs&) = delete;

  std::size_t triangles;
  std::vector<Mesh> meshes;  ///< one for each slab that is not empty
  std::vector<MeshView> views;
  std::vector<InstanceView> parts;
};

/// The consecutive instances that rank r of n holds, and their numbers.
struct Share {
  std::vector<std::uint64_t> numbers;
  SceneView scene;
};
[[nodiscard]] Share share_of(const Slabs& slabs, std::size_t r, std::size_t n);

/// A rank of this process that records what it sends in each phase.
class Counted final : public Communicator {
 public:
  Counted(Communicator& rank, const LocalRanks& all) : rank_(rank), all_(all) {}
  [[nodiscard]] int rank() const override { return rank_.rank(); }
  [[nodiscard]] int size() const override { return rank_.size(); }
  void begin_phase(std::string_view name) override { phase_ = name; }
  [[nodiscard]] std::uint64_t max(std::uint64_t value) override {
    const Note note(*this);
    return rank_.max(value);
  }
  void broadcast(std::span<std::byte> bytes, int root) override {
    const Note note(*this);
    rank_.broadcast(bytes, root);
  }
  void exchange_sizes(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) override {
    const Note note(*this);
    rank_.exchange_sizes(to, from);
  }
  void exchange(std::span<const std::span<const std::byte>> to,
                std::span<const std::span<std::byte>> from) override {
    const Note note(*this);
    rank_.exchange(to, from);
  }
  void max_of_each(std::span<std::uint64_t> values) override {
    const Note note(*this);
    rank_.max_of_each(values);
  }
  [[nodiscard]] std::span<std::uint64_t> share(std::size_t count) override {
    return rank_.share(count);
  }
  [[nodiscard]] bool is_one_process() const override { return rank_.is_one_process(); }
  /// Each entry has a phase's name and what was sent after it began.
  std::vector<std::pair<std::string, LocalRanks::Traffic>> phases;

 private:
  struct Note {
    explicit Note(Counted& c) : of(c), before(c.now()) {}
    ~Note() {
      const LocalRanks::Traffic after = of.now();
      if (of.phases.empty() || of.phases.back().first != of.phase_)
        of.phases.emplace_back(of.phase_, LocalRanks::Traffic{});
      of.phases.back().second.bytes += after.bytes - before.bytes;
      of.phases.back().second.messages += after.messages - before.messages;
    }
    Counted& of;
    LocalRanks::Traffic before;
  };
  [[nodiscard]] LocalRanks::Traffic now() const {
    return all_.traffic()[static_cast<std::size_t>(rank())];
  }

  Communicator& rank_;
  const LocalRanks& all_;
  std::string phase_;
};

/// The constants of LogGP, measured for ranks that are threads of this process.
struct LogGP {
  double latency_us = 0;    ///< of a small message from rank to rank
  double message_us = 0;    ///< between two messages of a rank; measured as latency_us
  double bytes_per_us = 0;  ///< of large messages
};
[[nodiscard]] LogGP measure_messages(bool quick);

/// Adds the bytes that up to 16,384 ranks would send, counted one rank at a time, and the predicted
/// time. Returns false if the counts differ from those of real ranks in this process.
[[nodiscard]] bool add_simulated(Document& document, const Mesh& mesh, int width, int height,
                                 bool quick);

}  // namespace rastrum::bench
