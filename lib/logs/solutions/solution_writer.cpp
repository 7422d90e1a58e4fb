#include "leeway/logs/solution_writer.hpp"

#include <algorithm>
#include <utility>

#include "leeway/earth/error.hpp"
#include "lib/logs/solutions/solution_formats.hpp"

namespace leeway {
namespace {

struct ColumnOfSolution {
  std::string_view name;
  int decimals;
};
constexpr int kSingle = CsvColumn::kSingle;
constexpr std::array<ColumnOfSolution, 36> kColumns{{{"t_s", 9},
                                                     {"lat_deg", 10},
                                                     {"lon_deg", 10},
                                                     {"height_m", 5},
                                                     {"vn_mps", 5},
                                                     {"ve_mps", 5},
                                                     {"vd_mps", 5},
                                                     {"roll_deg", 7},
                                                     {"pitch_deg", 7},
                                                     {"yaw_deg", 7},
                                                     {"b_ax_mps2", kSingle},
                                                     {"b_ay_mps2", kSingle},
                                                     {"b_az_mps2", kSingle},
                                                     {"b_gx_radps", kSingle},
                                                     {"b_gy_radps", kSingle},
                                                     {"b_gz_radps", kSingle},
                                                     {"sigma_n_m", kSingle},
                                                     {"sigma_e_m", kSingle},
                                                     {"sigma_d_m", kSingle},
                                                     {"sigma_vn_mps", kSingle},
                                                     {"sigma_ve_mps", kSingle},
                                                     {"sigma_vd_mps", kSingle},
                                                     {"sigma_roll_deg", kSingle},
                                                     {"sigma_pitch_deg", kSingle},
                                                     {"sigma_yaw_deg", kSingle},
                                                     {"sigma_b_ax_mps2", kSingle},
                                                     {"sigma_b_ay_mps2", kSingle},
                                                     {"sigma_b_az_mps2", kSingle},
                                                     {"sigma_b_gx_radps", kSingle},
                                                     {"sigma_b_gy_radps", kSingle},
                                                     {"sigma_b_gz_radps", kSingle},
                                                     {"nis", kSingle},
                                                     {"nis_dof", 0},
                                                     {"east_m", 5},
                                                     {"north_m", 5},
                                                     {"up_m", 5}}};
constexpr std::size_t kLocalColumns = 3;  // the last ones, which are written where asked for

/// The values of all columns but the time.
Eigen::Matrix<double, kColumns.size() - 1, 1> values_of(const SolutionRow& row) {
  const Solution& s = row.solution;
  const NavStateNed& nav = row.nav;
  Eigen::Matrix<double, kColumns.size() - 1, 1> values;
  values << row.lat_deg(), row.lon_deg(), nav.position.height_m, nav.v_n_mps,
      nav.attitude.roll_rad / kRadPerDeg, nav.attitude.pitch_rad / kRadPerDeg,
      nav.attitude.yaw_rad / kRadPerDeg, s.b_a_mps2, s.b_g_radps, s.sigma_position_n_m,
      s.sigma_velocity_n_mps, s.sigma_attitude_rad / kRadPerDeg, s.sigma_b_a_mps2,
      s.sigma_b_g_radps, s.nis, static_cast<double>(s.nis_dof), row.local.position_m(s.nav);
  return values;
}

std::string ending_of(std::filesystem::path path) {
  if (path.extension() == ".gz") path.replace_extension();
  const std::string ending = path.extension().string();
  return ending.empty() ? ending : ending.substr(1);
}

const SolutionFormat* format_named(std::string_view name) {
  const auto at = std::find_if(kSolutionFormats.begin(), kSolutionFormats.end(),
                               [name](const SolutionFormat* f) { return f->name == name; });
  return at == kSolutionFormats.end() ? nullptr : *at;
}

/// Null: CSV.
const SolutionFormat* format_of(const std::filesystem::path& path, const SolutionForm& form) {
  if (form.format == "csv") return nullptr;
  if (form.format.empty()) return format_named(ending_of(path));
  if (const SolutionFormat* format = format_named(form.format)) return format;
  std::string names = "csv";
  for (const SolutionFormat* format : kSolutionFormats) names.append(", ").append(format->name);
  throw Error("unknown format of a solution '" + form.format + "'; choose one of " + names);
}

/// Places in kColumns, all after t_s.
std::vector<std::size_t> columns_of(const SolutionForm& form) {
  std::vector<std::size_t> columns;
  std::string names;
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    if (c > 0 && c + kLocalColumns < kColumns.size()) columns.push_back(c);
    names.append(c > 0 ? ", " : "").append(kColumns[c].name);
  }
  if (form.columns.empty()) return columns;
  columns.clear();
  for (const std::string& name : form.columns) {
    const auto at = std::find_if(kColumns.begin(), kColumns.end(),
                                 [&](const ColumnOfSolution& c) { return c.name == name; });
    if (at == kColumns.end()) {
      throw Error("unknown column of a solution '" + name + "'; choose from " + names);
    }
    if (at != kColumns.begin()) columns.push_back(static_cast<std::size_t>(at - kColumns.begin()));
  }
  return columns;
}

}  // namespace

void require_solution_form(const std::filesystem::path& path, const SolutionForm& form) {
  const SolutionFormat* format = format_of(path, form);
  if (format == nullptr) {
    columns_of(form);
  } else if (!form.columns.empty()) {
    throw Error(path.string() + ": columns are chosen of CSV, and this is " +
                std::string(format->name) + "; leave the columns out, or choose the format csv");
  }
}

struct SolutionWriter::Parts {
  Parts(const std::filesystem::path& path, const SolutionForm& form)
      : format(format_of(path, form)), columns(columns_of(form)), file(path) {
    if (form.origin) local.emplace(*form.origin);
  }

  void begin() {
    if (format != nullptr) return file.put(format->before);
    file.put(kColumns[0].name);
    for (const std::size_t c : columns) {
      file.put(",");
      file.put(kColumns[c].name);
    }
    file.put("\n");
  }

  void write_csv(const SolutionRow& row) {
    const auto values = values_of(row);
    char* out = put_time(file.begin(kMaxNumberBytes * (columns.size() + 1)), row.nav.time);
    for (const std::size_t c : columns) {
      *out++ = ',';
      out = put_number(out, values[static_cast<Eigen::Index>(c) - 1], kColumns[c].decimals);
    }
    *out++ = '\n';
    file.end(out);
  }

  const SolutionFormat* format;  // null: CSV
  std::vector<std::size_t> columns;
  TextFile file;
  std::optional<LocalFrame> local{};
  bool is_first{true};
  bool is_closed{false};
};

SolutionWriter::SolutionWriter(const std::filesystem::path& path, const SolutionForm& form) {
  require_solution_form(path, form);
  parts_ = std::make_unique<Parts>(path, form);
  parts_->begin();
}

SolutionWriter::~SolutionWriter() = default;
SolutionWriter::SolutionWriter(SolutionWriter&&) noexcept = default;

void SolutionWriter::write(const Solution& solution) {
  const NavStateNed nav = ned_from_nav_state(solution.nav);
  if (!parts_->local) parts_->local.emplace(nav.position);
  const SolutionRow row{solution, nav, *parts_->local, parts_->is_first};
  parts_->is_first = false;
  if (parts_->format == nullptr) return parts_->write_csv(row);
  RowText text(parts_->file);
  parts_->format->row(text, row);
}

void SolutionWriter::close() {
  if (std::exchange(parts_->is_closed, true)) return;
  if (parts_->format != nullptr) parts_->file.put(parts_->format->after);
  parts_->file.close();
}

}  // namespace leeway
