// SPDX-License-Identifier: BSD-3-Clause
#include <rastrum/stop.hpp>

#include <utility>

namespace rastrum {
namespace {

thread_local const StopToken* in_force = nullptr;

}  // namespace

const StopToken* StopScope::enter(const StopToken* token) noexcept {
  return std::exchange(in_force, token);
}

const StopToken* StopScope::current() noexcept {
  return in_force;
}

}  // namespace rastrum
