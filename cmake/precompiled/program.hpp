// The same for the command and the benchmarks, which also print.
#include "cmake/precompiled/library.hpp"

#include <fmt/format.h>
