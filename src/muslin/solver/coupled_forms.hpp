// CoupledForms are the terms factor · Σ c_ef gₑ g_fᵀ of a FormCoupling in a linear system, multiplied in
// three passes: all gₑ·p, then the coefficients, then back to the vertices.
#pragma once

#include <cstddef>
#include <memory>

#include "muslin/core/buffer.hpp"
#include "muslin/core/float4.hpp"
#include "muslin/potential/form_coupling.hpp"

namespace muslin {

class CoupledForms {
 public:
  /// Resets for vertices first, first + 1, …; returns g, four vectors per form, for the caller to set.
  Float4* reset(std::shared_ptr<const FormCoupling> coupling, std::size_t first, double factor);

  std::size_t first() const { return first_; }
  /// y += C p on the body's vertices, three floats and a zero per vertex; p and y begin at the body's first
  /// vertex. Returns pᵀC p.
  double add_product(const Float4* p, Float4* y);

  std::size_t bytes() const { return gradients_.bytes() + along_.bytes() + moments_.bytes(); }

 private:
  std::shared_ptr<const FormCoupling> coupling_;
  std::size_t first_ = 0;
  float factor_ = 0;
  Buffer<Float4> gradients_;
  Buffer<float> along_, moments_;  // by form: g·p and the factor of g
};

}  // namespace muslin
