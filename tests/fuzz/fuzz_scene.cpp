#include <cstddef>
#include <cstdint>
#include <string_view>

#include "leeway/earth/error.hpp"
#include "leeway/sim/scene/scene_file.hpp"

/// Whatever the text, it is a scene or an Error. Files it names are sought in a folder that is not.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    validate(leeway::sim::parse_scene(text, "no-such-folder/scene.toml"));
  } catch (const leeway::Error&) {
  }
  return 0;
}
