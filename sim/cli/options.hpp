/// @file
/// Options that more than one command has.
#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "leeway/sensors/imu_error_model.hpp"

namespace leeway::cli {

/// An option of N numbers with commas between, the first of which may be negative.
/// @param meaning  what the numbers are, as --help and errors say it: "X,Y,Z"
template <int N>
CLI::Option* add_numbers(CLI::App& app, const std::string& name, const std::string& meaning,
                         std::optional<Eigen::Matrix<double, N, 1>>& value,
                         const std::string& description);

/// Refuses numbers that are not above zero.
CLI::Validator positive();

/// --threads. @param of_what  what runs on them
void add_threads_option(CLI::App& app, int& threads, const std::string& of_what = "");

/// --repeat, of commands that measure time.
void add_repeat_option(CLI::App& app, int& repeat);

/// Which IMU error model: a class with its range end, a part of the catalogue, or a file.
struct ImuChoice {
  std::string name{"automotive-mems"};
  std::string range{"mid"};
  std::string part{};
  std::filesystem::path model_file{};
};

void add_imu_options(CLI::App& app, ImuChoice& choice);

/// --range alone.
CLI::Option* add_range_option(CLI::App& app, std::string& range);

/// Whether the name is of automotive-mems or a Table 1 class.
bool is_imu_class(const std::string& name);

/// A model with the name the output calls it by.
struct NamedImu {
  std::string name{};
  ImuErrorModel model{};
};

/// @throws Error when the file is not a model or the part is not in the catalogue.
NamedImu imu_of(const ImuChoice& choice);

}  // namespace leeway::cli
