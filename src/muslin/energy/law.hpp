// A law states how an element resists its measure: the metric of a triangle, the angle of a hinge, the
// deformation of a tetrahedron. It is a struct without data:
//
//   Constants     doubles only, derived from the parameters once for each element; with `shared` of any
//                 type, the same for all elements
//   energy, …     ψ and its derivatives, as the stencil of the element asks for them
//
// All functions are of one element and forced inline, so that the stencil's loops over lanes vectorise.
// elements.hpp joins a law and a stencil.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "muslin/core/vector_code.hpp"
#include "muslin/energy/element_slabs.hpp"

namespace muslin {

/// One number per element, by entry of ElementSlabs. If all are equal, one batch is stored and read for every
/// element.
class LaneArray {
 public:
  LaneArray() = default;
  /// `values` come from ElementSlabs::by_entry.
  explicit LaneArray(std::vector<double> values);
  /// The numbers of entries first, first + 1, …, for one batch.
  const double* at(int first) const { return values_.data() + (uniform_ ? 0 : first); }
  bool empty() const { return values_.empty(); }

 private:
  std::vector<double> values_;
  bool uniform_ = false;
};

template <class Law>
concept SharedLaw = requires { requires Law::shared; };

/// The constants of a law for one batch of elements.
template <class Law>
class LawLanes {
 public:
  using Constants = typename Law::Constants;
  static constexpr std::size_t count = sizeof(Constants) / sizeof(double);
  explicit LawLanes(const std::array<const double*, count>& lanes) : lanes_(lanes) {}
  MUSLIN_INLINE Constants operator[](int l) const { return load(l, std::make_index_sequence<count>()); }

 private:
  template <std::size_t... I>
  MUSLIN_INLINE Constants load(int l, std::index_sequence<I...>) const {
    return Constants{lanes_[I][l]...};
  }
  std::array<const double*, count> lanes_;
};

template <SharedLaw Law>
class LawLanes<Law> {
 public:
  using Constants = typename Law::Constants;
  explicit LawLanes(const Constants& constants) : constants_(constants) {}
  MUSLIN_INLINE const Constants& operator[](int) const { return constants_; }

 private:
  const Constants& constants_;
};

/// The constants of a law for every element.
template <class Law>
class LawConstants {
 public:
  static constexpr std::size_t count = LawLanes<Law>::count;

  /// constants_of(e) are those of element e.
  template <int N, class Get>
  LawConstants(const ElementSlabs<N>& slabs, const Get& constants_of) {
    const auto all = slabs.template by_entry<typename Law::Constants>(constants_of);
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<double> values;
      values.reserve(all.size());
      for (const auto& constants : all) values.push_back(reinterpret_cast<const double*>(&constants)[i]);
      values_[i] = LaneArray(std::move(values));
    }
  }

  LawLanes<Law> at(int first) const {
    std::array<const double*, count> lanes;
    for (std::size_t i = 0; i < count; ++i) lanes[i] = values_[i].at(first);
    return LawLanes<Law>(lanes);
  }

 private:
  std::array<LaneArray, count> values_;
};

template <SharedLaw Law>
class LawConstants<Law> {
 public:
  explicit LawConstants(const typename Law::Constants& constants) : constants_(constants) {}
  LawLanes<Law> at(int) const { return LawLanes<Law>(constants_); }

 private:
  typename Law::Constants constants_;
};

}  // namespace muslin
