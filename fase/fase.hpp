#pragma once
/// The whole public surface of Fase.
#include "fase/collision.hpp"
#include "fase/io.hpp"
#include "fase/world.hpp"
