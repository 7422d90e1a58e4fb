#include <cmath>

#include "leeway/sim/sensors/imu_catalogue.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/options.hpp"

namespace leeway::cli {
namespace {

using sim::DatasheetValue;
using sim::ImuPart;
using sim::Meaning;
using sim::Triad;

struct ShownChoice {
  std::string name{};
  RangeEnd range{RangeEnd::kMid};
  Output output{};
};

/// What is shown of one IMU, of the catalogue or not.
struct Shown {
  NamedImu imu{};
  const ImuPart* part{};  ///< null when it is not of the catalogue
  std::vector<DatasheetValue> values{};
};

Shown shown(const ShownChoice& options) {
  const std::string& name = options.name;
  const bool is_class = is_imu_class(name);
  const bool is_file = name.ends_with(".toml") || std::filesystem::exists(name);
  const bool is_part = !is_class && !is_file;
  Shown s{is_class || is_part ? imu_named(name, options.range) : imu_of({.model_file = name})};
  if (is_part) s.part = &sim::imu_part(name);
  s.values = is_part ? std::vector(s.part->values.begin(), s.part->values.end())
                     : sim::datasheet_values(s.imu.model);
  return s;
}

/// "4.5 deg/h = 4.5 / 3600 deg/s = 2.182e-05 rad/s, / 0.617 = 3.534e-05 rad/s"
std::string conversion(const DatasheetValue& value) {
  const std::string text = working(value.printed, *value.unit);
  const auto step = [&](const char* divisor) {
    return fmt::format("{}, / {} = {:.4g} {}", text, divisor, value.si(), value.unit->si_symbol);
  };
  if (value.meaning == Meaning::kMaximum) return step("3");
  return value.meaning == Meaning::kAllanMinimum ? step("0.617") : text;
}

std::string statement(const DatasheetValue& value) {
  const std::string_view meaning = name(value.meaning);
  if (meaning.empty()) return std::string(value.quantity);
  return fmt::format("{} ({})", value.quantity, meaning);
}

/// Errors of a model file that have no row in the table.
std::string further_errors(const TriadErrorModel& triad, const Eigen::Matrix3d& g_sensitivity) {
  std::string text;
  const auto add = [&text](bool has, const char* what) {
    if (has) text += (text.empty() ? "" : ", ") + std::string(what);
  };
  add(!triad.bias.isZero(0.0), "a known bias");
  add(triad.M != Eigen::Matrix3d::Identity(), "known scale factors or misalignments");
  add(!g_sensitivity.isZero(0.0), "a known g-sensitivity");
  add(triad.quantum > 0.0, "quantization");
  add(std::isfinite(triad.range), "saturation");
  return text;
}

void print_values(const Shown& s, Triad triad) {
  fmt::print("\n{}\n", triad == Triad::kGyro ? "Gyros" : "Accelerometers");
  Table table({"<field", "<conversion", s.part != nullptr ? "<in the datasheet" : "<"});
  for (const DatasheetValue& value : s.values) {
    if (value.triad != triad) continue;
    table.add({std::string(name(value.field)), conversion(value), statement(value)});
  }
  table.print();
  const ImuErrorModel& m = s.imu.model;
  const std::string further = triad == Triad::kGyro
                                  ? further_errors(m.gyro, m.G_g_radps_per_mps2)
                                  : further_errors(m.accelerometer, Eigen::Matrix3d::Zero());
  if (!further.empty()) fmt::print("  and {}\n", further);
}

void print_class(const ImuErrorModel& model) {
  const ImuClassification c = classify(model);
  fmt::print(
      "\nClass (source paper's Table 1): {}, the worst of\n"
      "  accelerometer drift {}, gyro drift {}, accelerometer noise {}, gyro noise {}\n"
      "  (the range nearest on a logarithmic scale; drift: turn-on and in-run bias together)\n",
      name(c.overall), name(c.accelerometer_drift), name(c.gyro_drift), name(c.accelerometer_noise),
      name(c.gyro_noise));
}

void print_tables(const Shown& s) {
  if (s.part != nullptr) {
    fmt::print("{}, {}: {} grade, gyros and accelerometers: {}\n", s.part->name,
               s.part->manufacturer, name(s.part->grade), s.part->technology);
    fmt::print("Datasheet: {}\nNumbers compared with a copy or transcript of it: {}\n",
               s.part->datasheet, s.part->checked);
  } else {
    fmt::print("{}\n", s.imu.name);
  }
  print_values(s, Triad::kGyro);
  print_values(s, Triad::kAccelerometer);
  if (s.part != nullptr) {
    fmt::print(
        "\nWhat has no row is not printed there and zero in the model. A maximum is three sigma; "
        "an\n"
        "Allan minimum is 0.617 of the sigma of a Gauss-Markov process. Assumed: printed "
        "nowhere.\n");
  }
  print_class(s.imu.model);
}

std::size_t assumed(const ImuPart& part) {
  return static_cast<std::size_t>(
      std::count_if(part.values.begin(), part.values.end(),
                    [](const DatasheetValue& v) { return v.meaning == Meaning::kAssumed; }));
}

void print_list() {
  Table table({"<part", "<maker", "<grade", "<class", "gyro bias, deg/h", "noise, deg/sqrt(h)",
               "acc. bias, mg", "noise, ug/sqrt(Hz)", "assumed"});
  for (const ImuPart& part : sim::imu_parts()) {
    const ImuErrorModel m = imu_model(part);
    const auto in = [](double si, const Unit& unit) { return fmt::format("{:.3g}", si / unit.si); };
    table.add(
        {std::string(part.name), std::string(part.manufacturer), std::string(name(part.grade)),
         std::string(name(classify(m).overall)), in(m.gyro.bias_sigma, units::kDegPerH),
         in(m.gyro.noise_density, units::kDegPerSqrtH), in(m.accelerometer.bias_sigma, units::kMg),
         in(m.accelerometer.noise_density, units::kUgPerSqrtHz), std::to_string(assumed(part))});
  }
  table.print();
  fmt::print(
      "\nBias: at turn-on, 1 sigma. Class: of the source paper's Table 1. Assumed: so many numbers "
      "of\n"
      "the model are printed in no datasheet; leeway imu NAME says which, and where the rest is "
      "from.\n");
}

Json triad_json(const TriadErrorModel& triad, const std::string& unit) {
  return {{"bias_sigma_" + unit, triad.bias_sigma},
          {"in_run_sigma_" + unit, triad.in_run.sigma},
          {"in_run_tau_s", triad.in_run.tau_s},
          {"noise_" + unit + "_per_sqrt_hz", triad.noise_density},
          {"scale_sigma", triad.scale_sigma},
          {"misalignment_sigma_rad", triad.misalignment_sigma_rad}};
}

Json class_json(const ImuErrorModel& model) {
  const ImuClassification c = classify(model);
  return {{"overall", name(c.overall)},
          {"accelerometer_drift", name(c.accelerometer_drift)},
          {"gyro_drift", name(c.gyro_drift)},
          {"accelerometer_noise", name(c.accelerometer_noise)},
          {"gyro_noise", name(c.gyro_noise)}};
}

Json part_json(const ImuPart& part) {
  return {{"name", part.name},           {"manufacturer", part.manufacturer},
          {"grade", name(part.grade)},   {"technology", part.technology},
          {"datasheet", part.datasheet}, {"compared_with_datasheet", part.checked}};
}

Json shown_json(const Shown& s) {
  Json json = s.part != nullptr ? part_json(*s.part) : Json{{"name", s.imu.name}};
  json["class"] = class_json(s.imu.model);
  json["model"] = {{"accelerometer", triad_json(s.imu.model.accelerometer, "mps2")},
                   {"gyro", triad_json(s.imu.model.gyro, "radps")}};
  json["model"]["gyro"]["g_sensitivity_sigma_radps_per_mps2"] =
      s.imu.model.G_g_sigma_radps_per_mps2;
  json["values"] = Json::array();
  for (const DatasheetValue& v : s.values) {
    json["values"].push_back({{"sensor", name(v.triad)},
                              {"field", name(v.field)},
                              {"printed", v.printed},
                              {"unit", v.unit->symbol},
                              {"si", v.si()},
                              {"si_unit", v.unit->si_symbol},
                              {"quantity", v.quantity},
                              {"meaning", name(v.meaning)},
                              {"conversion", conversion(v)}});
  }
  return json;
}

Json list_json() {
  Json list = Json::array();
  for (const ImuPart& part : sim::imu_parts()) {
    Json json = part_json(part);
    json["class"] = class_json(imu_model(part));
    json["assumed"] = assumed(part);
    list.push_back(std::move(json));
  }
  return list;
}

int run(const ShownChoice& options) {
  if (options.name.empty()) {
    show(options.output, answer_json("imu", Json::object(), list_json()), print_list);
    return kSuccess;
  }
  const Shown s = shown(options);
  show(options.output,
       answer_json("imu", {{"name", options.name}, {"range", name(options.range)}}, shown_json(s)),
       [&] { print_tables(s); });
  return kSuccess;
}

void add_options(CLI::App& app, ShownChoice& options) {
  CLI::Option* imu =
      app.add_option("name", options.name,
                     "part of the catalogue, class, automotive-mems or a TOML model file; without "
                     "it, the list of parts");
  add_range_option(app, options.range)->needs(imu);
  add_json_option(app, options.output.json);
}

const Command<ShownChoice> kImu{
    "imu", "Error model of an IMU: its datasheet, the conversions, its class",
    "Examples:\n  leeway imu STIM300\n  leeway imu tactical --range high", add_options, run};

}  // namespace
}  // namespace leeway::cli
