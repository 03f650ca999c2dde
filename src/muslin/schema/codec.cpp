#include "muslin/schema/codec.hpp"

#include <cmath>
#include <limits>

#include "muslin/core/nearest_name.hpp"

namespace muslin::schema {
namespace {

constexpr std::int64_t largest_whole = std::numeric_limits<std::int64_t>::max();

constexpr double closest_points = 1e-6;   // of a curve
constexpr double smallest_force = 1e-50;  // of a curve; products of slopes stay above underflow

std::int64_t lowest(const Key& key) {
  return std::isfinite(key.range.min) ? static_cast<std::int64_t>(key.range.min) : -largest_whole;
}
std::int64_t greatest(const Key& key) {
  return std::isfinite(key.range.max) ? static_cast<std::int64_t>(key.range.max) : largest_whole;
}

}  // namespace

void NumberCodec::check(const Key& key, double x, const Subject& subject) const {
  if (!fits(x, key.range))
    throw subject.error(key.name, fmt::format("`{}` is {}", key.name, x),
                        fmt::format("give a number{}", range_text(key.range, key.unit)));
}

std::int64_t WholeNumberCodec::read_whole_number(const Key& key, const TomlTable& table) {
  return table.integer(key.name, lowest(key), greatest(key), 0);
}

void WholeNumberCodec::check(const Key& key, std::int64_t x, const Subject& subject) const {
  if (x < lowest(key) || x > greatest(key))
    throw subject.error(key.name, fmt::format("`{}` is {}", key.name, x),
                        fmt::format("give a whole number from {} to {}", lowest(key), greatest(key)));
}

void WordCodec::check_index(const Key& key, std::size_t index, const Subject& subject) {
  if (index >= key.choices.size())
    throw subject.error(key.name, fmt::format("`{}` is not one of its choices", key.name),
                        fmt::format("use one of {}", name_list(key.choices)));
}

TomlValue TextsCodec::write(const Key&, const Texts& texts) const {
  TomlValue items = list({});
  for (const std::string& text : texts) items.items.push_back(words(text));
  return items;
}

TextsCodec::Texts TextsCodec::read_texts(const Key& key, const TomlTable& table) {
  Texts texts;
  for (const TomlValue& item : *table.array(key.name, "texts in quotes")) {
    if (item.type != TomlValue::Type::string)
      throw Error(ErrorKind::input, item.place, fmt::format("an item of `{}` is no text", key.name),
                  fmt::format("give {}", described(key)));
    texts.push_back(item.string);
  }
  return texts;
}

Vec3 VectorCodec::read_vector(const Key& key, const TomlTable& table) {
  return to_vector(*table.find(key.name), fmt::format("`{}` of {}", key.name, table.title()), key.unit,
                   key.range);
}

void VectorCodec::check(const Key& key, const Vec3& v, const Subject& subject) const {
  if (!v.allFinite())
    throw subject.error(key.name, fmt::format("`{}` is not finite", key.name), "give three finite numbers");
  for (const double x : v) {
    if (!fits(x, key.range))
      throw subject.error(key.name, fmt::format("`{}` has a component of {}", key.name, x),
                          fmt::format("give numbers{}", range_text(key.range, key.unit)));
  }
}

void DirectionCodec::check(const Key& key, const Vec3& v, const Subject& subject) const {
  const double length = v.stableNorm();
  if (!(length > 0) || !std::isfinite(length))
    throw subject.error(key.name, fmt::format("`{}` has no direction", key.name),
                        fmt::format("give for example {}", example));
}

void ColourCodec::check(const Key& key, const Vec3& v, const Subject& subject) const {
  if (!v.allFinite() || v.minCoeff() < 0 || v.maxCoeff() > 1)
    throw subject.error(key.name, "a colour is red, green and blue from 0 to 1",
                        "write for example [0.2, 0.5, 0.2]");
}

TomlValue CurveCodec::write(const Key&, const Curve& curve) const {
  TomlValue points = list({});
  for (const Vec2& point : curve) points.items.push_back(list({real(point[0]), real(point[1])}));
  return points;
}

CurveCodec::Curve CurveCodec::read_curve(const Key& key, const TomlTable& table) {
  Curve curve;
  for (const TomlValue& item : *table.array(key.name, described(key))) {
    if (item.type != TomlValue::Type::array || item.items.size() != 2)
      throw table.error(key.name, fmt::format("a point of `{}` is no pair of numbers", key.name),
                        fmt::format("give {}", described(key)));
    const std::string name = fmt::format("a number of `{}`", key.name);
    curve.emplace_back(to_number(item.items[0], name, "", key.range), to_number(item.items[1], name, ""));
  }
  CurveCodec{}.check(key, curve, Subject(table));
  return curve;
}

void CurveCodec::check(const Key& key, const Curve& curve, const Subject& subject) const {
  const bool has_origin = !curve.empty() && curve.front() == Vec2::Zero();
  const std::size_t count = curve.size() - (has_origin ? 1 : 0);
  if (count == 0 || count > key.count)
    throw subject.error(key.name, fmt::format("`{}` has {} points beside the origin", key.name, count),
                        fmt::format("give 1 to {}, close to each other where the curve bends", key.count));
  Vec2 before = Vec2::Zero();
  for (std::size_t i = has_origin ? 1 : 0; i < curve.size(); ++i) {
    const Vec2& point = curve[i];
    const bool ascends = point[0] >= before[0] + closest_points && point[1] > before[1];
    if (!ascends || !fits(point[0], key.range) || !fits(point[1], {smallest_force, largest_component, false}))
      throw subject.error(
          key.name,
          fmt::format("`{}` goes from [{}, {}] to [{}, {}]", key.name, before[0], before[1], point[0],
                      point[1]),
          fmt::format("begin at [0, 0] or leave it out, and let both numbers ascend: the first by {} or "
                      "more, up to {}, the second from {} to {}",
                      closest_points, key.range.max, smallest_force, largest_component));
    before = point;
  }
}

const std::vector<TomlValue>& section_values(const std::string& name, const TomlTable& top) {
  const TomlValue& value = *top.find(name);
  if (value.type != TomlValue::Type::array)
    throw top.error(name, fmt::format("`{}` is not a list of tables", name),
                    fmt::format("write [[{}]] in two brackets", name));
  return value.items;
}

std::string section_title(const std::string& name, const TomlValue& value, std::size_t index) {
  const TomlValue* own = value.find("name");
  const bool has_name = own != nullptr && own->type == TomlValue::Type::string;
  return fmt::format("[[{}]] {}", name, has_name ? own->string : std::to_string(index));
}

const std::vector<TomlValue>& keyframe_values(const std::string& name, const TomlTable& owner) {
  const auto& items = *owner.array(name, "tables such as { time = 0, … }");
  if (items.empty()) throw owner.error(name, fmt::format("`{}` is empty", name), "remove it or give keys");
  return items;
}

void require_later(const TomlTable& keyframe, double before, double time) {
  if (time > before) return;
  throw keyframe.error("time",
                       fmt::format("the keyframe at {} s does not come after that at {} s", time, before),
                       "order keyframes by time, one at a time");
}

}  // namespace muslin::schema
