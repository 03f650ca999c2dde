#include "muslin/energy/solid_energy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "muslin/core/error.hpp"
#include "muslin/lattice/lattice_moduli.hpp"
#include "muslin/lattice/springs.hpp"

namespace muslin {
namespace {

using Tetrahedra = std::vector<std::array<int, 4>>;

constexpr int tetrahedron_reaches = 4;  // tetrahedra between slabs are computed twice: keep them few

std::shared_ptr<const ElementSlabs<4>> slabs_of(const Tetrahedra& tetrahedra, const Lattice& lattice) {
  int reach = 1;
  for (const auto& t : tetrahedra) {
    const auto [least, most] = std::minmax_element(t.begin(), t.end());
    reach = std::max(reach, *most - *least);
  }
  const int count = static_cast<int>(lattice.vertex_count());
  const int smallest = std::min(tetrahedron_reaches * reach, std::max(1, (count + 3) / 4));
  return std::make_shared<const ElementSlabs<4>>(tetrahedra, lattice.vertex_count(), smallest);
}

TetrahedronStencil stencil_of(const ElementSlabs<4>& slabs, const Tetrahedra& tetrahedra,
                              const Lattice& lattice) {
  std::vector<Mat3> inverses;
  std::vector<double> volumes;
  const double volume = lattice.width * lattice.width * lattice.width / 6;
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    const auto corner = [&](std::size_t c) {
      return lattice.vertices[static_cast<std::size_t>(tetrahedra[t][c])];
    };
    Mat3 edges;
    for (int c = 0; c < 3; ++c)
      edges.col(c) = (corner(static_cast<std::size_t>(c) + 1) - corner(0)).cast<double>();
    // Edges of whole numbers with determinant 1 have an inverse of whole numbers.
    inverses.emplace_back(edges.inverse().array().round() / lattice.width);
    volumes.push_back(lattice.fill[t / 6] * volume);
  }
  return {slabs, inverses, volumes};
}

}  // namespace

void require_moduli(const SolidModuli& moduli) {
  require(moduli.youngs_modulus > 0 && std::isfinite(moduli.youngs_modulus),
          "Young's modulus of a solid is not positive", "give pascal");
  require(moduli.poisson > -1 && moduli.poisson < 0.5,
          "the Poisson ratio of a solid is not between -1 and 0.5", "give 0 to 0.49");
}

std::shared_ptr<const SymmetricPattern> tetrahedron_pattern(const Lattice& lattice) {
  std::vector<std::pair<int, int>> pairs;
  for (const auto& t : build_tetrahedra(lattice))
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t d = c + 1; d < 4; ++d) pairs.emplace_back(t[c], t[d]);
  return std::make_shared<const SymmetricPattern>(std::move(pairs), lattice.vertex_count());
}

SolidElements::SolidElements(const Lattice& lattice)
    : slabs(slabs_of(build_tetrahedra(lattice), lattice)),
      stencil(stencil_of(*slabs, build_tetrahedra(lattice), lattice)) {}

SolidSprings::SolidSprings(const Lattice& lattice, double youngs_modulus) {
  const Springs springs = build_springs(lattice, Bracing::kuhn);
  SpringNetwork network;
  network.vertex_count = static_cast<int>(lattice.vertex_count());
  for (const SpringRun& run : springs.runs) {
    network.runs.push_back({run.direction, run.a, run.b, run.length});
    for (int i = 0; i < run.length; ++i)
      network.weights.push_back(springs.share[static_cast<std::size_t>(run.first + i)]);
  }
  network_ = std::make_shared<const SpringNetwork>(std::move(network));
  const SpringModuli moduli = springs_for(youngs_modulus, std::nullopt, Bracing::kuhn);
  const std::array<double, 3> by_kind = {moduli.edge, moduli.face_diagonal, moduli.body_diagonal};
  for (const SpringDirection& direction : springs.directions)
    stiffness_.push_back(lattice.width * by_kind[static_cast<std::size_t>(direction.kind)]);
}

void SolidSprings::stand_in(ConstVectors x, const std::shared_ptr<const SymmetricPattern>& pattern,
                            double factor, HessianSink& into, std::size_t first) const {
  std::vector<CentralSpring> kinds;
  kinds.reserve(stiffness_.size());
  for (const double k : stiffness_) kinds.push_back({static_cast<float>(into.scale() * factor * k), 0});
  into.stand_in(pattern, network_, kinds, x, first);
}

}  // namespace muslin
