// The version that the library was built as.
#include "fase/core/version.hpp"

namespace fase {

std::string_view library_version() { return header_version; }

}  // namespace fase
