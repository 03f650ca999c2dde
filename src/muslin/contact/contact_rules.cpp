#include "muslin/contact/contact_rules.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "muslin/core/error.hpp"
#include "muslin/core/hash.hpp"

namespace muslin {
namespace {

void require_numbers(const ContactRule& rule) {
  if (rule.thickness.value_or(0) < 0 || rule.friction.value_or(0).least() < 0)
    throw Error(ErrorKind::usage, "a thickness or friction of a contact rule is negative", "give 0 or more");
  if (!(rule.range.value_or(1) > 0) || !(rule.stiffness.value_or(1) > 0))
    throw Error(ErrorKind::usage, "a distance or stiffness of a contact rule is not positive",
                "give a number above 0");
}

std::uint64_t hash_of(const ContactRule& rule, std::uint64_t seed) {
  constexpr double none = -1;
  const std::array numbers = {rule.touches ? 1.0 : 0.0,
                              rule.thickness.value_or(none),
                              rule.range.value_or(none),
                              rule.friction.value_or(none).keys.front().value,
                              rule.stiffness.value_or(none),
                              rule.from,
                              rule.until};
  for (const std::vector<int>& side : rule.sides)
    seed = hash_bytes(side.data(), side.size() * sizeof(int), seed);
  return hash_bytes(numbers.data(), sizeof numbers, seed);
}

}  // namespace

ContactRules::ContactRules(std::vector<ContactRule> rules, std::size_t point_count)
    : rules_(std::move(rules)) {
  if (rules_.size() > most)
    throw Error(ErrorKind::usage, "a contact surface has too many rules", "give at most 64");
  for (std::vector<Set>& side : sides_) side.assign(rules_.empty() ? 0 : point_count, 0);
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    require_numbers(rules_[r]);
    hash_ = hash_of(rules_[r], hash_);
    thickest_ = std::max(thickest_, rules_[r].thickness.value_or(0));
    for (std::size_t side = 0; side < 2; ++side) {
      for (const int point : rules_[r].sides[side]) {
        if (point < 0 || static_cast<std::size_t>(point) >= point_count)
          throw Error(ErrorKind::usage, "a contact rule has a point that does not exist",
                      "check the indices");
        sides_[side][static_cast<std::size_t>(point)] |= Set{1} << r;
      }
    }
  }
}

ContactRules::Set ContactRules::in_force(double time) const {
  Set active = 0;
  for (std::size_t r = 0; r < rules_.size(); ++r)
    if (time >= rules_[r].from && time < rules_[r].until) active |= Set{1} << r;
  return active;
}

int ContactRules::find(std::span<const int> first, std::span<const int> second, Set active) const {
  if (active == 0) return -1;
  const auto of = [&](std::span<const int> points, std::size_t side) {
    Set rules = 0;
    for (const int point : points) rules |= sides_[side][static_cast<std::size_t>(point)];
    return rules;
  };
  const Set both = ((of(first, 0) & of(second, 1)) | (of(first, 1) & of(second, 0))) & active;
  return both == 0 ? -1 : static_cast<int>(most) - 1 - std::countl_zero(both);
}

}  // namespace muslin
