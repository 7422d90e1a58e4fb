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

ScalarRowParser scalar_parser(LineReader& lines, const ScalarColumns& columns) {
  const std::array wanted{NamedColumn{"t_s", kTimeColumn},
                          NamedColumn{columns.value, {0, -columns.largest, columns.largest}}};
  const std::array sigma{NamedColumn{columns.sigma, {1, kLeastSigma, columns.largest, true}}};
  const std::string expected = "a CSV header with " + join(wanted) + " (and " + join(sigma) + ")";
  CsvHeader header = take_csv_header(lines, wanted, expected);
  header.use_group(sigma);
  return {header.parser()};
}

}  // namespace

struct ScalarLogReader::Impl {
  LogSource<ScalarRecord> source;
};

ScalarLogReader::ScalarLogReader(const std::filesystem::path& path, const ScalarColumns& columns) {
  LineReader lines(path);
  ScalarRowParser parser = scalar_parser(lines, columns);
  impl_ = std::make_unique<Impl>(Impl{{std::move(lines), std::move(parser)}});
}

ScalarLogReader::~ScalarLogReader() = default;
ScalarLogReader::ScalarLogReader(ScalarLogReader&&) noexcept = default;
ScalarLogReader& ScalarLogReader::operator=(ScalarLogReader&&) noexcept = default;

std::optional<ScalarRecord> ScalarLogReader::next() {
  const std::optional<ScalarRecord> row = impl_->source.next();
  if (row) ++impl_->source.report().records;
  return row;
}

const LogSummary& ScalarLogReader::report() const { return impl_->source.report(); }

}  // namespace leeway
