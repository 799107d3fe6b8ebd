// How the commands declare options whose text they turn into a value themselves.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

#include <rastrum/parallel/device.hpp>

#include "arguments.hpp"

namespace rastrum::cli {

/// One of a few words. Throws UsageError that lists them.
template <class T>
T choose(std::string_view option, const std::string& text,
         std::initializer_list<std::pair<const char*, T>> choices) {
  std::string known;
  for (const auto& [word, value] : choices) {
    if (text == word) return value;
    known.append(known.empty() ? "" : ", ").append(word);
  }
  throw UsageError(option, "expected one of " + known + ", got '" + text + "'");
}

inline Isa parse_isa(const std::string& text) {
  return choose<Isa>("--isa", text,
                     {{"scalar", Isa::scalar},
                      {"sse4", Isa::sse4},
                      {"avx2", Isa::avx2},
                      {"avx512", Isa::avx512},
                      {"neon", Isa::neon}});
}

inline Device parse_device(const std::string& text) {
  return choose<Device>("--device", text,
                        {{"serial", Device::serial},
                         {"threads", Device::threads},
                         {"cuda", Device::cuda},
                         {"auto", Device::automatic}});
}

/// The instruction sets of this machine, for help texts.
inline std::string isa_words() {
  std::string isas;
  for (const Isa isa : available_isas()) isas.append(isas.empty() ? "" : ", ").append(name(isa));
  return isas;
}

/// An option whose text `parse` turns into a value; what it throws names the option.
template <class F>
CLI::Option* add(CLI::App& app, const char* names, const char* type, const std::string& help,
                 F parse) {
  return app
      .add_option_function<std::string>(
          names, [parse](const std::string& s) { parse(s); }, help)
      ->type_name(type);
}

}  // namespace rastrum::cli
