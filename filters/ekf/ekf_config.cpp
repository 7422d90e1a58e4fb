#include "leeway/ekf/ekf_config.hpp"

#include "lib/earth/field_walk.hpp"

namespace leeway {

void validate(const EkfConfig& config) { validate_fields("filter", config); }

}  // namespace leeway
