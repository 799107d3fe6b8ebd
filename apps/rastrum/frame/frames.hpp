// SPDX-License-Identifier: BSD-3-Clause
// Draws the pictures of a job: in memory, chunk by chunk out of a file, or with other ranks.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "pictures.hpp"

namespace rastrum::cli {

struct LargeJob;
struct PartJob;
struct SceneJob;

class Frames {
 public:
  /// Available once all pictures are drawn.
  struct Account {
    nlohmann::ordered_json stats;  ///< empty unless asked for
    std::string summary;
  };
  using TakeRows = std::function<void(int rows)>;

  Frames(std::size_t pictures, int rows_at_once) : count(pictures), rows(rows_at_once) {}
  virtual ~Frames() = default;
  /// Draws picture `number` with its words and effects into `pictures`, which is reused. If `rows`
  /// is not 0, `pictures` has the next rows at each call of `take`.
  virtual void draw(std::size_t number, Pictures& pictures, const TakeRows& take) = 0;
  [[nodiscard]] virtual Account account() = 0;

  const std::size_t count;  ///< of pictures
  const int rows;           ///< drawn at once, so that no whole picture is held; 0: all
};

/// `job` must outlive them.
[[nodiscard]] std::unique_ptr<Frames> frames_of(SceneJob& job);
[[nodiscard]] std::unique_ptr<Frames> frames_of(LargeJob& job);
[[nodiscard]] std::unique_ptr<Frames> frames_of(PartJob& job);

}  // namespace rastrum::cli
