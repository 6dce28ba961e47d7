#pragma once
/// The whole public surface of the component fase::world.
#include "fase/dynamics/body_kind.hpp"
#include "fase/dynamics/material.hpp"
#include "fase/world/body.hpp"
#include "fase/world/check_values.hpp"
#include "fase/world/events.hpp"
#include "fase/world/fixed_step.hpp"
#include "fase/world/id_map.hpp"
#include "fase/world/query.hpp"
#include "fase/world/settings.hpp"
#include "fase/world/stats.hpp"
#include "fase/world/world.hpp"
