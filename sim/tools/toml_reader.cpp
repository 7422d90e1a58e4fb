#include "sim/tools/toml_reader.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "leeway/earth/error.hpp"
#include "sim/tools/closest_name.hpp"

namespace leeway::sim {
namespace {

/// Converting a limit to the unit of a key and back may cost an ulp or two.
bool contain(const Range& limits, double si) {
  constexpr double kRounding = 1e-12;
  return limits.contains(si * (1.0 - kRounding)) || limits.contains(si * (1.0 + kRounding));
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 80;
  return fmt::format("'{}{}'", text.substr(0, kLongest), text.size() > kLongest ? ".." : "");
}

std::string key_of(const Quantity& quantity, const Unit& unit) {
  return fmt::format("{}_{}", quantity.name, unit.key);
}

std::vector<std::string> keys_of(const Quantity& quantity) {
  std::vector<std::string> keys;
  for (const Unit* unit : quantity.units) {
    if (unit != nullptr) keys.push_back(key_of(quantity, *unit));
  }
  if (keys.empty()) keys.emplace_back(quantity.name);
  return keys;
}

/// The limits in words, in a unit that is `si` in SI.
std::string range_text(const Range& limits, double value, double si) {
  const double low = limits.low / si;
  if (limits.or_zero && value > 0.0 && value < low) {
    return fmt::format("must be 0, or at least {:g} like that of a real sensor", low);
  }
  return fmt::format("must be a number from {:g} to {:g}", limits.or_zero ? 0.0 : low,
                     limits.high / si);
}

/// The place after the text in quotes, or the comment, that begins at `at`.
std::size_t end_of_words(std::string_view text, std::size_t at) {
  const char opening = text[at];
  const std::string_view thrice = text.substr(at, 3);
  if (opening != '#' && thrice == std::string(3, opening)) {
    const std::size_t end = text.find(thrice, at + 3);
    return end == std::string_view::npos ? text.size() : end + 3;
  }
  for (++at; at < text.size() && text[at] != '\n'; ++at) {
    if (opening == '"' && text[at] == '\\') {
      ++at;
    } else if (opening != '#' && text[at] == opening) {
      return at + 1;
    }
  }
  return at;
}

/// The place of a dotted key of more parts than any scene has; npos: there is none. The parser
/// nests as deep as a key has parts, and runs out of stack.
std::size_t find_deep_key(std::string_view text) {
  constexpr int kMostParts = 32;
  int parts = 1;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '.' && ++parts > kMostParts) return at;
    if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) parts = 1;
    at = std::string_view("\"'#").find(c) != std::string_view::npos ? end_of_words(text, at)
                                                                    : at + 1;
  }
  return std::string_view::npos;
}

}  // namespace

std::string likely_intent(const std::vector<std::string>& quoted_keys) {
  return quoted_keys.empty() ? ""
                             : fmt::format("; did you mean {}?", fmt::join(quoted_keys, " or "));
}

std::size_t TomlValue::size() const { return is_array() ? node_->as_array()->size() : 0; }

std::optional<double> TomlValue::as_written() const {
  if (node_->is_integer()) return static_cast<double>(node_->as_integer()->get());
  if (node_->is_floating_point()) return node_->as_floating_point()->get();
  return {};
}

std::string TomlValue::text() const { return fmt::format("{:g}", as_written().value_or(NAN)); }

double TomlValue::number(std::string_view otherwise) const {
  const double si = unit_ != nullptr ? unit_->si : 1.0;
  const std::optional<double> value = as_written();
  const std::string wanted = range_text(quantity_.limits, value.value_or(NAN), si);
  if (!value) fail(fmt::format("has another type than wanted: {}{}", wanted, otherwise));
  if (contain(quantity_.limits, *value * si)) return *value * si;
  fail(fmt::format("is {:g}: {}{}{}", *value, wanted, otherwise,
                   likely_intent(likely_keys([](double) { return true; }))));
}

std::vector<std::string> TomlValue::likely_keys(
    const std::function<bool(double si)>& pleases) const {
  const double value = as_written().value_or(0.0);
  std::vector<std::string> keys;
  for (const Unit* unit : quantity_.units) {
    if (unit == nullptr || unit == unit_ || value == 0.0) continue;
    const double si = value * unit->si;
    if (!contain(quantity_.limits, si) || !pleases(si)) continue;
    keys.push_back(in_quotes(key_of(quantity_, *unit)));
  }
  return keys;
}

std::vector<TomlValue> TomlValue::entries(std::size_t count, std::string_view otherwise) const {
  if (!is_array() || size() != count) {
    fail(fmt::format("must be {} entries{}", count, otherwise));
  }
  std::vector<TomlValue> values;
  for (const toml::node& entry : *node_->as_array()) {
    values.emplace_back(*document_, *key_, quantity_, unit_, entry);
  }
  return values;
}

std::vector<double> TomlValue::numbers(std::size_t count, std::string_view otherwise) const {
  std::vector<double> values;
  for (const TomlValue& entry : entries(count, otherwise)) {
    values.push_back(entry.number(otherwise));
  }
  return values;
}

Eigen::Vector3d TomlValue::vector3(std::string_view otherwise) const {
  return Eigen::Vector3d(numbers(3, otherwise).data());
}

void TomlValue::fail(const std::string& what) const {
  document_->fail(node_->source(), in_quotes(key()) + " " + what);
}

void TomlValue::fail_at_key(const std::string& what) const {
  document_->fail(key_->source(), in_quotes(key()) + " " + what);
}

const toml::node* TomlSection::declare(std::string_view key) {
  declared_.push_back({std::string(key), {std::string(key)}});
  return table_.get(key);
}

std::optional<TomlValue> TomlSection::value(const Quantity& quantity) {
  declared_.push_back({std::string(quantity.name), keys_of(quantity)});
  std::optional<TomlValue> found;
  for (const auto& [key, node] : table_) {
    const auto& keys = declared_.back().keys;
    const auto at = std::find(keys.begin(), keys.end(), key.str());
    if (at == keys.end()) continue;
    if (found) {
      document_.fail(key.source(), in_quotes(key.str()) + " and " + in_quotes(found->key()) +
                                       " are the same quantity: give one");
    }
    const Unit* unit = quantity.units[static_cast<std::size_t>(at - keys.begin())];
    found.emplace(document_, key, quantity, unit, node);
  }
  return found;
}

std::optional<double> TomlSection::number(const Quantity& quantity) {
  const auto found = value(quantity);
  if (!found) return {};
  return found->number();
}

template <class T>
std::optional<T> TomlSection::of_type(std::string_view key, const std::string& otherwise) {
  const toml::node* node = declare(key);
  if (node == nullptr) return {};
  if (const toml::value<T>* value = node->as<T>()) return value->get();
  fail_at(key, otherwise);
}

std::optional<std::int64_t> TomlSection::integer(std::string_view key, std::int64_t low,
                                                 std::int64_t high) {
  const std::string wanted = fmt::format("must be a whole number from {} to {}", low, high);
  const auto value = of_type<std::int64_t>(key, wanted);
  if (!value || (*value >= low && *value <= high)) return value;
  fail_at(key, fmt::format("is {}: {}", *value, wanted));
}

std::optional<bool> TomlSection::boolean(std::string_view key) {
  return of_type<bool>(key, "must be true or false");
}

std::optional<std::string> TomlSection::text(std::string_view key) {
  return of_type<std::string>(key, "must be text in quotes");
}

void TomlSection::fail_unknown_word(std::string_view key, std::string_view given,
                                    std::span<const std::string_view> accepted) const {
  fail_at(key, "is unknown: " + in_quotes(given) + ": " + did_you_mean(given, accepted));
}

void TomlSection::read_table(const toml::table& table, std::string_view key, const Reader& read) {
  TomlSection section(document_, table, std::string(key));
  read(section);
  section.finish();
}

bool TomlSection::table(std::string_view key, const Reader& read) {
  const toml::node* node = declare(key);
  if (node == nullptr) return false;
  if (!node->is_table()) fail_at(key, fmt::format("must be a section: [{}]", key));
  read_table(*node->as_table(), key, read);
  return true;
}

std::size_t TomlSection::tables(std::string_view key, const Reader& read) {
  const toml::node* node = declare(key);
  if (node == nullptr) return 0;
  const toml::array* array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    fail_at(key, fmt::format("must be a list of sections: [[{}]]", key));
  }
  for (const toml::node& entry : *array) read_table(*entry.as_table(), key, read);
  return array->size();
}

void TomlSection::fail(const std::string& what) const { document_.fail(table_.source(), what); }

void TomlSection::fail_at(std::string_view key, const std::string& what) const {
  const toml::node* node = table_.get(key);
  document_.fail(node != nullptr ? node->source() : table_.source(), in_quotes(key) + " " + what);
}

bool TomlSection::is_declared(std::string_view key) const {
  return std::any_of(declared_.begin(), declared_.end(), [key](const Declared& d) {
    return std::find(d.keys.begin(), d.keys.end(), key) != d.keys.end();
  });
}

void TomlSection::fail_missing() const {
  const Declared& wanted = declared_.back();
  const std::string& first = wanted.keys.front();
  for (const auto& [key, node] : table_) {
    const bool is_near =
        key.str() == wanted.name || 3 * edit_distance(key.str(), first) <= first.size();
    if (is_near && !is_declared(key.str())) fail_unknown(key);
  }
  fail(fmt::format("{} needs {}", name_.empty() ? "the file" : "[" + name_ + "]",
                   fmt::join(wanted.keys, " or ")));
}

void TomlSection::fail_unknown(const toml::key& key) const {
  const std::string unknown = fmt::format("unknown key {}: ", in_quotes(key.str()));
  std::vector<std::string_view> accepted;
  for (const Declared& declared : declared_) {
    if (declared.name == key.str()) {
      document_.fail(key.source(), fmt::format("{}it needs its unit: {}", unknown,
                                               fmt::join(declared.keys, ", ")));
    }
    accepted.insert(accepted.end(), declared.keys.begin(), declared.keys.end());
  }
  document_.fail(key.source(), unknown + did_you_mean(key.str(), accepted));
}

void TomlSection::finish() const {
  for (const auto& [key, node] : table_) {
    if (!is_declared(key.str())) fail_unknown(key);
  }
}

TomlDocument TomlDocument::from_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  // A directory opens but does not read; neither does an empty file.
  if (!file || !(text << file.rdbuf())) {
    throw Error(path.string() + ": cannot be read, or is empty");
  }
  return from_text(text.str(), path.string());
}

TomlDocument TomlDocument::from_text(std::string_view text, std::string name) {
  TomlDocument document(std::move(name));
  if (const std::size_t at = find_deep_key(text); at != std::string_view::npos) {
    const auto line =
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw Error(fmt::format("{}:{}: a key of more than 32 parts with dots between; shorten it",
                            document.name_, line));
  }
  try {
    document.root_ = toml::parse(text, document.name_);
  } catch (const toml::parse_error& error) {
    document.fail(error.source(), std::string(error.description()));
  }
  return document;
}

void TomlDocument::read(const TomlSection::Reader& read) const {
  TomlSection root(*this, root_, "");
  read(root);
  root.finish();
}

void TomlDocument::fail(const toml::source_region& where, const std::string& what) const {
  throw Error(fmt::format("{}:{}:{}: {}", name_, where.begin.line, where.begin.column, what));
}

}  // namespace leeway::sim
