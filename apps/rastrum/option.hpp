// How the commands declare options whose text they turn into a value themselves.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include <apps/command_line/choose.hpp>
#include <apps/command_line/parser.hpp>

#include <rastrum/device.hpp>

#include "arguments.hpp"

namespace rastrum::cli {

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
inline std::string isa_names() {
  std::string isas;
  for (const Isa isa : available_isas()) isas.append(isas.empty() ? "" : ", ").append(name(isa));
  return isas;
}

/// An option whose text `parse` turns into a value; what it throws names the option.
inline Option add(Parser& app, const char* names, const char* type, const std::string& help,
                  std::function<void(const std::string&)> parse) {
  return app.add(names, type, help, std::move(parse));
}

}  // namespace rastrum::cli
