#include "muslin/version.hpp"

namespace muslin {

const char* version() { return MUSLIN_VERSION; }

}  // namespace muslin
