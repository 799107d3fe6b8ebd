// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include <rastrum/error.hpp>

#include "commit.hpp"  // written by the build

namespace rastrum::bench {
namespace {

/// Times are unreliable above this load: our own core and a bit of other work.
constexpr double kQuietLoad = 1.2;

/// The value of the first `key : value` line of a file of /proc; empty if there is none.
std::string proc_value(const char* file, std::string_view key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key))
      if (const auto colon = line.find(':'); colon != std::string::npos)
        if (const auto begin = line.find_first_not_of(" \t", colon + 1); begin != std::string::npos)
          return line.substr(begin);
  return {};
}

/// The number of runnable processes, averaged over the last minute; 0 if the system does not say.
double load_average() {
  std::ifstream in("/proc/loadavg");
  double load = 0;
  in >> load;
  return load;
}

std::string now_utc() {
  const std::time_t t = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&t, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::string compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "gcc " __VERSION__;
#endif
}

}  // namespace

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

void Table::print_row(const std::vector<std::string>& cells) const {
  for (std::size_t i = 0; i < cells.size() && i < columns_.size(); ++i) {
    const auto width = static_cast<std::size_t>(columns_[i].width), n = characters(cells[i]);
    const std::string padding(width - std::min(width, n), ' ');
    const std::string text = columns_[i].left ? cells[i] + padding : padding + cells[i];
    std::printf("%s%s", i == 0 ? "" : "  ", text.c_str());
  }
  std::printf("\n");
  std::fflush(stdout);
}

void Table::print_head() const {
  std::vector<std::string> titles;
  std::vector<std::string> rules;
  for (const Column& c : columns_) {
    titles.push_back(c.title);
    rules.emplace_back(std::max(static_cast<std::size_t>(c.width), characters(c.title)), '-');
  }
  print_row(titles);
  print_row(rules);
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  const int magnitude = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", std::max(0, digits - 1 - magnitude), value);
  return text;
}

std::string megabytes(std::uint64_t bytes) {
  return significant(static_cast<double>(bytes) / 1e6);
}

std::string shortest(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

nlohmann::json to_json(const Timing& timing) {
  return {{"median_ms", timing.median_ms()},
          {"spread", timing.spread()},
          {"samples_ms", timing.samples_ms},
          {"cpu_median_ms", median(timing.cpu_samples_ms)}};
}

nlohmann::json machine_json() {
  const std::string memory = proc_value("/proc/meminfo", "MemTotal");
  const double kib = memory.empty() ? 0 : std::strtod(memory.c_str(), nullptr);
  return {{"cpu", proc_value("/proc/cpuinfo", "model name")},
          {"cores", std::thread::hardware_concurrency()},
          {"memory_gib", std::round(kib / 1048576 * 10) / 10},
          {"load", load_average()},
          {"compiler", compiler()},
          {"commit", kCommit},
          {"version", kVersion},
          {"date", now_utc()}};
}

std::string machine_text() {
  const nlohmann::json m = machine_json();
  return m["cpu"].get<std::string>() + ", " + std::to_string(m["cores"].get<unsigned>()) +
         " cores, " + significant(m["memory_gib"].get<double>()) + " GiB; " +
         m["compiler"].get<std::string>() + "\nRastrum " + m["version"].get<std::string>() + " (" +
         m["commit"].get<std::string>() + "), " + m["date"].get<std::string>() +
         (m["load"].get<double>() > kQuietLoad
              ? "\nThe machine is BUSY (load " + significant(m["load"].get<double>()) +
                    "): no time below is worth quoting."
              : "");
}

void write_json(const std::string& file, const nlohmann::json& document) {
  const std::string temporary = file + ".part";
  {
    std::ofstream out(temporary);
    out << document.dump(2) << "\n";
    if (!out.flush()) throw Error(Errc::io, "cannot write " + temporary);
  }
  std::error_code failed;
  std::filesystem::rename(temporary, file, failed);
  if (failed) throw Error(Errc::io, "cannot rename " + temporary + ": " + failed.message());
}

}  // namespace rastrum::bench
