// The same for fase::io, the command and the benchmarks, which also write texts.
#include "cmake/precompiled/library.hpp"

#include <fmt/format.h>
