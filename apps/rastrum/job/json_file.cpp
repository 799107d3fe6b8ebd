// SPDX-License-Identifier: BSD-3-Clause
#include "json_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <rastrum/error.hpp>
#include <rastrum/io/mapped_file.hpp>

#include "parse/arguments.hpp"

namespace rastrum::cli {

nlohmann::ordered_json read_json(const std::filesystem::path& file) {
  const io::MappedFile mapped(file);
  try {
    return nlohmann::ordered_json::parse(io::as_text(mapped.bytes()));
  } catch (const nlohmann::ordered_json::exception& e) {
    throw Error(Errc::bad_format, file.string() + ": is not JSON: " + e.what());
  }
}

JsonFields::JsonFields(const nlohmann::ordered_json& object, std::string place)
    : object_(object), place_(std::move(place)) {
  if (!object.is_object()) fail("expected an object {...}");
}

const nlohmann::ordered_json* JsonFields::value(const char* name) {
  known_.emplace_back(name);
  const auto found = object_.find(name);
  return found == object_.end() ? nullptr : &*found;
}

bool JsonFields::has(const char* name) {
  return value(name) != nullptr;
}

std::optional<double> JsonFields::number(const char* name) {
  const auto* v = value(name);
  if (v == nullptr) return std::nullopt;
  if (!v->is_number() || !std::isfinite(v->get<double>())) fail(name, "expected a number");
  return v->get<double>();
}

std::optional<std::vector<double>> JsonFields::numbers(const char* name, std::size_t count) {
  const auto* v = value(name);
  if (v == nullptr) return std::nullopt;
  const auto is_number = [](const auto& e) {
    return e.is_number() && std::isfinite(e.template get<double>());
  };
  if (!v->is_array() || v->size() != count || !std::all_of(v->begin(), v->end(), is_number))
    fail(name, "expected an array of " + std::to_string(count) + " numbers");
  return v->get<std::vector<double>>();
}

std::optional<std::string> JsonFields::text(const char* name) {
  const auto* v = value(name);
  if (v == nullptr) return std::nullopt;
  if (!v->is_string()) fail(name, "expected a text in quotes");
  return v->get<std::string>();
}

std::optional<bool> JsonFields::boolean(const char* name) {
  const auto* v = value(name);
  if (v == nullptr) return std::nullopt;
  if (!v->is_boolean()) fail(name, "expected true or false");
  return v->get<bool>();
}

std::vector<JsonFields::Element> JsonFields::array(const char* name) {
  const auto* v = value(name);
  std::vector<Element> elements;
  if (v == nullptr) return elements;
  if (!v->is_array()) fail(name, "expected an array [...]");
  for (std::size_t i = 0; i < v->size(); ++i)
    elements.push_back({&(*v)[i], place_ + ": " + name + "[" + std::to_string(i) + "]"});
  return elements;
}

void JsonFields::finish() const {
  for (const auto& [name, unused] : object_.items()) {
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    fail("unknown name '" + name + "'; known here: " + joined(known_));
  }
}

void JsonFields::fail(const std::string& problem) const {
  throw Error(Errc::bad_format, place_ + ": " + problem);
}

void JsonFields::fail(std::string_view name, const std::string& problem) const {
  throw Error(Errc::bad_format, place_ + ": " + std::string(name) + ": " + problem);
}

void write_json(io::AtomicFile& file, const nlohmann::ordered_json& value) {
  // A file name need not be UTF-8, but JSON must.
  const std::string text =
      value.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  file.write(text.data(), text.size());
}

void write_json(const std::filesystem::path& file, const nlohmann::ordered_json& value) {
  io::AtomicFile out(file);
  write_json(out, value);
  out.commit();
}

}  // namespace rastrum::cli
