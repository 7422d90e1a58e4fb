#include "leeway/sim/imu_model_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <numeric>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/earth.hpp"
#include "leeway/error.hpp"
#include "leeway/rotation.hpp"

namespace leeway::sim {
namespace {

enum class Quantity {
  kBias,
  kBiasSigma,
  kInRunSigma,
  kInRunTau,
  kNoise,
  kScale,
  kMisalignment,
  kQuantum,
  kRange,
  kGSensitivity
};
constexpr std::size_t kQuantities = 10;

/// A key of a section. Values outside low .. high, in the unit of the key, are typing errors.
struct Key {
  std::string_view name;
  Quantity quantity;
  double factor;  // to the unit of TriadErrorModel
  double low;
  double high;
};

// The unit factors, all of them.
constexpr double kMg = 1e-3 * kStandardGravityMps2;
constexpr double kUg = 1e-6 * kStandardGravityMps2;
constexpr double kPerSqrtH = 1.0 / 60.0;  // per sqrt(h) in per sqrt(s)
constexpr double kDegPerH = kRadPerDeg / 3600.0;
constexpr double kArcsec = kRadPerDeg / 3600.0;

constexpr std::array kAccelerometerKeys{
    Key{"bias_mps2", Quantity::kBias, 1.0, -20.0, 20.0},
    Key{"bias_mg", Quantity::kBias, kMg, -2e3, 2e3},
    Key{"bias_ug", Quantity::kBias, kUg, -2e6, 2e6},
    Key{"bias_sigma_mps2", Quantity::kBiasSigma, 1.0, 0.0, 10.0},
    Key{"bias_sigma_mg", Quantity::kBiasSigma, kMg, 0.0, 1e3},
    Key{"bias_sigma_ug", Quantity::kBiasSigma, kUg, 0.0, 1e6},
    Key{"in_run_sigma_mps2", Quantity::kInRunSigma, 1.0, 0.0, 10.0},
    Key{"in_run_sigma_mg", Quantity::kInRunSigma, kMg, 0.0, 1e3},
    Key{"in_run_sigma_ug", Quantity::kInRunSigma, kUg, 0.0, 1e6},
    Key{"in_run_tau_s", Quantity::kInRunTau, 1.0, 1e-3, 1e8},
    Key{"noise_ug_per_sqrt_hz", Quantity::kNoise, kUg, 0.0, 1e5},
    Key{"noise_mps_per_sqrt_h", Quantity::kNoise, kPerSqrtH, 0.0, 60.0},
    Key{"scale_ppm", Quantity::kScale, 1e-6, -2e5, 2e5},
    Key{"misalignment_mrad", Quantity::kMisalignment, 1e-3, -200.0, 200.0},
    Key{"quantum_mps", Quantity::kQuantum, 1.0, 0.0, 1.0},
    Key{"range_mps2", Quantity::kRange, 1.0, 1.0, 1e5},
    Key{"range_g", Quantity::kRange, kStandardGravityMps2, 0.1, 1e4},
};

constexpr std::array kGyroKeys{
    Key{"bias_deg_per_h", Quantity::kBias, kDegPerH, -1e5, 1e5},
    Key{"bias_deg_per_s", Quantity::kBias, kRadPerDeg, -30.0, 30.0},
    Key{"bias_radps", Quantity::kBias, 1.0, -0.5, 0.5},
    Key{"bias_sigma_deg_per_h", Quantity::kBiasSigma, kDegPerH, 0.0, 1e5},
    Key{"bias_sigma_deg_per_s", Quantity::kBiasSigma, kRadPerDeg, 0.0, 30.0},
    Key{"bias_sigma_radps", Quantity::kBiasSigma, 1.0, 0.0, 0.5},
    Key{"in_run_sigma_deg_per_h", Quantity::kInRunSigma, kDegPerH, 0.0, 1e5},
    Key{"in_run_sigma_deg_per_s", Quantity::kInRunSigma, kRadPerDeg, 0.0, 30.0},
    Key{"in_run_sigma_radps", Quantity::kInRunSigma, 1.0, 0.0, 0.5},
    Key{"in_run_tau_s", Quantity::kInRunTau, 1.0, 1e-3, 1e8},
    Key{"noise_deg_per_sqrt_h", Quantity::kNoise, kRadPerDeg* kPerSqrtH, 0.0, 100.0},
    Key{"noise_dps_per_sqrt_hz", Quantity::kNoise, kRadPerDeg, 0.0, 2.0},
    Key{"scale_ppm", Quantity::kScale, 1e-6, -2e5, 2e5},
    Key{"misalignment_mrad", Quantity::kMisalignment, 1e-3, -200.0, 200.0},
    Key{"quantum_rad", Quantity::kQuantum, 1.0, 0.0, 0.1},
    Key{"quantum_arcsec", Quantity::kQuantum, kArcsec, 0.0, 2e4},
    Key{"range_deg_per_s", Quantity::kRange, kRadPerDeg, 1.0, 1e5},
    Key{"g_sensitivity_deg_per_h_per_g", Quantity::kGSensitivity, kDegPerH / kStandardGravityMps2,
        -1e5, 1e5},
};

/// Levenshtein distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string accepted(std::span<const std::string_view> names, std::string_view wrong) {
  const auto closest = std::min_element(names.begin(), names.end(), [wrong](auto a, auto b) {
    return edit_distance(a, wrong) < edit_distance(b, wrong);
  });
  std::string text = "did you mean '" + std::string(*closest) + "'? Accepted:";
  for (const std::string_view name : names) {
    text += (name == names.front() ? " " : ", ") + std::string(name);
  }
  return text;
}

class ModelFile {
 public:
  explicit ModelFile(const std::filesystem::path& path) : path_(path.string()) {}

  ImuErrorModel read() {
    constexpr std::array<std::string_view, 2> kSections{"accelerometer", "gyro"};
    for (const auto& [name, node] : parse()) {
      if (name != kSections[0] && name != kSections[1]) {
        fail(name.source(),
             "unknown key '" + std::string(name.str()) + "': " + accepted(kSections, name.str()));
      }
      const toml::table* section = node.as_table();
      if (section == nullptr) fail(node.source(), std::string(name.str()) + " must be a section");
      if (name == kSections[0]) {
        read_section(*section, kAccelerometerKeys, model_.accelerometer);
      } else {
        read_section(*section, kGyroKeys, model_.gyro);
      }
    }
    validate(model_);
    return model_;
  }

 private:
  [[noreturn]] void fail(const toml::source_region& where, const std::string& what) const {
    throw Error(path_ + ":" + std::to_string(where.begin.line) + ":" +
                std::to_string(where.begin.column) + ": " + what);
  }

  toml::table parse() const {
    std::ifstream file(path_);
    std::ostringstream text;
    // A directory opens but does not read; an empty file is a model without errors, thus a mistake.
    if (!file || !(text << file.rdbuf())) throw Error(path_ + ": cannot be read, or is empty");
    try {
      return toml::parse(text.str(), path_);
    } catch (const toml::parse_error& error) {
      fail(error.source(), std::string(error.description()));
    }
  }

  void read_section(const toml::table& section, std::span<const Key> keys, TriadErrorModel& triad) {
    std::array<const toml::key*, kQuantities> given{};
    for (const auto& [name, node] : section) {
      const Key& key = find(name, keys);
      const toml::key*& before = given[static_cast<std::size_t>(key.quantity)];
      if (before != nullptr) {
        fail(name.source(), "'" + std::string(name.str()) + "' and '" + std::string(before->str()) +
                                "' are the same quantity: give one");
      }
      before = &name;
      set(key, node, triad);
    }
    const toml::key* sigma = given[static_cast<std::size_t>(Quantity::kInRunSigma)];
    const toml::key* tau = given[static_cast<std::size_t>(Quantity::kInRunTau)];
    if ((sigma == nullptr) != (tau == nullptr)) {
      fail((sigma != nullptr ? sigma : tau)->source(),
           "an in-run bias needs both in_run_sigma_<unit> and in_run_tau_s");
    }
  }

  const Key& find(const toml::key& name, std::span<const Key> keys) const {
    const auto found =
        std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == name.str(); });
    if (found != keys.end()) return *found;
    std::vector<std::string_view> names;
    for (const Key& key : keys) names.push_back(key.name);
    fail(name.source(),
         "unknown key '" + std::string(name.str()) + "': " + accepted(names, name.str()));
  }

  void set(const Key& key, const toml::node& node, TriadErrorModel& triad) {
    switch (key.quantity) {
      case Quantity::kBias:
        triad.bias = vector3(key, node);
        break;
      case Quantity::kBiasSigma:
        triad.bias_sigma = number(key, node);
        break;
      case Quantity::kInRunSigma:
        triad.in_run.sigma = number(key, node);
        break;
      case Quantity::kInRunTau:
        triad.in_run.tau_s = number(key, node);
        break;
      case Quantity::kNoise:
        triad.noise_density = number(key, node);
        break;
      case Quantity::kScale:
        triad.M.diagonal() += node.is_array() ? vector3(key, node)
                                              : Eigen::Vector3d::Constant(number(key, node)).eval();
        break;
      case Quantity::kMisalignment:
        triad.M += misalignment(key, node);
        break;
      case Quantity::kQuantum:
        triad.quantum = number(key, node);
        break;
      case Quantity::kRange:
        triad.range = number(key, node);
        break;
      case Quantity::kGSensitivity:
        model_.G_g_radps_per_mps2 = node.is_array()
                                        ? matrix3(key, node)
                                        : (number(key, node) * Eigen::Matrix3d::Identity()).eval();
        break;
    }
  }

  double number(const Key& key, const toml::node& node) const {
    const bool is_number = node.is_floating_point() || node.is_integer();
    const double value = is_number ? node.value_or(0.0) : 0.0;
    if (!is_number || !(value >= key.low && value <= key.high)) {
      std::ostringstream what;
      what << "'" << key.name << "' ";
      if (is_number) {
        what << "is " << value;
      } else {
        what << "has another type than wanted";
      }
      what << ": must be a number from " << key.low << " to " << key.high << count_hint(key);
      fail(node.source(), what.str());
    }
    return value * key.factor;
  }

  static const char* count_hint(const Key& key) {
    switch (key.quantity) {
      case Quantity::kBias:
        return ", one for each axis: [x, y, z]";
      case Quantity::kScale:
        return ", or one for each axis: [x, y, z]";
      case Quantity::kMisalignment:
        return ", six of them: [xy, xz, yx, yz, zx, zy], or 3 x 3 with a zero diagonal";
      case Quantity::kGSensitivity:
        return ", or 3 x 3";
      default:
        return "";
    }
  }

  const toml::array& array(const Key& key, const toml::node& node, std::size_t size) const {
    const toml::array* values = node.as_array();
    if (values == nullptr || values->size() != size) {
      fail(node.source(), "'" + std::string(key.name) + "' must be " + std::to_string(size) +
                              " entries" + count_hint(key));
    }
    return *values;
  }

  Eigen::Vector3d vector3(const Key& key, const toml::node& node) const {
    const toml::array& values = array(key, node, 3);
    return {number(key, values[0]), number(key, values[1]), number(key, values[2])};
  }

  Eigen::Matrix3d matrix3(const Key& key, const toml::node& node) const {
    const toml::array& rows = array(key, node, 3);
    Eigen::Matrix3d m;
    m << vector3(key, rows[0]), vector3(key, rows[1]), vector3(key, rows[2]);
    return m.transpose();
  }

  Eigen::Matrix3d misalignment(const Key& key, const toml::node& node) const {
    const toml::array* values = node.as_array();
    if (values != nullptr && values->size() == 3) {
      const Eigen::Matrix3d m = matrix3(key, node);
      if (!m.diagonal().isZero(0.0)) {
        fail(node.source(), "'" + std::string(key.name) +
                                "' has a diagonal: scale factor errors belong to scale_ppm");
      }
      return m;
    }
    const toml::array& v = array(key, node, 6);
    Eigen::Matrix3d m;
    m << 0.0, number(key, v[0]), number(key, v[1]), number(key, v[2]), 0.0, number(key, v[3]),
        number(key, v[4]), number(key, v[5]), 0.0;
    return m;
  }

  std::string path_;
  ImuErrorModel model_{};
};

}  // namespace

ImuErrorModel read_imu_model(const std::filesystem::path& path) { return ModelFile(path).read(); }

}  // namespace leeway::sim
