// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/raster/context/frame_context.hpp>

#include <algorithm>

namespace rastrum::raster {
namespace {

constexpr std::size_t kProjectGrain = 4096;

}  // namespace

void add_counter(Counters& counters, std::string_view name, std::uint64_t value) {
  const auto found = std::find_if(counters.begin(), counters.end(),
                                  [&](const auto& c) { return c.first == name; });
  if (found != counters.end())
    found->second += value;
  else
    counters.emplace_back(name, value);
}

void raise_counter(Counters& counters, std::string_view name, std::uint64_t value) {
  add_counter(counters, name, 0);
  std::uint64_t& held = std::ranges::find(counters, name, &Counters::value_type::first)->second;
  held = std::max(held, value);
}

void FrameContext::project(Draw& draw) const {
  for_each_index((draw.vertex_count + kProjectGrain - 1) / kProjectGrain, [&](std::size_t i) {
    const std::size_t begin = i * kProjectGrain;
    const std::size_t end = std::min(begin + kProjectGrain, draw.vertex_count);
    draw.source.project(begin, end, geometry.viewport, request.isa,
                        projected + draw.first_vertex + begin);
  });
  draw.is_projected = true;
}

}  // namespace rastrum::raster
