#include <cstddef>
#include <cstdint>
#include <string_view>

#include "leeway/earth/error.hpp"
#include "leeway/sim/sensors/imu_model_file.hpp"

/// Whatever the text, it is a model or an Error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    validate(leeway::sim::parse_imu_model(text, "model.toml"));
  } catch (const leeway::Error&) {
  }
  return 0;
}
