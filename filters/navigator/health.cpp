#include "leeway/navigator/health.hpp"

#include <array>
#include <cstddef>

namespace leeway {

std::string_view name(Health::State state) {
  constexpr std::array<std::string_view, 6> kNames{"aligning", "heading_open", "aligned",
                                                   "coasting", "gating",       "inconsistent"};
  return kNames[static_cast<std::size_t>(state)];
}

}  // namespace leeway
