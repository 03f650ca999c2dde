// version() returns the version of the library, MAJOR.MINOR.PATCH.
#pragma once

namespace muslin {

const char* version();

}  // namespace muslin
