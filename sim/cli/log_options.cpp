#include "sim/cli/log_options.hpp"

#include <cmath>
#include <cstdlib>

#include "sim/tools/toml_reader.hpp"

namespace leeway::cli {
namespace {

constexpr sim::Quantity kTimeOffset{"time_offset_s", {}, {-1e10, 1e10}};
constexpr sim::Quantity kGnssSigma{"gnss_sigma", {}, {1e-6, 1e5}};

void set_text(sim::TomlSection& section, std::string_view key, std::string& value) {
  if (auto text = section.text(key)) value = *std::move(text);
}

void read_format(sim::TomlSection& section, LogFormat& format) {
  set_text(section, "layout", format.layout);
  set_text(section, "time_unit", format.time_unit);
  set_text(section, "gyro_unit", format.gyro_unit);
  set_text(section, "accel_unit", format.accel_unit);
  set_text(section, "axes", format.axes);
  if (const auto sigma = section.value(kGnssSigma)) {
    format.gnss_sigma = sigma->numbers(sigma->size() == 2 ? 2 : 4, ", or 2");
  }
  section.table("columns", [&](sim::TomlSection& columns) {
    for (const std::string& name : log_column_names()) {
      if (auto theirs = columns.text(name)) format.columns[name] = *std::move(theirs);
    }
  });
}

LogForms read_file(const std::filesystem::path& path) {
  LogForms forms;
  sim::TomlDocument::from_file(path).read([&](sim::TomlSection& root) {
    root.table("imu", [&](sim::TomlSection& section) { read_format(section, forms.imu); });
    root.table("gnss", [&](sim::TomlSection& section) {
      read_format(section, forms.gnss);
      if (const auto offset = section.value(kTimeOffset))
        forms.gnss_time_offset_s = offset->number();
    });
  });
  return forms;
}

void add_column(LogFormat& format, const std::string& option) {
  const std::size_t at = option.find('=');
  const std::string ours = option.substr(0, at);
  const auto known = log_column_names();
  if (at == std::string::npos || at + 1 == option.size() ||
      std::find(known.begin(), known.end(), ours) == known.end()) {
    throw Error("--column '" + option + "': wanted NAME=NAME-IN-LOG, with a name of " +
                fmt::format("{}", fmt::join(known, ", ")));
  }
  format.columns[ours] = option.substr(at + 1);
}

void set_time_offset(LogForms& forms, const std::string& option) {
  forms.is_time_offset_to_find = option == "auto";
  if (option.empty() || forms.is_time_offset_to_find) return;
  char* end = nullptr;
  forms.gnss_time_offset_s = std::strtod(option.c_str(), &end);
  if (*end != '\0' || !(std::abs(forms.gnss_time_offset_s) <= 1e10)) {
    throw Error("--gnss-time-offset-s '" + option + "': wanted seconds, or auto");
  }
}

void replace(std::string& value, const std::string& given) {
  if (!given.empty()) value = given;
}

}  // namespace

void add_log_form_options(CLI::App& app, LogForm& form) {
  add_file_option(app, "--log-format", form.file,
                  "TOML with the form of the logs of a recorder: [imu] and [gnss] with layout, "
                  "time_unit, gyro_unit, accel_unit, axes, gnss_sigma, [imu.columns], "
                  "[gnss.columns] (docs/guide/log-formats.md)");
  const auto word = [&app](const char* name, std::string& value, const char* meaning,
                           const char* description) {
    app.add_option(name, value, description)->type_name(meaning);
  };
  word("--imu-layout", form.imu_layout, "NAME", "layout of the IMU log, in place of telling it");
  word("--gnss-layout", form.gnss_layout, "NAME", "layout of the GNSS log");
  word("--time-unit", form.time_unit, "UNIT",
       "unit of the times in CSV logs: s, ms, us, ns; or of the IMU's and the receiver's: ms,s");
  word("--gyro-unit", form.gyro_unit, "UNIT", "unit of rates in a CSV: rad/s, deg/s, mdps");
  word("--accel-unit", form.accel_unit, "UNIT", "unit of specific force in a CSV: m/s^2, g, mg");
  word("--axes", form.axes, "AXES",
       "where x, y, z of the IMU log point: frd (forward, right, down), flu, rfu (also enu), ..");
  app.add_option("--column", form.columns,
                 "name of a column in the log: gx=wx, t=stamp; may be repeated")
      ->type_name("NAME=NAME-IN-LOG");
  app.add_option("--gnss-sigma", form.gnss_sigma,
                 "standard deviations in place of the GNSS log's: horizontal and vertical, of "
                 "position (m), and maybe of velocity (m/s)")
      ->delimiter(',')
      ->expected(2, 4)
      ->check(in_range(1e-6, 1e5))
      ->type_name("H,V[,VH,VV]");
  word("--gnss-time-offset-s", form.gnss_time_offset, "S|auto",
       "added to the times of the GNSS log, s; auto: found from the turns of both logs");
}

LogForms log_forms(const LogForm& form) {
  LogForms forms = form.file.empty() ? LogForms{} : read_file(form.file);
  const std::size_t comma = form.time_unit.find(',');
  replace(forms.imu.time_unit, form.time_unit.substr(0, comma));
  replace(forms.gnss.time_unit,
          comma == std::string::npos ? form.time_unit : form.time_unit.substr(comma + 1));
  replace(forms.imu.layout, form.imu_layout);
  replace(forms.gnss.layout, form.gnss_layout);
  replace(forms.imu.gyro_unit, form.gyro_unit);
  replace(forms.imu.accel_unit, form.accel_unit);
  replace(forms.imu.axes, form.axes);
  for (const std::string& column : form.columns) {
    add_column(forms.imu, column);
    add_column(forms.gnss, column);
  }
  if (form.gnss_sigma.size() == 3) throw Error("--gnss-sigma: give two numbers or four");
  set_time_offset(forms, form.gnss_time_offset);
  if (!form.gnss_sigma.empty()) forms.gnss.gnss_sigma = form.gnss_sigma;
  return forms;
}

}  // namespace leeway::cli
