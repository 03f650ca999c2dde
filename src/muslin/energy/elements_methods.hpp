// Defines the methods of Elements, for the source files that instantiate them.
#pragma once

#include "muslin/energy/elements.hpp"

namespace muslin {

/// The sum of the first `count` lanes.
inline double sum_of_lanes(const double* w, int count) {
  double sum = 0;
  for (int l = 0; l < count; ++l) sum += w[l];
  return sum;
}

template <class Stencil, class Law>
Elements<Stencil, Law>::Elements(std::shared_ptr<const Slabs> slabs, Stencil stencil,
                                 LawConstants<Law> constants, std::shared_ptr<const SymmetricPattern> pattern)
    : ElementEnergy(std::move(pattern)),
      slabs_(std::move(slabs)),
      stencil_(std::move(stencil)),
      constants_(std::move(constants)) {
  if (this->pattern())
    slots_ = std::make_shared<const std::vector<typename Slabs::Slots>>(slabs_->slots(*this->pattern()));
}

template <class Stencil, class Law>
Elements<Stencil, Law>::Elements(const Elements& other, LawConstants<Law> constants)
    : ElementEnergy(other.pattern()),
      slabs_(other.slabs_),
      stencil_(other.stencil_),
      constants_(std::move(constants)),
      slots_(other.slots_) {}

template <class Stencil, class Law>
double Elements<Stencil, Law>::value(ConstVectors x) const {
  return slabs_->sum(0.0, [&](int first, int count) {
    Batch<corners> at;
    double w[element_lanes];
    slabs_->gather(first, count, x, at);
    const bool any = Stencil::template energies<Law>(constants_.at(first), stencil_.at(first), at, w);
    return any ? sum_of_lanes(w, count) : 0.0;
  });
}

template <class Stencil, class Law>
double Elements<Stencil, Law>::add_gradient_and_value(ConstVectors x, Vectors g) const {
  return slabs_->sum_of_batches([&](int first, int count, int owned, const typename Slabs::Slab& slab) {
    Batch<corners> at, force;
    double w[element_lanes];
    slabs_->gather(first, count, x, at);
    if (!Stencil::template forces<Law>(constants_.at(first), stencil_.at(first), at, force, w)) return 0.0;
    slabs_->scatter(first, count, slab, force, g);
    return sum_of_lanes(w, owned);
  });
}

template <class Stencil, class Law>
void Elements<Stencil, Law>::add_gradient(ConstVectors x, Vectors g) const {
  add_gradient_and_value(x, g);
}

template <class Stencil, class Law>
void Elements<Stencil, Law>::add_stiffness_product(Stiffness kind, ConstVectors x, ConstVectors p,
                                                   Vectors y) const {
  slabs_->for_each_batch([&](int first, int count, const typename Slabs::Slab& slab) {
    Batch<corners> at, along, force;
    typename Stencil::template Stiff<Law> stiff;
    slabs_->gather(first, count, x, at);
    const auto rest = stencil_.at(first);
    if (!Stencil::template stiffen<Law>(kind, constants_.at(first), rest, MassBound{}, at, stiff)) return;
    slabs_->gather(first, count, p, along);
    Stencil::template multiply<Law>(constants_.at(first), rest, stiff, along, force);
    slabs_->scatter(first, count, slab, force, y);
  });
}

template <class Stencil, class Law>
void Elements<Stencil, Law>::add_stiffness_blocks(Stiffness kind, ConstVectors x,
                                                  std::span<Mat3> blocks) const {
  slabs_->for_each_batch([&](int first, int count, const typename Slabs::Slab& slab) {
    Batch<corners> at;
    typename Stencil::template Stiff<Law> stiff;
    slabs_->gather(first, count, x, at);
    const auto rest = stencil_.at(first);
    const LawLanes<Law> law = constants_.at(first);
    if (!Stencil::template stiffen<Law>(kind, law, rest, MassBound{}, at, stiff)) return;
    for (int l = 0; l < count; ++l) {
      const auto& vertices = slabs_->vertices()[static_cast<std::size_t>(first + l)];
      for (int c = 0; c < corners; ++c) {
        const int v = vertices[static_cast<std::size_t>(c)];
        if (v < slab.vertex_begin || v >= slab.vertex_end) continue;
        Stencil::template add_corner_block<Law>(law, rest, stiff, l, c, blocks[static_cast<std::size_t>(v)]);
      }
    }
  });
}

template <class Stencil, class Law>
void Elements<Stencil, Law>::add_stiffness_matrix(Stiffness kind, ConstVectors x, double scale,
                                                  std::span<const double> masses, PairBlocks blocks) const {
  slabs_->for_each_batch([&](int first, int count, const typename Slabs::Slab& slab) {
    Batch<corners> at;
    typename Stencil::template Stiff<Law> stiff;
    MassBound bound{scale, {}};
    if (kind == Stiffness::bounded) stencil_.find_held(first, count, masses, slabs_->vertices(), bound);
    slabs_->gather(first, count, x, at);
    const auto rest = stencil_.at(first);
    const LawLanes<Law> law = constants_.at(first);
    if (!Stencil::template stiffen<Law>(kind, law, rest, bound, at, stiff)) return;
    unsigned rows[element_lanes];
    slabs_->corners_in(first, count, slab, rows);
    Stencil::template add_pair_blocks<Law>(law, rest, stiff, scale, count, rows, slots_->data() + first,
                                           blocks.columns);
  });
}

}  // namespace muslin
