#include "leeway/navigator/snapshot.hpp"

#include <zlib.h>

#include "filters/navigator/archive.hpp"
#include "leeway/navigator/navigator.hpp"
#include "lib/earth/field_walk.hpp"

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

/// Of everything in it, so that a state never continues under another configuration.
std::uint32_t fingerprint(const NavigatorConfig& config) {
  std::uint32_t value = 0;
  walk_fields(config, [&value](const FieldPath&, const auto& field, const Range&) {
    value = crc(value, bytes_of(field));
  });
  return value;
}

}  // namespace

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
