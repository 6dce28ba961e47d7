// The same for the tests, with their frameworks.
#include "cmake/precompiled/library.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <filesystem>
#include <map>
#include <set>
