#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "leeway/earth/error.hpp"
#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"

namespace {

/// The bytes with right checksums behind all that looks like a UBX message, so that what is in one
/// is read.
std::string with_ubx_checksums(std::string bytes) {
  const auto at = [&](std::size_t k) { return static_cast<unsigned char>(bytes[k]); };
  for (std::size_t k = 0; k + 8 <= bytes.size(); ++k) {
    const std::size_t size = at(k + 4) + 256U * at(k + 5);
    if (at(k) != 0xB5 || at(k + 1) != 0x62 || k + 8 + size > bytes.size()) continue;
    unsigned a = 0, b = 0;
    for (std::size_t j = k + 2; j < k + 6 + size; ++j) b += a += at(j);
    bytes[k + 6 + size] = static_cast<char>(a);
    bytes[k + 7 + size] = static_cast<char>(b);
    k += 7 + size;
  }
  return bytes;
}

/// A phone's recording: its halves are those of the bytes.
void write_folder(const std::filesystem::path& folder, const std::string& bytes) {
  std::filesystem::create_directory(folder);
  const std::size_t half = std::min(bytes.find('\1'), bytes.size());
  std::ofstream(folder / "Gyroscope.csv", std::ios::binary) << bytes.substr(0, half);
  std::ofstream(folder / "Accelerometer.csv", std::ios::binary)
      << bytes.substr(std::min(half + 1, bytes.size()));
  std::ofstream(folder / "Gravity.csv", std::ios::binary)
      << bytes.substr(std::min(half + 1, bytes.size()));
}

}  // namespace

/// Whatever the bytes, they are the records of a log, in strictly increasing time, or an Error. The
/// first byte chooses the reader, whether checksums are mended, and whether it is a folder.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const std::filesystem::path kPath =
      std::filesystem::temp_directory_path() / ("leeway_fuzz_log_" + std::to_string(getpid()));
  std::string log(reinterpret_cast<const char*>(data + 1), size - 1);
  if (data[0] & 8) log = with_ubx_checksums(std::move(log));
  std::ofstream(kPath, std::ios::binary) << log;
  static const std::filesystem::path kFolder = kPath.string() + ".d";
  if (data[0] & 16) write_folder(kFolder, log);
  const auto read_all = [](auto&& reader) {
    leeway::Time last = leeway::Time::min();
    while (const auto record = reader.next()) {
      if (record->time <= last) __builtin_trap();
      last = record->time;
    }
  };
  try {
    if (data[0] % 2 == 0) {
      read_all(leeway::ImuLogReader((data[0] & 16) != 0 ? kFolder : kPath));
    } else {
      leeway::GnssLogOptions options;
      if (data[0] % 4 == 3) options.format.gnss_sigma = {1.0, 2.0, 0.1, 0.2};
      read_all(leeway::GnssLogReader(kPath, options));
    }
  } catch (const leeway::Error&) {
  }
  return 0;
}
