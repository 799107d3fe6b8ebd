#pragma once

namespace rastrum::odd {

/// Rounding modes, traps and flushed subnormal numbers change no result, and are the same after
/// each call.
void any_floats_of_the_caller();
/// They are the same even if an Error is thrown.
void floats_of_the_caller_after_an_error();

}  // namespace rastrum::odd
