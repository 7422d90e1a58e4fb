#include <cmath>

#include "leeway/sim/trials/drift.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/files/output_files.hpp"
#include "sim/cli/pages/series_table.hpp"

namespace leeway::cli {
namespace {

using sim::DriftReading;

struct DriftChoice {
  sim::DriftConfig config{};
  std::filesystem::path curves{};
  Output output{};
};

constexpr const char* kWhyTheyDiffer =
    "Why they differ. The paper's cells are, in effect, 0.866 b t^2: the low end b of the\n"
    "accelerometer drift on all three axes at once, one run at rest, the 3-D norm, the gyro drift\n"
    "left out; those assumptions give the second column. The complete model draws every bias of\n"
    "both triads for each trial (1 sigma: the low end, the geometric mean or the high end of\n"
    "Table 1), adds the noise, and gives the RMS of the 3-D error, in brackets the range of 95 % "
    "of\n"
    "the trials. The paper's automotive cell contradicts its own gyro drift of 5e-4 rad/s, which\n"
    "tilts the platform and adds an error that grows with t^3.\n";

/// Three significant digits.
std::string metres(double value) {
  if (!std::isfinite(value)) return "-";
  const int decimals = value < 1.0 ? 3 : value < 10.0 ? 2 : value < 100.0 ? 1 : 0;
  return number(value, decimals);
}

const sim::DriftRow& row(const sim::DriftStudy& study, ImuClass imu, DriftReading reading,
                         RangeEnd range) {
  return *std::find_if(study.rows.begin(), study.rows.end(), [=](const sim::DriftRow& r) {
    return r.imu == imu && r.reading == reading && r.range == range;
  });
}

template <class Cell>
void print_table(const sim::DriftStudy& study, const Cell& cell) {
  Table table({"<class", "paper", "its assumptions", "complete: low", "mid", "high"});
  for (const ImuClass imu : kAll<ImuClass>) {
    std::vector<std::string> cells{
        std::string(name(imu)), cell(row(study, imu, DriftReading::kPaper, RangeEnd::kLow)),
        cell(row(study, imu, DriftReading::kPaperAssumptions, RangeEnd::kLow))};
    for (const RangeEnd range : kAll<RangeEnd>) {
      cells.push_back(cell(row(study, imu, DriftReading::kComplete, range)));
    }
    table.add(std::move(cells));
  }
  table.print();
}

void print_tables(const DriftChoice& options, const sim::DriftStudy& study) {
  const sim::DriftConfig& c = options.config;
  fmt::print("Free-inertial drift from a perfect start, at rest at latitude {} deg\n",
             c.latitude_deg);
  fmt::print("({} trials, seed {}, IMU at {} Hz)\n\n", c.trials, c.seed, c.imu_rate_hz);
  fmt::print("Position error after 100 s, m\n");
  print_table(study, [](const sim::DriftRow& r) {
    const std::string error = metres(r.error_100s_m);
    return r.reading != DriftReading::kComplete
               ? error
               : fmt::format("{} [{}, {}]", error, metres(r.error_100s_p2_5_m),
                             metres(r.error_100s_p97_5_m));
  });
  fmt::print("\nTime to an error of 100 m, s\n");
  print_table(study, [](const sim::DriftRow& r) { return number(r.time_to_100m_s, 0); });
  fmt::print("\n{}", kWhyTheyDiffer);
  if (!options.curves.empty()) fmt::print("\nCurves: {}\n", options.curves.string());
}

Json results_json(const sim::DriftStudy& study) {
  Json results = Json::array();
  for (const sim::DriftRow& r : study.rows) {
    results.push_back({{"imu", name(r.imu)},
                       {"range", name(r.range)},
                       {"reading", name(r.reading)},
                       {"error_100s_m", r.error_100s_m},
                       {"error_100s_p2_5_m", r.error_100s_p2_5_m},
                       {"error_100s_p97_5_m", r.error_100s_p97_5_m},
                       {"time_to_100m_s", r.time_to_100m_s}});
  }
  return results;
}

/// A column for each curve, named as tactical_mid_complete_m, and its band. A curve that has ended
/// leaves its fields empty.
std::string curves_csv(const sim::DriftStudy& study) {
  std::string csv = "t_s";
  std::size_t rows = 0;
  for (const sim::DriftCurve& curve : study.curves) {
    const std::string stem =
        fmt::format(",{}_{}_{}", name(curve.imu), name(curve.range), name(curve.reading));
    csv += stem + "_m";
    if (curve.reading == DriftReading::kComplete) csv += stem + "_p2_5_m" + stem + "_p97_5_m";
    rows = std::max(rows, curve.t_s.size());
  }
  for (std::size_t k = 0; k < rows; ++k) {
    csv += fmt::format("\n{}", k);
    for (const sim::DriftCurve& curve : study.curves) {
      const bool has_band = curve.reading == DriftReading::kComplete;
      if (k >= curve.t_s.size()) {
        csv += has_band ? ",,," : ",";
        continue;
      }
      csv += fmt::format(",{:.6g}", curve.error_m[k]);
      if (has_band) csv += fmt::format(",{:.6g},{:.6g}", curve.p2_5_m[k], curve.p97_5_m[k]);
    }
  }
  return csv + "\n";
}

/// Tables curve/IMU/RANGE/READING.
Json curves_json(const sim::DriftStudy& study) {
  Json curves = Json::object();
  for (const sim::DriftCurve& curve : study.curves) {
    SeriesTable table({"t_s", "error_m", "p2_5_m", "p97_5_m"});
    const auto at = [](const std::vector<double>& values, std::size_t k) {
      return k < values.size() ? values[k] : std::numeric_limits<double>::quiet_NaN();
    };
    for (std::size_t k = 0; k < curve.t_s.size(); ++k) {
      table.add({curve.t_s[k], curve.error_m[k], at(curve.p2_5_m, k), at(curve.p97_5_m, k)});
    }
    curves[fmt::format("curve/{}/{}/{}", name(curve.imu), name(curve.range), name(curve.reading))] =
        table.json();
  }
  return curves;
}

sim::DriftStudy study_of(const sim::DriftConfig& config) {
  Progress progress("drift");
  return sim::drift_study(config, std::ref(progress));
}

int run(const DriftChoice& options) {
  const sim::DriftConfig& c = options.config;
  const sim::DriftStudy study = study_of(c);
  if (!options.curves.empty()) write_file(options.curves, curves_csv(study));
  Json input{{"trials", c.trials},
             {"seed", c.seed},
             {"latitude_deg", c.latitude_deg},
             {"imu_rate_hz", c.imu_rate_hz}};
  show(
      options.output, answer_json("drift", std::move(input), results_json(study)),
      [&] { print_tables(options, study); }, [&] { return curves_json(study); });
  return kSuccess;
}

void add_options(CLI::App& app, DriftChoice& options) {
  sim::DriftConfig& c = options.config;
  add_default_option(app, "--trials", c.trials, "Monte Carlo trials of a cell");
  add_default_option(app, "--seed", c.seed, "of the random numbers");
  add_default_option(app, "--latitude", c.latitude_deg, "deg")->type_name("DEG");
  add_default_option(app, "--imu-rate-hz", c.imu_rate_hz, "IMU rate, Hz")->type_name("HZ");
  add_output_file(app, "--curves", options.curves, "write error against time as CSV (m, s)",
                  "FILE.csv");
  add_output_options(app, options.output);
}

const Command<DriftChoice> kDrift{
    "drift", "How far each class of IMU drifts on its own, from a perfect start at rest",
    "Example:\n  leeway drift --trials 500 --curves drift.csv", add_options, run};

}  // namespace
}  // namespace leeway::cli
