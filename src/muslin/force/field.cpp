#include "muslin/force/field.hpp"

namespace muslin {

double FieldExtent::strength_in(double begin, double end) const {
  const double share = window.share(begin, end);
  return share == 0 ? 0 : share * strength.at(sampled(end));
}

double FieldExtent::weight(const Vec3& x, double distance) const {
  const double inside = region ? region->weight(x) : 1;
  return inside == 0 ? 0 : inside * falloff.at(distance);
}

Vec3 Field::at(const Vec3& x, double time) const {
  const FieldSample sample = pattern->at(extent.place_of(x, time), time);
  return extent.weight(x, sample.distance) * sample.vector;
}

}  // namespace muslin
