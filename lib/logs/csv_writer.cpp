#include "leeway/logs/csv_writer.hpp"

#include "leeway/earth/error.hpp"
#include "lib/logs/text_file.hpp"

namespace leeway {

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<CsvColumn>& columns)
    : file_(std::make_unique<TextFile>(path)) {
  constexpr int kMaxDecimals = 12;
  for (const CsvColumn& column : columns) {
    if (column.decimals > kMaxDecimals) {
      throw Error("CSV column " + column.name + ": decimals must be at most 12");
    }
    if (!decimals_.empty()) file_->put(",");
    decimals_.push_back(column.decimals);
    file_->put(column.name);
  }
  file_->put("\n");
}

CsvWriter::~CsvWriter() = default;
CsvWriter::CsvWriter(CsvWriter&&) noexcept = default;

void CsvWriter::write(Time time, std::span<const double> values) {
  if (values.size() + 1 != decimals_.size()) {
    throw Error(file_->path().string() + ": a row of " + std::to_string(values.size()) +
                " values after its time, must be " + std::to_string(decimals_.size() - 1));
  }
  char* out = put_time(file_->begin(kMaxNumberBytes * decimals_.size()), time);
  for (std::size_t i = 0; i < values.size(); ++i) {
    *out++ = ',';
    out = put_number(out, values[i], decimals_[i + 1]);
  }
  *out++ = '\n';
  file_->end(out);
}

void CsvWriter::close() { file_->close(); }

}  // namespace leeway
