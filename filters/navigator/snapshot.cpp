#include "leeway/navigator/snapshot.hpp"

#include <zlib.h>

#include <array>
#include <bit>

#include "filters/navigator/archive.hpp"
#include "leeway/navigator/navigator.hpp"

namespace leeway {
namespace {

/// Reads as another number on a machine of the other byte order.
constexpr std::uint64_t kMagic = 0x4c454557'41593031;

struct Header {
  std::uint64_t magic{kMagic};
  std::uint32_t version{kSnapshotVersion};
  std::uint32_t configuration{0};
  std::uint64_t size{0};
  std::uint32_t checksum{0};  // of what comes before and after it

  template <class Archive>
  void visit(Archive& archive) {
    archive(magic, version, configuration, size, checksum);
  }
};

constexpr std::size_t kHeaderSize = 28;
constexpr std::size_t kBeforeChecksum = kHeaderSize - sizeof(std::uint32_t);

std::uint32_t crc(std::uint32_t begin, std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(begin, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Of a whole snapshot, its own place left out.
std::uint32_t checksum(std::span<const std::byte> snapshot) {
  return crc(crc(0, snapshot.first(kBeforeChecksum)), snapshot.subspan(kHeaderSize));
}

/// Hashes what is visited.
class Fingerprint : public Archive<Fingerprint> {
 public:
  void bytes(const void* data, std::size_t size) {
    value_ = crc(value_, {static_cast<const std::byte*>(data), size});
  }
  std::uint32_t value() const { return value_; }

 private:
  std::uint32_t value_{0};
};

/// Everything in it, so that a state never continues under another configuration.
std::uint32_t fingerprint(NavigatorConfig c) {
  Fingerprint archive;
  for (TriadErrorModel* triad : {&c.filter.imu.accelerometer, &c.filter.imu.gyro}) {
    archive(triad->bias_sigma, triad->noise_density, triad->in_run.sigma, triad->in_run.tau_s);
  }
  StrapdownPolicy& strapdown = c.filter.strapdown;
  archive(strapdown.scheme, strapdown.gravity, strapdown.rotation, c.filter.lever_arm_b_m,
          c.filter.gnss_correlation_s, c.filter.gate_probability, c.filter.covariance_interval_s,
          c.filter.gravity_gradient, c.filter.biases.accelerometer, c.filter.biases.gyro);
  AlignmentConfig& a = c.alignment;
  archive(a.heading_from_course, a.min_speed_mps, a.sideslip_rad, a.tilt_floor_rad,
          a.max_fix_interval_s, a.rest_speed_mps, a.rest_turn_rad, a.min_level_s, a.min_rest_s);
  VehicleConfig& v = c.vehicle;
  archive(v.zero_velocity, v.zero_angular_rate, v.non_holonomic, v.odometer, v.barometer,
          v.standstill.gyro_std_radps, v.standstill.force_std_mps2, v.standstill.turn_radps,
          v.standstill.acceleration_mps2, v.standstill.speed_mps, v.rest_sigma_mps,
          v.rest_turn_sigma_radps, v.min_speed_mps, v.right_sigma_mps, v.right_sigma_m,
          v.down_sigma_m2ps2, v.rear_axle_x_m, v.rear_axle_sigma_m, v.mount_sigma_rad,
          v.mount_walk_rad_per_sqrt_s, v.odometer_scale_sigma, v.odometer_walk_per_sqrt_s,
          v.height_offset_sigma_m, v.height_walk_m_per_sqrt_s);
  TimingConfig& t = c.timing;
  archive(t.position_lag_s, t.velocity_lag_s, t.max_lateness_s, t.max_ahead_s, t.max_imu_rate_hz,
          c.C_bs, c.rate_meaning, c.max_gap_s, c.max_jump_s, c.max_rate_radps, c.max_force_mps2);
  return archive.value();
}

}  // namespace

std::string_view name(Restore outcome) {
  constexpr std::array<std::string_view, 6> kNames{"restored",      "not a snapshot",
                                                   "other version", "other configuration",
                                                   "wrong size",    "damaged"};
  return kNames[static_cast<std::size_t>(outcome)];
}

std::size_t Navigator::snapshot_size() const {
  Measure measure;
  Navigator copy = *this;
  copy.visit(measure);
  return kHeaderSize + measure.size();
}

void Navigator::snapshot(std::span<std::byte> out) const {
  Header header;
  header.configuration = fingerprint(config_);
  header.size = out.size();
  Writer writer(out);
  writer(header);
  Navigator copy = *this;  // visiting is for reading, too: it takes what may change
  copy.visit(writer);
  header.checksum = checksum(out);
  Writer again(out);
  again(header);
}

Restore Navigator::restore(std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderSize) return Restore::kNotASnapshot;
  Header header;
  Reader reader(bytes);
  reader(header);
  if (header.magic != kMagic) return Restore::kNotASnapshot;
  if (header.version != kSnapshotVersion) return Restore::kOtherVersion;
  if (header.size != bytes.size()) return Restore::kWrongSize;
  if (header.checksum != checksum(bytes)) return Restore::kDamaged;
  if (header.configuration != fingerprint(config_) || bytes.size() != snapshot_size()) {
    return Restore::kOtherConfiguration;
  }
  visit(reader);
  return Restore::kRestored;
}

}  // namespace leeway
