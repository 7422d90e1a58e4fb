/// @file
/// Strict reading of TOML. A key is declared by being asked for; what was never asked for is an
/// error, as is everything that is not what was asked for. Each message begins with
/// name:line:column and says what to write instead.
///
///     const TomlDocument document = TomlDocument::from_file(path);
///     document.read([&](TomlSection& root) {
///       scene.duration_s = root.required(root.number(kDuration));
///       root.table("gnss", [&](TomlSection& gnss) { .. });
///     });
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "leeway/earth/fields.hpp"
#include "leeway/earth/units.hpp"

namespace leeway::sim {

/// A quantity and the units it may be given in; its keys are name_unit, as in bias_sigma_mg.
/// Without units the key is the name alone.
struct Quantity {
  std::string_view name{};
  std::array<const Unit*, 4> units{};  ///< the rest null
  Range limits{};                      ///< in SI
};

/// "; did you mean 'bias_sigma_mg' or 'bias_sigma_ug'?", or nothing for no keys.
std::string likely_intent(const std::vector<std::string>& quoted_keys);

class TomlDocument;

/// What a key was set to.
class TomlValue {
 public:
  TomlValue(const TomlDocument& document, const toml::key& key, const Quantity& quantity,
            const Unit* unit, const toml::node& node)
      : document_(&document), key_(&key), quantity_(quantity), unit_(unit), node_(&node) {}

  std::string_view key() const { return key_->str(); }
  std::string text() const;  ///< of a number that is one, as messages show it
  bool is_array() const { return node_->is_array(); }
  std::size_t size() const;  ///< of an array, else 0

  /// In SI. @throws Error unless a number within the limits; the message names another unit of the
  /// quantity in which the same number would be within them.
  /// @param otherwise  what else the value could be, for the message: ", or 3 x 3"
  double number(std::string_view otherwise = "") const;

  /// The keys, in quotes, under which the same number would be within the limits and pleases.
  std::vector<std::string> likely_keys(const std::function<bool(double si)>& pleases) const;

  /// The entries of an array of this size.
  std::vector<TomlValue> entries(std::size_t count, std::string_view otherwise = "") const;
  std::vector<double> numbers(std::size_t count, std::string_view otherwise = "") const;
  Eigen::Vector3d vector3(std::string_view otherwise = "") const;

  [[noreturn]] void fail(const std::string& what) const;         ///< at the value
  [[noreturn]] void fail_at_key(const std::string& what) const;  ///< that it should be there or not

 private:
  std::optional<double> as_written() const;

  const TomlDocument* document_;
  const toml::key* key_;
  Quantity quantity_;
  const Unit* unit_;
  const toml::node* node_;
};

/// A table, while it is read. Every getter declares its key; an absent key is no value.
class TomlSection {
 public:
  TomlSection(const TomlDocument& document, const toml::table& table, std::string name)
      : document_(document), table_(table), name_(std::move(name)) {}

  std::optional<TomlValue> value(const Quantity& quantity);
  std::optional<double> number(const Quantity& quantity);  ///< in SI
  std::optional<std::int64_t> integer(std::string_view key, std::int64_t low, std::int64_t high);
  std::optional<bool> boolean(std::string_view key);
  std::optional<std::string> text(std::string_view key);
  /// One of an enum's names.
  template <NamedEnum Enum>
  std::optional<Enum> choice(std::string_view key) {
    const std::optional<std::string> given = text(key);
    if (!given) return {};
    const std::optional<Enum> value = from_name<Enum>(*given);
    if (!value) fail_unknown_word(key, *given, kNames<Enum>);
    return value;
  }

  using Reader = std::function<void(TomlSection&)>;
  bool table(std::string_view key, const Reader& read);          ///< @returns whether it is there
  std::size_t tables(std::string_view key, const Reader& read);  ///< [[key]]; @returns how many

  /// Whether the key is there. Does not declare it.
  bool has(std::string_view key) const { return table_.contains(key); }

  /// For the getter just called: section.required(section.number(kDuration)).
  template <class Value>
  Value required(std::optional<Value> value) const {
    if (!value) fail_missing();
    return *std::move(value);
  }

  [[noreturn]] void fail(const std::string& what) const;  ///< at the head of the section
  [[noreturn]] void fail_at(std::string_view key, const std::string& what) const;
  [[noreturn]] void fail_unknown_word(std::string_view key, std::string_view given,
                                      std::span<const std::string_view> accepted) const;

  /// @throws Error when there is a key that nobody asked for. TomlDocument::read and table call it.
  void finish() const;

 private:
  struct Declared {
    std::string name;                 // of the quantity
    std::vector<std::string> keys{};  // one for each unit
  };

  const toml::node* declare(std::string_view key);
  template <class T>
  std::optional<T> of_type(std::string_view key, const std::string& otherwise);
  void read_table(const toml::table& table, std::string_view key, const Reader& read);
  bool is_declared(std::string_view key) const;
  [[noreturn]] void fail_missing() const;
  [[noreturn]] void fail_unknown(const toml::key& key) const;

  const TomlDocument& document_;
  const toml::table& table_;
  std::string name_;
  std::vector<Declared> declared_{};
};

class TomlDocument {
 public:
  /// @throws Error when it cannot be read, is empty, or is no TOML.
  static TomlDocument from_file(const std::filesystem::path& path);
  /// @param name  what messages call it
  static TomlDocument from_text(std::string_view text, std::string name);

  void read(const TomlSection::Reader& read) const;

  [[noreturn]] void fail(const toml::source_region& where, const std::string& what) const;

 private:
  explicit TomlDocument(std::string name) : name_(std::move(name)) {}

  std::string name_;
  toml::table root_{};
};

}  // namespace leeway::sim
