#include "sim/cli/options.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>

#include "leeway/sim/sensors/imu_catalogue.hpp"
#include "leeway/sim/sensors/imu_class_name.hpp"
#include "leeway/sim/sensors/imu_model_file.hpp"

namespace leeway::cli {
namespace {

constexpr std::string_view kMems = "automotive-mems";

/// @returns whether the text is exactly so many finite numbers.
bool parse_numbers(std::string_view text, double* values, int count) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < count; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return false;
    const auto [next, error] = std::from_chars(at, end, values[i]);
    if (error != std::errc{} || !std::isfinite(values[i])) return false;
    at = next;
  }
  return at == end;
}

NamedImu part_named(const std::string& name) {
  const sim::ImuPart& part = sim::imu_part(name);
  return {std::string(part.name), sim::imu_model(part)};
}

CLI::Validator within(const Range& range, std::string otherwise, std::string description = "") {
  return {[range, otherwise = std::move(otherwise)](std::string& text) {
            double value = 0.0;
            const bool is_within = parse_numbers(text, &value, 1) && range.contains(value);
            return is_within ? std::string() : text + otherwise;
          },
          std::move(description)};
}

}  // namespace

template <int N>
CLI::Option* add_numbers(CLI::App& app, const std::string& name, const std::string& meaning,
                         std::optional<Eigen::Matrix<double, N, 1>>& value,
                         const std::string& description) {
  const auto parse = [&value, name, meaning](const std::string& text) {
    Eigen::Matrix<double, N, 1> numbers;
    if (!parse_numbers(text, numbers.data(), N)) {
      throw CLI::ValidationError(
          name, "'" + text + "' is not " + meaning + ": wanted numbers with commas between");
    }
    value = numbers;
  };
  return app.add_option_function<std::string>(name, parse, description)->type_name(meaning);
}

template CLI::Option* add_numbers<2>(CLI::App&, const std::string&, const std::string&,
                                     std::optional<Eigen::Vector2d>&, const std::string&);
template CLI::Option* add_numbers<3>(CLI::App&, const std::string&, const std::string&,
                                     std::optional<Eigen::Vector3d>&, const std::string&);

CLI::Validator in_range(double low, double high) {
  const std::string range = fmt::format("{:g} to {:g}", low, high);
  return within({low, high}, " is not a number from " + range, range);
}

CLI::Validator positive() { return within(kPositive, " is not above 0"); }

CLI::Validator not_negative() { return within(kNotNegative, " is below 0"); }

void add_threads_option(CLI::App& app, int& threads, const std::string& of_what) {
  add_default_option(app, "--threads", threads, of_what + "0: all processors")
      ->check(in_range(0, 1024));
}

void add_repeat_option(CLI::App& app, int& repeat) {
  add_default_option(app, "--repeat", repeat, "timed runs of each")->check(in_range(1, 1000));
}

bool is_imu_class(const std::string& imu) { return imu == kMems || from_name<ImuClass>(imu); }

void add_imu_options(CLI::App& app, ImuChoice& choice) {
  std::vector<std::string> names(kNames<ImuClass>.begin(), kNames<ImuClass>.end());
  names.emplace(names.begin(), kMems);
  CLI::Option* by_class =
      add_default_option(app, "--imu-class", choice.name,
                         "IMU error model: a car-grade MEMS part, or a class of the source "
                         "paper's Table 1")
          ->check(CLI::IsMember(names));
  CLI::Option* range = add_range_option(app, choice.range)->needs(by_class);
  CLI::Option* by_part =
      app.add_option("--imu-part", choice.part,
                     "IMU error model: a real part, STIM300 for one (leeway imu lists them)")
          ->type_name("NAME")
          ->excludes(by_class)
          ->excludes(range);
  add_file_option(app, "--imu-model", choice.model_file,
                  "IMU error model from a TOML file (docs/guide/cli.md lists its keys)")
      ->excludes(by_class)
      ->excludes(range)
      ->excludes(by_part);
}

NamedImu imu_of(const ImuChoice& choice) {
  if (!choice.model_file.empty()) {
    return {choice.model_file.string(), sim::read_imu_model(choice.model_file)};
  }
  return choice.part.empty() ? imu_named(choice.name, choice.range) : part_named(choice.part);
}

NamedImu imu_named(const std::string& name, RangeEnd range) {
  if (name == kMems) return {name, automotive_mems_model()};
  const auto imu = from_name<ImuClass>(name);
  if (!imu) return part_named(name);
  return {sim::imu_name({*imu, range}), imu_class_model(*imu, range)};
}

}  // namespace leeway::cli
