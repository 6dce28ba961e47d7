#pragma once
/// Assertions on contracts inside the library.
#include <cassert>

/// Stops in a debug build when a caller inside the library breaks a contract; costs nothing in release.
#define FASE_ASSERT(condition) assert(condition)
