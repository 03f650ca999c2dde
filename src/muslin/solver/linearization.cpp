#include "muslin/solver/linearization.hpp"

#include <algorithm>
#include <cassert>

#include "muslin/core/parallel.hpp"
#include "muslin/potential/potential.hpp"
#include "muslin/solver/spring_hessian_kernels.hpp"

namespace muslin {
namespace {

constexpr std::size_t vertex_grain = 8192;  // vertices
/// Contact adds at most this times the mass to a diagonal block of the preconditioner. With more, float and
/// the packed factors of sixteen vertices would lose masses.
constexpr float max_relative = 1e5;

}  // namespace

void Linearization::reset(std::span<const double> masses, std::span<const std::uint8_t> fixed, double scale) {
  masses_ = masses;
  fixed_ = fixed;
  scale_ = scale;
  sets_.clear();
  matrices_.clear();
  stood_for_.clear();
  for (const auto& stand_in : stand_ins_) {
    stand_in->kinds.clear();
    stand_in->springs = nullptr;
    stand_in->filled = false;
    stand_in->in_use = true;
  }
  generals_.clear();
  rank_ones_.clear();
  relative_count_ = 0;
  forms_count_ = 0;
  stiffest_relative_ = 0;
  identity_.resize(masses.size());
  for (std::size_t v = 0; v < masses.size(); ++v) identity_.data()[v] = static_cast<float>(masses[v]);
}

const Linearization::Arranged& Linearization::arranged(const std::shared_ptr<const SpringNetwork>& network) {
  for (const auto& known : networks_)
    if (known->network == network) return *known;
  std::vector<std::int64_t> order;
  const bool weighted = !network->weights.empty();
  Arranged arranged;
  arranged.network = network;
  arranged.pattern = std::make_shared<const EliminationOrder>(network->runs, network->vertex_count,
                                                              weighted ? &order : nullptr);
  for (const std::int64_t spring : order)
    arranged.weights.push_back(spring < 0 ? 0.0F : network->weights[static_cast<std::size_t>(spring)]);
  return *networks_.emplace_back(std::make_unique<Arranged>(std::move(arranged)));
}

void Linearization::set_springs(const std::shared_ptr<const SpringNetwork>& network,
                                std::span<const CentralSpring> kinds, ConstVectors x, std::size_t first) {
  const Arranged& a = arranged(network);
  set_spring_hessian({kinds, a.weights.empty() ? nullptr : a.weights.data(), x,
                      workspace(2 * 3 * a.pattern->position_count())},
                     couplings(a.pattern, first));
}

void Linearization::add_dashpots(const std::shared_ptr<const SpringNetwork>& network,
                                 std::span<const CentralSpring> kinds, ConstVectors x, std::size_t first) {
  const Arranged& a = arranged(network);
  add_dashpot_hessian({kinds, a.weights.empty() ? nullptr : a.weights.data(), x,
                       workspace(2 * 3 * a.pattern->position_count())},
                      couplings(a.pattern, first));
}

void Linearization::stand_in(const std::shared_ptr<const SymmetricPattern>& pattern,
                             const std::shared_ptr<const SpringNetwork>& network,
                             std::span<const CentralSpring> kinds, ConstVectors x, std::size_t first) {
  auto known = std::find_if(stand_ins_.begin(), stand_ins_.end(), [&](const auto& s) {
    return s->pattern == pattern && s->network == network && s->first == first;
  });
  if (known == stand_ins_.end()) {
    StandIn made;
    made.pattern = pattern, made.network = network, made.first = first;
    const EliminationOrder& order = *arranged(network).pattern;
    for (const EliminationOrder::Block& block : order.blocks()) {
      for (int l = 0; l < EliminationOrder::lanes; ++l) {
        made.slots.push_back(FullCouplings::none);
        if ((block.used >> l & 1) == 0) continue;
        const auto vertex = [&](int base) { return order.vertex(static_cast<std::size_t>(base + l)); };
        const int earlier = vertex(l < block.cut ? block.first : block.second),
                  later = vertex(EliminationOrder::lanes * block.group);
        made.slots.back() = later < earlier ? pattern->find(later, earlier) : ~pattern->find(earlier, later);
      }
    }
    stand_ins_.push_back(std::make_unique<StandIn>(std::move(made)));
    known = stand_ins_.end() - 1;
  }
  StandIn& stand_in = **known;
  if (stand_in.kinds.empty()) {
    stand_in.kinds.assign(kinds.begin(), kinds.end());
    stand_in.x = x;
    return;
  }
  for (std::size_t k = 0; k < kinds.size(); ++k) stand_in.kinds[k].stiffness += kinds[k].stiffness;
}

void Linearization::put_stand_ins() {
  std::erase_if(stand_ins_, [](const auto& stand_in) { return stand_in->kinds.empty(); });
  for (const auto& stand_in : stand_ins_) {
    SymmetricMatrix& of_pattern = matrix(stand_in->pattern, stand_in->first);
    const std::size_t end = stand_in->first + stand_in->pattern->vertex_count();
    const bool occupied = std::any_of(sets_.begin(), sets_.end(), [&](const SpringHessian* set) {
      return set->first() < end &&
             stand_in->first < set->first() + static_cast<std::size_t>(set->pattern().vertex_count());
    });
    if (occupied) {
      of_pattern.close_rows();
      continue;
    }
    stand_in->springs = &couplings(arranged(stand_in->network).pattern, stand_in->first);
    stand_in->full.set(of_pattern, stand_in->slots);
    std::erase(matrices_, &of_pattern);
    stood_for_.push_back(&of_pattern);
  }
}

void Linearization::fill_stand_ins() {
  for (const auto& stand_in : stand_ins_) {
    if (!stand_in->springs || stand_in->filled) continue;
    stand_in->filled = true;
    const Arranged& a = arranged(stand_in->network);
    Buffer<float> room;  // the solver may be using the workspace
    room.resize(2 * 3 * a.pattern->position_count());
    add_dashpot_hessian({stand_in->kinds,
                         a.weights.empty() ? nullptr : a.weights.data(),
                         stand_in->x,
                         {room.data(), room.size()}},
                        *stand_in->springs);
  }
}

const FullCouplings* Linearization::full(const SpringHessian& set) const {
  for (const auto& stand_in : stand_ins_)
    if (stand_in->springs == &set && stand_in->in_use) return &stand_in->full;
  return nullptr;
}

SpringHessian& Linearization::couplings(const std::shared_ptr<const EliminationOrder>& pattern,
                                        std::size_t first) {
  for (const auto& set : storage_) {
    if (&set->pattern() != pattern.get() || set->first() != first) continue;
    if (std::find(sets_.begin(), sets_.end(), set.get()) == sets_.end()) {
      set->clear();
      sets_.push_back(set.get());
    }
    return *set;
  }
  storage_.push_back(std::make_unique<SpringHessian>(pattern, first));
  sets_.push_back(storage_.back().get());
  return *storage_.back();
}

PairBlocks Linearization::pair_blocks_to_set(const std::shared_ptr<const SymmetricPattern>& pattern,
                                             std::size_t first, bool& fresh) {
  const std::size_t known = matrices_.size();
  const PairBlocks blocks = matrix(pattern, first, false).blocks();
  fresh = matrices_.size() > known;
  return blocks;
}

SymmetricMatrix& Linearization::matrix(const std::shared_ptr<const SymmetricPattern>& pattern,
                                       std::size_t first, bool zero) {
  const auto stored = std::find_if(matrix_storage_.begin(), matrix_storage_.end(),
                                   [&](const auto& m) { return m->is_of(pattern) && m->first() == first; });
  const bool is_new = stored == matrix_storage_.end();
  if (is_new) matrix_storage_.push_back(std::make_unique<SymmetricMatrix>());
  SymmetricMatrix& matrix = is_new ? *matrix_storage_.back() : **stored;
  if (std::find(matrices_.begin(), matrices_.end(), &matrix) == matrices_.end()) {
    matrix.reset(pattern, first, zero);
    matrices_.push_back(&matrix);
  }
  return matrix;
}

void Linearization::add_general(const Potential& potential, std::size_t first, ConstVectors x) {
  generals_.push_back({&potential, first, x});
}

void Linearization::add_rank_one(RankOneTerm term, std::size_t first) {
  if (term.factor > 0) rank_ones_.push_back({std::move(term), first});
}

RelativeTerms Linearization::relative_terms(std::size_t first, std::size_t count, std::size_t terms,
                                            std::size_t weights) {
  if (relative_count_ == relatives_.size()) relatives_.push_back(std::make_unique<RelativeStiffness>());
  RelativeStiffness& relative = *relatives_[relative_count_++];
  relative.reset(first, count);
  return relative.resize(terms, weights);
}

Float4* Linearization::coupled_forms(const std::shared_ptr<const FormCoupling>& coupling, std::size_t first,
                                     double factor) {
  if (forms_count_ == forms_.size()) forms_.push_back(std::make_unique<CoupledForms>());
  return forms_[forms_count_++]->reset(coupling, first, factor);
}

/// Adds empty couplings in pieces that end where block matrices do: packing groups of vertices with a common
/// unit would lose cloth beside a rigid body, which is a million times as stiff.
void Linearization::cover_gap(std::size_t begin, std::size_t end) {
  for (const SymmetricMatrix* matrix : matrices_) {
    for (const std::size_t cut : {matrix->first(), matrix->first() + matrix->pattern().vertex_count()}) {
      if (cut <= begin || cut >= end) continue;
      cover_gap(begin, cut);
      return cover_gap(cut, end);
    }
  }
  if (begin == end) return;
  const int count = static_cast<int>(end - begin);
  for (const auto& set : storage_) {
    const bool empty = set->pattern().block_count() == 0;
    if (!empty || set->first() != begin || set->pattern().vertex_count() != count) continue;
    sets_.push_back(set.get());
    return;
  }
  const auto pattern = std::make_shared<const EliminationOrder>(std::span<const CouplingRun>(), count);
  storage_.push_back(std::make_unique<SpringHessian>(pattern, begin));
  sets_.push_back(storage_.back().get());
}

void Linearization::finish() {
  put_stand_ins();
  const auto by_vertex = [](const SpringHessian* p, const SpringHessian* q) {
    return p->first() < q->first();
  };
  std::sort(sets_.begin(), sets_.end(), by_vertex);
  std::size_t covered = 0;
  const std::size_t with_couplings = sets_.size();
  for (std::size_t s = 0; s < with_couplings; ++s) {
    assert(sets_[s]->first() >= covered);
    cover_gap(covered, sets_[s]->first());
    covered = sets_[s]->first() + static_cast<std::size_t>(sets_[s]->pattern().vertex_count());
  }
  cover_gap(covered, size());
  std::sort(sets_.begin(), sets_.end(), by_vertex);
  // Drops sets of bodies that no longer occur.
  std::erase_if(storage_,
                [&](const auto& c) { return std::find(sets_.begin(), sets_.end(), c.get()) == sets_.end(); });

  std::erase_if(networks_, [&](const auto& n) {
    return std::none_of(sets_.begin(), sets_.end(),
                        [&](const SpringHessian* set) { return &set->pattern() == n->pattern.get(); });
  });
  std::erase_if(matrix_storage_, [&](const auto& m) {
    return std::find(matrices_.begin(), matrices_.end(), m.get()) == matrices_.end() &&
           std::find(stood_for_.begin(), stood_for_.end(), m.get()) == stood_for_.end();
  });
  for (std::size_t i = 0; i < relative_count_; ++i) relatives_[i]->finish();
  if (has_remainder()) find_remainder_diagonal();
}

void Linearization::find_remainder_diagonal() {
  upper_.resize(size());
  lower_.resize(size());
  const Floats u = upper_.data(), l = lower_.data();
  for (float* each : {u.x, u.y, u.z, l.x, l.y, l.z}) std::fill_n(each, size(), 0.0F);
  for (const SymmetricMatrix* matrix : matrices_) {
    const auto first = static_cast<std::ptrdiff_t>(matrix->first());
    matrix->add_diagonal(u + first, l + first);
  }
  for (std::size_t i = 0; i < relative_count_; ++i) {
    const auto first = static_cast<std::ptrdiff_t>(relatives_[i]->first());
    const double stiffest = relatives_[i]->add_diagonal(identity() + first, fixed_.data() + first,
                                                        max_relative, u + first, l + first);
    stiffest_relative_ = std::max(stiffest_relative_, stiffest);
  }
  for (const RankOne& rank_one : rank_ones_) {
    for (std::size_t i = 0; i < rank_one.term.vertices.size(); ++i) {
      const std::size_t v = rank_one.first + static_cast<std::size_t>(rank_one.term.vertices[i]);
      const Vec3& g = rank_one.term.gradients[i];
      const Vec3 scaled = rank_one.term.factor * g;
      u.x[v] += static_cast<float>(scaled.x() * g.x());
      u.y[v] += static_cast<float>(scaled.x() * g.y());
      u.z[v] += static_cast<float>(scaled.x() * g.z());
      l.x[v] += static_cast<float>(scaled.y() * g.y());
      l.y[v] += static_cast<float>(scaled.y() * g.z());
      l.z[v] += static_cast<float>(scaled.z() * g.z());
    }
  }
  if (generals_.empty()) return;
  blocks_.assign(size(), Mat3::Zero());
  for (const General& g : generals_)
    g.potential->add_diagonal_blocks(g.x, std::span(blocks_).subspan(g.first, g.x.size()));
  parallel_for(size(), vertex_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Mat3 block = scale_ * blocks_[v];
      u.x[v] += static_cast<float>(block(0, 0));
      u.y[v] += static_cast<float>(block(1, 0));
      u.z[v] += static_cast<float>(block(2, 0));
      l.x[v] += static_cast<float>(block(1, 1));
      l.y[v] += static_cast<float>(block(2, 1));
      l.z[v] += static_cast<float>(block(2, 2));
    }
  });
}

bool Linearization::has_springs() const {
  return std::any_of(sets_.begin(), sets_.end(),
                     [](const SpringHessian* set) { return set->pattern().block_count() > 0; });
}

void Linearization::project() {
  fill_stand_ins();
  for (const auto& stand_in : stand_ins_) stand_in->in_use = false;
  for (const auto& set : storage_) set->project();
}

double Linearization::add_remainder_product(const Float4* p, Float4* y) {
  double sum = 0;
  for (const SymmetricMatrix* matrix : matrices_)
    sum += matrix->add_product(p + matrix->first(), y + matrix->first());
  for (std::size_t i = 0; i < relative_count_; ++i)
    sum += relatives_[i]->add_product(p + relatives_[i]->first(), y + relatives_[i]->first());
  for (std::size_t i = 0; i < forms_count_; ++i)
    sum += forms_[i]->add_product(p + forms_[i]->first(), y + forms_[i]->first());
  for (const RankOne& rank_one : rank_ones_) {
    const auto& [factor, vertices, gradients] = rank_one.term;
    const auto at = [&](std::size_t i) { return rank_one.first + static_cast<std::size_t>(vertices[i]); };
    double along = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Float4& d = p[at(i)];
      along += gradients[i].dot(Vec3(d[0], d[1], d[2]));
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vec3 f = factor * along * gradients[i];
      y[at(i)] += Float4{static_cast<float>(f.x()), static_cast<float>(f.y()), static_cast<float>(f.z()), 0};
    }
    sum += factor * along * along;
  }
  if (generals_.empty()) return sum;
  p_.resize(size());
  y_.resize(size());
  parallel_for(size(), vertex_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      p_[v] = Vec3(p[v][0], p[v][1], p[v][2]);
      y_[v].setZero();
    }
  });
  for (const General& g : generals_) {
    g.potential->add_hessian_product(g.x, std::span(p_).subspan(g.first, g.x.size()),
                                     std::span(y_).subspan(g.first, g.x.size()));
  }
  return sum + parallel_sum(size(), vertex_grain, 0.0, [&](std::size_t begin, std::size_t end) {
           double part = 0;
           for (std::size_t v = begin; v < end; ++v) {
             const Vec3 f = scale_ * y_[v];
             y[v] +=
                 Float4{static_cast<float>(f.x()), static_cast<float>(f.y()), static_cast<float>(f.z()), 0};
             part += f.dot(p_[v]);
           }
           return part;
         });
}

std::size_t Linearization::bytes() const {
  std::size_t bytes = identity_.bytes() + workspace_.bytes() + upper_.bytes() + lower_.bytes() +
                      (p_.capacity() + y_.capacity()) * sizeof(Vec3) + blocks_.capacity() * sizeof(Mat3);
  for (const auto& set : storage_) bytes += set->bytes();
  for (const auto& matrix : matrix_storage_) bytes += matrix->bytes();
  for (const auto& stand_in : stand_ins_) bytes += stand_in->full.bytes();
  for (const auto& relative : relatives_) bytes += relative->bytes();
  for (const auto& forms : forms_) bytes += forms->bytes();
  return bytes;
}

}  // namespace muslin
