/// @file
/// The door for vehicle software: a Navigator and all that its calls take and return.
#pragma once

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/earth/units.hpp"
#include "leeway/navigator/navigator.hpp"
#include "leeway/strapdown/nav_state.hpp"
