#include "muslin/component/changing_terms.hpp"

#include <algorithm>
#include <mutex>
#include <string>
#include <utility>

#include "muslin/potential/restricted.hpp"

namespace muslin {
namespace {

/// Keeps the component of the last numbers. No result depends on what is kept.
class LatestComponent {
 public:
  explicit LatestComponent(ChangingComponent changing) : changing_(std::move(changing)) {}

  std::shared_ptr<const Component> at(double time) const {
    std::vector<double> numbers = changing_.numbers(time);
    {
      const std::scoped_lock lock(mutex_);
      if (component_ && numbers == numbers_) return component_;
    }
    std::shared_ptr<const Component> component = changing_.make(time);
    const std::scoped_lock lock(mutex_);
    numbers_ = std::move(numbers);
    component_ = component;
    return component;
  }

 private:
  ChangingComponent changing_;
  mutable std::mutex mutex_;
  mutable std::vector<double> numbers_;
  mutable std::shared_ptr<const Component> component_;
};

template <class Term>
const Term* find_term(const std::vector<Term>& terms, const std::string& name) {
  const auto at =
      std::find_if(terms.begin(), terms.end(), [&](const Term& term) { return term.name == name; });
  return at != terms.end() ? &*at : nullptr;
}

/// The potential of a term in one step, with the load that yielded it; null: it is no load.
class ActingTerm : public RestrictedPotential {
 public:
  ActingTerm(std::shared_ptr<const Potential> potential, std::size_t vertices,
             std::shared_ptr<const Load> load)
      : RestrictedPotential(std::move(potential), 0, vertices), load_(std::move(load)) {}

  const Load* load() const { return load_.get(); }

 private:
  std::shared_ptr<const Load> load_;
};

class ChangingTerm : public Load {
 public:
  ChangingTerm(std::shared_ptr<const LatestComponent> components, std::string name)
      : components_(std::move(components)), name_(std::move(name)) {}

  std::unique_ptr<Potential> potential(const StepContext& step) const override {
    const std::shared_ptr<const Component> component = components_->at(step.time_end);
    const std::size_t vertices = step.positions.size();
    if (const PotentialTerm* term = find_term(component->potentials, name_))
      return std::make_unique<ActingTerm>(term->potential, vertices, nullptr);
    const LoadTerm* term = find_term(component->loads, name_);
    std::unique_ptr<Potential> potential = term != nullptr ? term->load->potential(step) : nullptr;
    if (!potential) return nullptr;
    return std::make_unique<ActingTerm>(std::move(potential), vertices, term->load);
  }

  void end_step(const Potential& potential, ConstVectors x, History& history) const override {
    const auto& acting = static_cast<const ActingTerm&>(potential);
    if (acting.load() != nullptr) acting.load()->end_step(acting.local(), x, history);
  }

 private:
  std::shared_ptr<const LatestComponent> components_;
  std::string name_;
};

}  // namespace

void add_changing_terms(Component& component, ChangingComponent changing) {
  const std::vector<double> times = changing.times;
  const auto components = std::make_shared<const LatestComponent>(std::move(changing));
  const auto add = [&](const std::string& name, EnergyRole role) {
    if (find_term(component.loads, name) == nullptr)
      component.loads.push_back({name, role, std::make_shared<ChangingTerm>(components, name)});
  };
  for (const double time : times) {
    const std::shared_ptr<const Component> at_time = components->at(time);
    for (const PotentialTerm& term : at_time->potentials) add(term.name, term.role);
    for (const LoadTerm& term : at_time->loads) add(term.name, term.role);
    BodyStatistics& s = component.statistics;
    s.stable_step = std::min(s.stable_step, at_time->statistics.stable_step);
    s.undamped_step = std::min(s.undamped_step, at_time->statistics.undamped_step);
  }
}

}  // namespace muslin
