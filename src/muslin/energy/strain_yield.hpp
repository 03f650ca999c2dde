// StrainYield says when threads and springs take a set, and how stiff they are then.
#pragma once

namespace muslin {

struct StrainYield {
  double strain = 0;     ///< > 0: beyond which a length is kept; of threads that of a pulled strip
  double hardening = 0;  ///< h, 0 … 1: stiffness beyond yield over that below
};

}  // namespace muslin
