// version() returns the version of the library, MAJOR.MINOR.PATCH.
#pragma once

#include "muslin/api.hpp"

namespace muslin {

MUSLIN_API const char* version();

}  // namespace muslin
