#include "lib/logs/layouts/phone_folder.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "lib/logs/csv_header.hpp"

namespace leeway {
namespace {

constexpr std::string_view kRecordWhat =
    "record Gyroscope and the total acceleration (Sensor Logger: TotalAcceleration, or "
    "Accelerometer and Gravity; phyphox: Acceleration with g)";

std::string lower_letters(std::string_view text) {
  std::string letters;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (std::isalpha(code) != 0) letters += static_cast<char>(std::tolower(code));
  }
  return letters;
}

/// "TotalAcceleration.csv" as "totalacceleration"; empty of what is no CSV.
std::string sensor_named(const std::filesystem::path& file) {
  const std::string name = lower_letters(file.filename().string());
  for (const std::string_view ending : {"csvgz", "csv"}) {
    if (name.ends_with(ending)) return name.substr(0, name.size() - ending.size());
  }
  return {};
}

/// The first file of a folder that is called like one of the names; empty: there is none.
std::filesystem::path file_of(const std::filesystem::path& folder,
                              std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    std::error_code ignored;  // a folder that cannot be read has no files
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
      if (sensor_named(entry.path()) == name) return entry.path();
    }
  }
  return {};
}

/// Sensor Logger calls the acceleration without gravity so, phyphox the one with it.
bool is_linear(const std::filesystem::path& file) {
  LineReader lines(file);
  const std::string header = lower_letters(read_head(lines).line);
  return header.find("secondselapsed") != std::string::npos ||
         header.find("linear") != std::string::npos;
}

/// The axis that a title such as "Gyroscope x (rad/s)" ends in; ' ': none.
char axis_of_title(std::string_view title) {
  title = title.substr(0, title.find_first_of("(["));
  while (title.ends_with(' ')) title.remove_suffix(1);
  if (title.empty()) return ' ';
  const char axis = static_cast<char>(std::tolower(static_cast<unsigned char>(title.back())));
  const bool is_alone =
      title.size() == 1 || std::isalpha(static_cast<unsigned char>(title[title.size() - 2])) == 0;
  return is_alone && axis >= 'x' && axis <= 'z' ? axis : ' ';
}

constexpr std::array kPhoneRates{
    NamedColumn{"t_s", kTimeColumn}, NamedColumn{"gx_radps", angular(0)},
    NamedColumn{"gy_radps", angular(1)}, NamedColumn{"gz_radps", angular(2)}};
constexpr std::array kPhoneForces{
    NamedColumn{"t_s", kTimeColumn}, NamedColumn{"ax_mps2", {0, -1e5, 1e5}},
    NamedColumn{"ay_mps2", {1, -1e5, 1e5}}, NamedColumn{"az_mps2", {2, -1e5, 1e5}}};

}  // namespace

bool is_phone_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}

std::filesystem::path location_of_phone(const std::filesystem::path& path) {
  if (!is_phone_folder(path)) return path;
  auto file = file_of(path, {"location", "gps", "locationgps"});
  if (!file.empty()) return file;
  throw Error(path.string() +
              ": has no Location.csv, as the folder of a phone's recording; record Location, or "
              "give --gnss a file");
}

PhoneRows::PhoneRows(const std::filesystem::path& folder, const LogFormat& format) {
  const auto rates = file_of(folder, {"gyroscope"});
  auto total = file_of(folder, {"totalacceleration", "accelerationwithg"});
  auto linear = file_of(folder, {"linearaccelerometer", "linearacceleration"});
  const auto either = file_of(folder, {"accelerometer", "acceleration"});
  if (!either.empty() && (is_linear(either) ? linear : total).empty()) {
    (is_linear(either) ? linear : total) = either;
  }
  const auto gravity = file_of(folder, {"gravity"});
  const std::string wanted = "; " + std::string(kRecordWhat) + ", or give --imu a file";
  if (rates.empty()) throw Error(folder.string() + ": has no Gyroscope.csv" + wanted);
  if (total.empty() && linear.empty()) {
    throw Error(folder.string() + ": has no accelerations" + wanted);
  }
  if (total.empty() && gravity.empty()) {
    throw Error(linear.string() + ": has gravity removed, and there is no Gravity.csv beside it" +
                wanted);
  }
  rates_ = std::make_unique<Axes>(open(rates, 'g', format));
  if (!total.empty()) {
    refuse_without_gravity(total, format);
    forces_ = std::make_unique<Axes>(open(total, 'a', format));
    return;
  }
  forces_ = std::make_unique<Axes>(open(linear, 'a', format));
  gravity_ = std::make_unique<Axes>(open(gravity, 'a', format));
  summary_.notes.push_back(
      "Accelerometer and Gravity are added; those of an iPhone have the right sign only where "
      "Sensor Logger's Standardise Units & Frames was on");
}

PhoneRows::Axes PhoneRows::open(const std::filesystem::path& file, char quantity,
                                const LogFormat& format) {
  LineReader lines(file);
  const LogHead head = read_head(lines);
  LogFormat named = format;
  named.columns.clear();
  const CsvHeader seen = CsvHeader::understood(head.line, "", {});
  for (const std::string& title : seen.titles()) {
    const char axis = axis_of_title(title);
    if (axis != ' ') named.columns.emplace(std::string{quantity, axis}, title);
  }
  std::vector<std::string> notes;
  LogOpening log{head, lines, named, notes, {}};
  const std::span<const NamedColumn> rates = kPhoneRates;
  const CsvHeader header =
      take_csv_header(log, quantity == 'g' ? rates : kPhoneForces,
                      "a CSV of one sensor with a time and x, y, z", kSlowestImuS);
  const auto parse = [fields = header.parser()](std::string_view line, AxesRow& row) {
    return fields.parse(line, row.time, {row.value.data(), 3});
  };
  return {std::move(lines), parse, "phone folder", std::move(notes)};
}

void PhoneRows::refuse_without_gravity(const std::filesystem::path& file, const LogFormat& format) {
  constexpr std::size_t kRows = 200;
  Axes forces = open(file, 'a', format);
  std::vector<double> norms;
  while (norms.size() < kRows) {
    const auto row = forces.next();
    if (!row) break;
    norms.push_back(row->value.norm());
  }
  if (norms.empty()) return;
  const auto middle = norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2);
  std::nth_element(norms.begin(), middle, norms.end());
  if (*middle > kStandardGravityMps2 / 2.0) return;
  throw Error(file.string() + ": its accelerations begin with " + std::to_string(*middle) +
              " m/s^2, so that gravity is removed, or the unit is another (--accel-unit g); " +
              std::string(kRecordWhat));
}

std::optional<PhoneRows::AxesRow> PhoneRows::next_force() {
  if (!gravity_) return forces_->next();
  while (!sums_.has_next()) {
    const auto row = sums_.needs_force() ? gravity_->next() : forces_->next();
    if (!row) return std::nullopt;
    if (sums_.needs_force()) {
      sums_.add_force(row->time, row->value);
    } else {
      sums_.add_rate(row->time, row->value);
    }
  }
  const ImuRow sum = sums_.next();
  return AxesRow{sum.time, sum.angular + sum.linear};
}

std::optional<ImuRow> PhoneRows::next() {
  while (!samples_.has_next()) {
    const bool needs_force = samples_.needs_force();
    const auto row = needs_force ? next_force() : rates_->next();
    if (!row) return std::nullopt;
    if (needs_force) {
      samples_.add_force(row->time, row->value);
    } else {
      samples_.add_rate(row->time, row->value);
    }
  }
  ++summary_.records;
  return samples_.next();
}

const LogSummary& PhoneRows::summary() const {
  merged_ = summary_;
  for (const Axes* part : {rates_.get(), forces_.get(), gravity_.get()}) {
    if (!part) continue;
    const LogSummary& other = std::as_const(*part).summary();
    merged_.lines += other.lines;
    for (std::size_t k = 0; k < kLineDamageCount; ++k) merged_.damaged[k] += other.damaged[k];
    merged_.notes.insert(merged_.notes.end(), other.notes.begin(), other.notes.end());
    merged_.messages.insert(merged_.messages.end(), other.messages.begin(), other.messages.end());
    if (merged_.incomplete.empty()) merged_.incomplete = other.incomplete;
  }
  merged_.messages.resize(std::min(merged_.messages.size(), LogSummary::kMaxMessages));
  return merged_;
}

}  // namespace leeway
