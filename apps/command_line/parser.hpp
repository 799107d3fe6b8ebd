// SPDX-License-Identifier: BSD-3-Clause
// The command line of programs and benchmarks: a small face of CLI11, whose headers cost a source
// more time to compile than most sources have; parser.cpp alone includes them.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace rastrum::cli {

/// A command line that cannot be meant (exit status 2). The message names the option.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  UsageError(std::string_view option, const std::string& problem)
      : std::runtime_error(std::string(option) + ": " + problem) {}
};

/// A declared option, to say more of it: add(…)->required()->type_name("").
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  const Option* operator->() const { return this; }

  const Option& type_name(const std::string& name) const;  ///< what --help calls its value
  const Option& required() const;
  const Option& expected(int least, int most) const;  ///< values that it takes
  const Option& delimiter(char c) const;              ///< between the values of a list
  const Option& as_size() const;                      ///< takes 64K, 2G, …
  template <std::integral T>
  const Option& range(T least, T most) const {
    return integer_range(static_cast<std::int64_t>(least), static_cast<std::int64_t>(most));
  }
  const Option& range(double least, double most) const;

 private:
  const Option& integer_range(std::int64_t least, std::int64_t most) const;
  CLI::Option* option_;
};

/// A command and its options. Copies are of the same command.
class Parser {
 public:
  /// Parses a command line by itself, not as a subcommand.
  explicit Parser(const std::string& name = "", const std::string& description = "");

  /// The same command; the options that this one adds stand under `heading` in --help; "":
  /// they are not listed.
  [[nodiscard]] Parser under(const std::string& heading) const;
  [[nodiscard]] Parser add_subcommand(const std::string& name, const std::string& description);
  /// For --help alone; "": not listed.
  void group(const std::string& name);
  void footer(const std::string& text);
  void version(const std::string& text);  ///< adds --version
  void require_subcommand();
  /// The rest of the command line, --help too, is not this parser's: rest() has it.
  void leave_rest();
  [[nodiscard]] std::vector<std::string> rest() const;

  /// An option whose text `parse` turns into a value; it may throw UsageError.
  Option add(const std::string& names, const std::string& type, const std::string& help,
             std::function<void(const std::string&)> parse);
  /// One that may be given several times; `parse` sees them in their order.
  Option add_repeated(const std::string& names, const std::string& type, const std::string& help,
                      std::function<void(const std::string&)> parse);
  /// An option that is a value; T: int, std::uint64_t, float, double, std::string or
  /// a vector of strings.
  template <class T>
  Option add_option(const std::string& names, T& value, const std::string& help);
  Option add_flag(const std::string& names, bool& value, const std::string& help);

  /// False where --help or --version was asked for and has been printed. Throws UsageError.
  [[nodiscard]] bool parse(std::span<const std::string_view> arguments);
  /// One line of text, options parted by spaces and quoted as in a shell.
  [[nodiscard]] bool parse(const std::string& line);
  [[nodiscard]] bool parsed() const;                        ///< this command was given
  [[nodiscard]] bool given(const std::string& name) const;  ///< this option was
  /// An option that was given: the first name that --help has for it, and its texts; none for a
  /// flag.
  struct Given {
    std::string name;
    std::vector<std::string> texts;
  };
  [[nodiscard]] std::vector<Given> all_given() const;
  [[nodiscard]] std::string given_subcommand() const;          ///< "": none
  [[nodiscard]] std::vector<std::string> subcommands() const;  ///< those that --help lists

 private:
  explicit Parser(std::shared_ptr<CLI::App> app) : app_(std::move(app)) {}
  [[nodiscard]] Option added(CLI::Option* option) const;

  std::shared_ptr<CLI::App> app_;
  std::optional<std::string> heading_;  ///< of options that it adds
};

}  // namespace rastrum::cli
