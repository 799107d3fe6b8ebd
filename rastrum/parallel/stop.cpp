#include <rastrum/stop.hpp>

#include <utility>

namespace rastrum {
namespace {

thread_local const std::stop_token* in_force = nullptr;

}  // namespace

StopScope::StopScope(const std::stop_token* token) noexcept
    : outer_(std::exchange(in_force, token)) {}

StopScope::~StopScope() {
  in_force = outer_;
}

const std::stop_token* StopScope::current() noexcept {
  return in_force;
}

}  // namespace rastrum
