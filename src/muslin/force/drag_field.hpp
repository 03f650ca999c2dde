// DragField slows vertices in a region.
#pragma once

#include <memory>
#include <vector>

#include "muslin/force/field.hpp"
#include "muslin/potential/potential.hpp"

namespace muslin {

/// The force −mᵢ s (linear + quadratic |v|) v on every vertex, s the strength times the weight at its place.
/// It is semi-implicit: the place and |v| are taken at the beginning of the step, v at its end. Then it only
/// ever removes energy, and any step and coefficient is stable.
class DragField : public Load {
 public:
  struct Coefficients {
    double linear = 0;     ///< [1/s] ≥ 0
    double quadratic = 0;  ///< [1/m] ≥ 0
  };
  /// masses: #V [kg], 0 where the field does not act; the extent's strength is never negative.
  DragField(std::vector<double> masses, FieldExtent extent, Coefficients coefficients);
  std::unique_ptr<Potential> potential(const StepContext& step) const override;

 private:
  std::vector<double> masses_;
  FieldExtent extent_;
  Coefficients coefficients_;
};

}  // namespace muslin
