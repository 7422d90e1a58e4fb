/// @file
/// The folder of a phone's recording: a CSV for each sensor. Private to the log readers.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/logs/log_format.hpp"
#include "lib/logs/layouts/imu_layouts.hpp"
#include "lib/logs/layouts/sample_joiner.hpp"

namespace leeway {

/// Whether a path is a folder, which no other log is.
bool is_phone_folder(const std::filesystem::path& path);

/// The file with the fixes where a path is the folder of a recording, else the path itself.
/// @throws Error when the folder has none, saying what it must have.
std::filesystem::path location_of_phone(const std::filesystem::path& path);

/// Rates of one file, specific forces of another one or of two: without gravity, and gravity.
/// Samples are at the times of the rates (SampleJoiner).
class PhoneRows {
 public:
  /// @throws Error when the folder lacks a file, or its forces have no gravity, saying the remedy.
  PhoneRows(const std::filesystem::path& folder, const LogFormat& format);

  std::optional<ImuRow> next();
  LogSummary& summary() { return summary_; }
  const LogSummary& summary() const;
  std::string_view layout() const { return "phone folder"; }

 private:
  /// A vector of one file.
  struct AxesRow {
    Time time{};
    Eigen::Vector3d value{Eigen::Vector3d::Zero()};
  };
  using Axes = LogSource<AxesRow>;

  static Axes open(const std::filesystem::path& file, char quantity, const LogFormat& format);
  static void refuse_without_gravity(const std::filesystem::path& file, const LogFormat& format);
  std::optional<AxesRow> next_force();

  std::unique_ptr<Axes> rates_;
  std::unique_ptr<Axes> forces_;
  std::unique_ptr<Axes> gravity_;  // what the forces lack, or null
  SampleJoiner samples_;
  SampleJoiner sums_;  // of forces and gravity
  LogSummary summary_{};
  mutable LogSummary merged_{};
};

}  // namespace leeway
