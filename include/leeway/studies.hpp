/// @file
/// The door for studies: scenes, and the questions that can be asked of them.
#pragma once

#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/analysis/interval.hpp"
#include "leeway/sim/atlas/atlas.hpp"
#include "leeway/sim/compare/compare.hpp"
#include "leeway/sim/reduce/model_reduction.hpp"
#include "leeway/sim/replay/replay.hpp"
#include "leeway/sim/scene/scene.hpp"
#include "leeway/sim/scene/scene_file.hpp"
#include "leeway/sim/sensors/imu_catalogue.hpp"
#include "leeway/sim/trials/campaign.hpp"
#include "leeway/sim/trials/drift.hpp"
