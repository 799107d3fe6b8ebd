// SPDX-License-Identifier: BSD-3-Clause
#include "parser.hpp"

#include <algorithm>
#include <utility>

#include <CLI/CLI.hpp>

#include <rastrum/core/nearest_word.hpp>

namespace rastrum::cli {

const Option& Option::type_name(const std::string& name) const {
  option_->type_name(name);
  return *this;
}
const Option& Option::required() const {
  option_->required();
  return *this;
}
const Option& Option::expected(int least, int most) const {
  option_->expected(least, most);
  return *this;
}
const Option& Option::delimiter(char c) const {
  option_->delimiter(c);
  return *this;
}
const Option& Option::as_size() const {
  option_->transform(CLI::AsSizeValue(false));
  return *this;
}
const Option& Option::range(double least, double most) const {
  option_->check(CLI::Range(least, most));
  return *this;
}
const Option& Option::integer_range(std::int64_t least, std::int64_t most) const {
  option_->check(CLI::Range(least, most));
  return *this;
}

Parser::Parser(const std::string& name, const std::string& description)
    : app_(std::make_shared<CLI::App>(description, name)) {}

Parser Parser::under(const std::string& heading) const {
  Parser same = *this;
  same.heading_ = heading;
  return same;
}
Option Parser::added(CLI::Option* option) const {
  if (heading_) option->group(*heading_);
  return Option(option);
}
Parser Parser::add_subcommand(const std::string& name, const std::string& description) {
  // The parent owns it and lives as long.
  return Parser(std::shared_ptr<CLI::App>(app_, app_->add_subcommand(name, description)));
}
void Parser::group(const std::string& name) {
  app_->group(name);
}
void Parser::footer(const std::string& text) {
  app_->footer(text);
}
void Parser::version(const std::string& text) {
  app_->set_version_flag("--version", text);
}
void Parser::require_subcommand() {
  app_->require_subcommand(1);
}
void Parser::leave_rest() {
  app_->set_help_flag();
  app_->prefix_command();
}
std::vector<std::string> Parser::rest() const {
  return app_->remaining();
}

Option Parser::add(const std::string& names, const std::string& type, const std::string& help,
                   std::function<void(const std::string&)> parse) {
  return added(
      app_->add_option_function<std::string>(names, std::move(parse), help)->type_name(type));
}

Option Parser::add_repeated(const std::string& names, const std::string& type,
                            const std::string& help,
                            std::function<void(const std::string&)> parse) {
  return added(app_->add_option_function<std::vector<std::string>>(
                       names,
                       [parse = std::move(parse)](const std::vector<std::string>& texts) {
                         for (const std::string& text : texts) parse(text);
                       },
                       help)
                   ->type_name(type)
                   ->expected(1)
                   ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll));
}

template <class T>
Option Parser::add_option(const std::string& names, T& value, const std::string& help) {
  return added(app_->add_option(names, value, help));
}
template Option Parser::add_option(const std::string&, int&, const std::string&);
template Option Parser::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option Parser::add_option(const std::string&, float&, const std::string&);
template Option Parser::add_option(const std::string&, double&, const std::string&);
template Option Parser::add_option(const std::string&, std::string&, const std::string&);
template Option Parser::add_option(const std::string&, std::vector<std::string>&,
                                   const std::string&);

Option Parser::add_flag(const std::string& names, bool& value, const std::string& help) {
  return added(app_->add_flag(names, value, help));
}

namespace {

/// Option names, as in --size, of `app` and of its given commands.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const CLI::App* command : app.get_subcommands())
    for (std::string& name : option_names(*command)) names.push_back(std::move(name));
  return names;
}

/// For unknown arguments: the first unknown option, and what may have been meant.
std::string not_taken(const CLI::ExtrasError& error, const CLI::App& app) {
  const std::vector<std::string> names = option_names(app);
  const std::vector<std::string_view> known(names.begin(), names.end());
  for (const std::string& rest : app.remaining(true)) {
    const std::string_view name = std::string_view(rest).substr(0, rest.find('='));
    if (name.starts_with("--"))
      return "there is no option " + std::string(name) + did_you_mean(name, known);
  }
  return error.what();
}

/// Runs `parse` and translates CLI11's errors into ours.
template <class F>
bool parse_as_ours(CLI::App& app, F parse) {
  try {
    parse();
  } catch (const CLI::Success& e) {
    app.exit(e);
    return false;
  } catch (const CLI::ExtrasError& e) {
    throw UsageError(not_taken(e, app));
  } catch (const CLI::ParseError& e) {
    throw UsageError(e.what());
  }
  return true;
}

}  // namespace

bool Parser::parse(std::span<const std::string_view> arguments) {
  // CLI11 takes the arguments as a stack.
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  return parse_as_ours(*app_, [&] { app_->parse(std::move(reversed)); });
}
bool Parser::parse(const std::string& line) {
  return parse_as_ours(*app_, [&] { app_->parse(line); });
}
bool Parser::parsed() const {
  return app_->parsed();
}
bool Parser::given(const std::string& name) const {
  return app_->count(name) != 0;
}
std::vector<Parser::Given> Parser::all_given() const {
  std::vector<Given> all;
  for (const CLI::Option* option : std::as_const(*app_).get_options()) {
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    Given& given = all.emplace_back();
    given.name = "--" + option->get_lnames().front();
    if (option->get_items_expected_max() != 0) given.texts = option->results();
  }
  return all;
}
std::string Parser::given_subcommand() const {
  const auto given = app_->get_subcommands();
  return given.empty() ? "" : given.front()->get_name();
}
std::vector<std::string> Parser::subcommands() const {
  std::vector<std::string> names;
  for (const CLI::App* command : std::as_const(*app_).get_subcommands({}))
    if (!command->get_group().empty()) names.push_back(command->get_name());
  return names;
}

}  // namespace rastrum::cli
