#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"

/// Whatever the bytes, they are the records of a log, in strictly increasing time, or an Error. The
/// first byte chooses the reader.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const std::filesystem::path kPath =
      std::filesystem::temp_directory_path() / ("leeway_fuzz_log_" + std::to_string(getpid()));
  std::ofstream(kPath, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  const auto read_all = [](auto&& reader) {
    leeway::Time last = leeway::Time::min();
    while (const auto record = reader.next()) {
      if (record->time <= last) __builtin_trap();
      last = record->time;
    }
  };
  try {
    if (data[0] % 2 == 0) {
      read_all(leeway::ImuLogReader(kPath));
    } else {
      leeway::GnssLogOptions options;
      if (data[0] % 4 == 3) options.format.gnss_sigma = {1.0, 2.0, 0.1, 0.2};
      read_all(leeway::GnssLogReader(kPath, options));
    }
  } catch (const leeway::Error&) {
  }
  return 0;
}
