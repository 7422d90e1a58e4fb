/// @file
/// Options that more than one command has.
#pragma once

#include <spdlog/fmt/ranges.h>

#include <span>

#include "leeway/sensors/imu_class.hpp"
#include "sim/cli/answer.hpp"

namespace leeway::cli {

/// An option of N numbers with commas between, the first of which may be negative.
/// @param meaning  what the numbers are, as --help and errors say it: "X,Y,Z"
template <int N>
CLI::Option* add_numbers(CLI::App& app, const std::string& name, const std::string& meaning,
                         std::optional<Eigen::Matrix<double, N, 1>>& value,
                         const std::string& description);

/// Refuses what is no number from low to high.
CLI::Validator in_range(double low, double high);

/// Refuses numbers that are not above zero.
CLI::Validator positive();

/// Refuses negative numbers, which CLI11 wraps around where they are to be unsigned.
CLI::Validator not_negative();

/// --threads. @param of_what  what runs on them
void add_threads_option(CLI::App& app, int& threads, const std::string& of_what = "");

/// --repeat, of commands that measure time.
void add_repeat_option(CLI::App& app, int& repeat);

/// Takes a word for the enumerator that it names, one of the first `count`. A note on stderr tells
/// of an old spelling.
template <NamedEnum Enum>
CLI::Validator named(std::size_t count = kAll<Enum>.size()) {
  const auto words = std::span(kNames<Enum>).first(count);
  const std::string accepted = fmt::format("{{{}}}", fmt::join(words, ","));
  const auto parse = [count, accepted](std::string& word) {
    const std::optional<Enum> value = from_name<Enum>(word);
    const auto index = static_cast<std::size_t>(value.value_or(Enum{}));
    if (!value || index >= count) return fmt::format("{} not in {}", word, accepted);
    if (word != name(*value)) note(fmt::format("{} is now written {}", word, name(*value)));
    word = std::to_string(index);  // as CLI11 reads an enum
    return std::string();
  };
  return {parse, accepted};
}

/// Which IMU error model: a class with its range end, a part of the catalogue, or a file.
struct ImuChoice {
  std::string name{"automotive-mems"};
  RangeEnd range{RangeEnd::kMid};
  std::string part{};
  std::filesystem::path model_file{};
};

void add_imu_options(CLI::App& app, ImuChoice& choice);

/// --range alone. @param range  a RangeEnd, or an optional one
template <class Value>
CLI::Option* add_range_option(CLI::App& app, Value& range) {
  return app
      .add_option(
          "--range", range,
          "where in the range of a Table 1 class: its ends, or the geometric mean (default: mid); "
          "of marine the high end is the paper's bound, the low end a quarter of it")
      ->transform(named<RangeEnd>());
}

/// Whether the name is of automotive-mems or a Table 1 class.
bool is_imu_class(const std::string& name);

/// A model with the name the output calls it by.
struct NamedImu {
  std::string name{};
  ImuErrorModel model{};
};

/// @throws Error when the file is not a model or the part is not in the catalogue.
NamedImu imu_of(const ImuChoice& choice);

/// A class, which the range is of, or a part. @throws Error when it is neither.
NamedImu imu_named(const std::string& name, RangeEnd range);

}  // namespace leeway::cli
