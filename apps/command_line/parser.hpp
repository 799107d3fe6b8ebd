// SPDX-License-Identifier: BSD-3-Clause
// The command line of programs and benchmarks: a small face of CLI11. Its headers take longer to
// compile than most sources, so only parser.cpp includes them.
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

/// An invalid command line (exit status 2). The message names the option.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  UsageError(std::string_view option, const std::string& problem)
      : std::runtime_error(std::string(option) + ": " + problem) {}
};

/// For more settings of a declared option: add(…)->required()->type_name("").
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  const Option* operator->() const { return this; }

  const Option& type_name(const std::string& name) const;  ///< the name of its value in --help
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

/// A command and its options. Copies refer to the same command.
class Parser {
 public:
  /// For a command line of its own, not a subcommand.
  explicit Parser(const std::string& name = "", const std::string& description = "");

  /// The same command, whose new options --help lists under `heading`; "": not at all.
  [[nodiscard]] Parser under(const std::string& heading) const;
  [[nodiscard]] Parser add_subcommand(const std::string& name, const std::string& description);
  /// In --help; "": not listed.
  void group(const std::string& name);
  void footer(const std::string& text);
  void version(const std::string& text);  ///< adds --version
  void require_subcommand();
  /// Leaves the rest of the command line, --help too, to rest().
  void leave_rest();
  [[nodiscard]] std::vector<std::string> rest() const;

  /// `parse` turns the option's text into a value; it may throw UsageError.
  Option add(const std::string& names, const std::string& type, const std::string& help,
             std::function<void(const std::string&)> parse);
  /// May be given several times; `parse` gets the texts in their order.
  Option add_repeated(const std::string& names, const std::string& type, const std::string& help,
                      std::function<void(const std::string&)> parse);
  /// T: int, std::uint64_t, float, double, std::string or a vector of strings.
  template <class T>
  Option add_option(const std::string& names, T& value, const std::string& help);
  Option add_flag(const std::string& names, bool& value, const std::string& help);

  /// False if --help or --version was printed. Throws UsageError.
  [[nodiscard]] bool parse(std::span<const std::string_view> arguments);
  /// One line of text, separated by spaces and quoted as in a shell.
  [[nodiscard]] bool parse(const std::string& line);
  [[nodiscard]] bool parsed() const;                        ///< whether this command was given
  [[nodiscard]] bool given(const std::string& name) const;  ///< this option was
  /// An option that was given: its first name in --help, and its texts; none for a flag.
  struct Given {
    std::string name;
    std::vector<std::string> texts;
  };
  [[nodiscard]] std::vector<Given> all_given() const;
  [[nodiscard]] std::string given_subcommand() const;          ///< "" if none
  [[nodiscard]] std::vector<std::string> subcommands() const;  ///< those that --help lists

 private:
  explicit Parser(std::shared_ptr<CLI::App> app) : app_(std::move(app)) {}
  [[nodiscard]] Option added(CLI::Option* option) const;

  std::shared_ptr<CLI::App> app_;
  std::optional<std::string> heading_;  ///< for new options
};

}  // namespace rastrum::cli
