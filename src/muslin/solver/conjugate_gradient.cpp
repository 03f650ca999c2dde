#include "muslin/solver/conjugate_gradient.hpp"

#include <algorithm>
#include <cmath>

#include "muslin/solver/vector_operations.hpp"

namespace muslin {

LinearReport conjugate_gradient(const IncrementalPotential& function, ConstVectors x,
                                const Preconditioner& preconditioner, ConstVectors b,
                                const LinearSettings& settings, Vectors s, Vectors residual) {
  const std::size_t count = b.size();
  std::vector<Vec3> z(count), p(count), hp(count);
  std::copy(b.begin(), b.end(), residual.begin());
  std::fill(s.begin(), s.end(), Vec3::Zero());
  preconditioner.apply(residual, z);
  std::copy(z.begin(), z.end(), p.begin());
  double rz = dot(residual, z);
  const double stop = settings.tolerance * settings.tolerance * rz;
  const double first = rz;

  LinearReport report;
  if (rz == 0) {
    report.converged = true;
    report.relative_residual = 0;
    return report;
  }
  while (report.iterations < settings.max_iterations) {
    function.hessian_product(x, p, hp);
    ++report.iterations;
    const double curvature = dot(p, hp);
    if (!std::isfinite(curvature) || curvature == 0) break;
    if (curvature < 0 && settings.negative_curvature == NegativeCurvature::stop) {
      if (report.iterations == 1) std::copy(p.begin(), p.end(), s.begin());
      report.negative_curvature = true;
      break;
    }
    const double alpha = rz / curvature;
    add(alpha, p, s);
    add(-alpha, hp, residual);
    preconditioner.apply(residual, z);
    const double rz_next = dot(residual, z);
    report.converged = rz_next <= stop;
    const double beta = rz_next / rz;
    rz = rz_next;
    if (report.converged) break;
    combine(z, beta, p, p);
  }
  report.relative_residual = std::sqrt(rz / first);
  return report;
}

}  // namespace muslin
