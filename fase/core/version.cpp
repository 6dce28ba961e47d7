// The version of the library binary.
#include "fase/core/version.hpp"

namespace fase {

std::string_view library_version() { return header_version; }

}  // namespace fase
