#pragma once
/// Checks of our own invariants and of contracts: what is on in release, and what only in debug.
#include <cassert>

/// A broken contract of the caller inside the library: stops in debug, costs nothing in release.
#define FASE_ASSERT(condition) assert(condition)
