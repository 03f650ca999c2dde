#include "muslin/core/progress.hpp"

#include <string>

#include "muslin/core/error.hpp"

namespace muslin {

void Progress::at(double fraction, std::string_view stage) const {
  if (report) report(fraction, stage);
  if (cancelled && cancelled())
    throw Error(ErrorKind::interrupted, "stopped by the user during " + std::string(stage), "");
}

}  // namespace muslin
