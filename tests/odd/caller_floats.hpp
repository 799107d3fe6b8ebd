// Modes of floats and locales that callers have set for their process or a thread.
#pragma once

namespace rastrum::odd {

/// Rounding modes, traps and flushed subnormal numbers change no result, and are the same after
/// each call.
void any_floats_of_the_caller();
/// They are the same even if an Error is thrown.
void floats_of_the_caller_after_an_error();
/// A comma in numbers, of setlocale and of std::locale::global, changes nothing that is read or
/// written.
void any_locale_of_the_caller();

}  // namespace rastrum::odd
