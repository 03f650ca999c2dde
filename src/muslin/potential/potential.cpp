#include "muslin/potential/potential.hpp"

#include "muslin/potential/hessian_sink.hpp"

namespace muslin {

void Potential::linearize(ConstVectors x, HessianSink& into, std::size_t first) const {
  into.add_general(*this, first, x);
}

}  // namespace muslin
