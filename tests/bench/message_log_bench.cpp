// Binary logs: how many bytes of a file are read in a second. UBX as a receiver of 10 Hz with its
// satellites writes it, ULog with sensor_combined among other topics.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"
#include "tests/lib/logs/bytes.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::Bytes;

std::string nav_pvt(std::uint32_t after_noon_ms) {
  Bytes p;
  p.add_zeros(92);
  p.set<std::uint32_t>(0, (4 * 86400 + 43200) * 1000 + after_noon_ms);
  p.set<std::int32_t>(16, static_cast<std::int32_t>(after_noon_ms % 1000) * 1'000'000);
  p.set<std::uint16_t>(4, 2025).set<std::uint8_t>(6, 8).set<std::uint8_t>(7, 28);
  p.set<std::uint8_t>(8, 12).set<std::uint8_t>(11, 7).set<std::uint8_t>(20, 3);
  p.set<std::uint8_t>(21, 1).set<std::int32_t>(28, 475'000'000);
  p.set<std::uint32_t>(40, 2000).set<std::uint32_t>(44, 3000).set<std::uint32_t>(68, 300);
  return test::ubx_message(0x01, 0x07, p.text());
}

std::string ubx_log() {
  const std::string satellites = test::ubx_message(0x01, 0x35, std::string(8 + 12 * 30, 's'));
  std::string log;
  for (std::uint32_t k = 0; k < 100'000; ++k) {
    log += nav_pvt(100 * k);
    if (k % 10 == 0) log += satellites;
  }
  return log;
}

/// Measurements of rates and of forces at 100 Hz.
std::string esf_log() {
  std::string log;
  const auto add = [&](std::uint32_t tag_ms, std::initializer_list<std::uint32_t> types) {
    Bytes b;
    b.add(tag_ms).add<std::uint16_t>(3 << 11).add<std::uint16_t>(0);
    for (const std::uint32_t type : types) b.add(type << 24 | 1000);
    log += test::ubx_message(0x10, 0x02, b.text());
  };
  for (std::uint32_t k = 0; k < 200'000; ++k) {
    add(10 * k, {14, 13, 5});
    add(10 * k, {16, 17, 18});
    if (k % 10 == 0) log += nav_pvt(10 * k);
  }
  return log;
}

std::string flight_log() {
  const auto message = [](char type, const std::string& content) {
    return Bytes()
        .add(static_cast<std::uint16_t>(content.size()))
        .add(type)
        .add_text(content)
        .text();
  };
  const auto data = [&](std::uint16_t id, std::uint64_t time_us, std::size_t size) {
    return message('D', Bytes().add(id).add(time_us).add_zeros(size).text());
  };
  std::string log = Bytes().add_text("ULog\x01\x12\x35\x01").add_zeros(8).text();
  log += message('F',
                 "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t "
                 "gyro_integral_dt;int32_t accelerometer_timestamp_relative;float[3] "
                 "accelerometer_m_s2;uint32_t accelerometer_integral_dt;");
  log += message('A', Bytes().add_zeros(3).add_text("sensor_combined").text());
  for (std::uint64_t k = 1; k <= 200'000; ++k) {
    log += data(0, 5000 * k, 36);
    log += data(1, 5000 * k, 40) + data(2, 5000 * k, 28);
    if (k % 20 == 0) log += data(3, 5000 * k, 200);
  }
  return log;
}

template <class Reader>
void read_all(benchmark::State& state, const std::string& log) {
  const test::TempDir dir;
  const std::filesystem::path path = dir.file("log", log);
  std::int64_t records = 0;
  for (auto _ : state) {
    Reader reader(path);
    while (const auto record = reader.next()) ++records;
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(log.size()));
  state.SetItemsProcessed(records);
}

void ubx_fixes(benchmark::State& state) { read_all<GnssLogReader>(state, ubx_log()); }
void ubx_sensors(benchmark::State& state) { read_all<ImuLogReader>(state, esf_log()); }
void ulog_imu(benchmark::State& state) { read_all<ImuLogReader>(state, flight_log()); }

BENCHMARK(ubx_fixes)->Unit(benchmark::kMillisecond);
BENCHMARK(ubx_sensors)->Unit(benchmark::kMillisecond);
BENCHMARK(ulog_imu)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace leeway
