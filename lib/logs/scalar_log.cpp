#include "leeway/logs/scalar_log.hpp"

#include <array>
#include <limits>
#include <utility>

#include "lib/logs/csv_header.hpp"
#include "lib/logs/log_columns.hpp"
#include "lib/logs/log_source.hpp"

namespace leeway {
namespace {

struct ScalarRowParser {
  LineParser fields{};

  std::optional<Fault> operator()(std::string_view line, ScalarRecord& row) const {
    std::array values{0.0, std::numeric_limits<double>::quiet_NaN()};
    if (auto fault = fields.parse(line, row.time, values)) return fault;
    row.value = values[0];
    row.sigma = values[1];
    return std::nullopt;
  }
};

std::unique_ptr<RecordSource<ScalarRecord>> scalar_source(LineReader lines,
                                                          const ScalarColumns& columns) {
  const std::array wanted{NamedColumn{"t_s", kTimeColumn},
                          NamedColumn{columns.value, {0, -columns.largest, columns.largest}}};
  const std::array sigma{NamedColumn{columns.sigma, {1, kLeastSigma, columns.largest, true}}};
  const std::string expected = "a CSV header with " + join(wanted) + " (and " + join(sigma) + ")";
  const LogFormat format;
  std::vector<std::string> notes;
  LogOpening log{{}, lines, format, notes};
  CsvHeader header = take_csv_header(log, wanted, expected);
  header.use_group(sigma);
  header.note(notes);
  return std::make_unique<LogSource<ScalarRecord>>(
      std::move(lines), ScalarRowParser{header.parser()}, "CSV", std::move(notes));
}

}  // namespace

ScalarLogReader::ScalarLogReader(const std::filesystem::path& path, const ScalarColumns& columns)
    : LogReader(scalar_source(LineReader(path), columns)) {}

}  // namespace leeway
