#include "muslin/component/component_keys.hpp"

#include <algorithm>

#include "muslin/component/placement.hpp"
#include "muslin/schema/keyframe_keys.hpp"

namespace muslin {
namespace {

using schema::Key;
using schema::Type;

template <class S>
schema::Declaration scale_of(Vec3 S::* member) {
  Key key = schema::vector("scale", member).range(Range::positive());
  key.types = {Type::number, Type::vector};
  key.read = [member](const Key& k, const TomlTable& table, void* s) {
    const TomlValue& value = *table.find(k.name);
    const std::string name = fmt::format("`{}` of {}", k.name, table.title());
    const bool per_axis = value.type == TomlValue::Type::array;
    static_cast<S*>(s)->*member = per_axis ? to_vector(value, name, k.unit, k.range)
                                           : Vec3(Vec3::Constant(to_number(value, name, k.unit, k.range)));
  };
  return schema::Declaration(std::move(key)).otherwise("1").means("a number or one per axis; applied first");
}

const schema::Table& motion_keyframe_table() {
  static const schema::Table table = schema::table_of<Motion::Key>(
      "keyframes of a motion",
      {schema::number("time", &Motion::Key::time)
           .unit("s")
           .required()
           .means("time of the keyframe, later than the previous one"),
       schema::vector("translate", &Motion::Key::translate)
           .unit("m")
           .means("displacement from the modelled place"),
       schema::custom<Motion::Key>(
           "rotate", {Type::vector},
           [](const Key& key, const TomlTable& given, Motion::Key& s) {
             s.angles = given.vector(key.name, key.unit);
             s.rotate = rotation_from_degrees(s.angles);
           },
           [](const Key& key, const Motion::Key& s, TomlValue& out) {
             // A quaternion does not tell a full turn from none.
             if (s.angles.cwiseAbs().maxCoeff() >= 180)
               schema::append(out, key.name, schema::vector_value(s.angles));
             schema::append(out, "quaternion",
                            schema::list({schema::real(s.rotate.w()), schema::real(s.rotate.x()),
                                          schema::real(s.rotate.y()), schema::real(s.rotate.z())}));
           })
           .unit("degrees")
           .otherwise("`[0, 0, 0]`")
           .means("rotation about `pivot`: about the x axis, then y, then z; 360 is a full turn"),
       scale_of(&Motion::Key::scale)
           .shown_if<Motion::Key>([](const Motion::Key& key) { return key.scale != Vec3::Ones(); })
           .means("of pins: scale about `pivot`, a number or one per axis; applied first"),
       schema::interpolation_key<Motion::Key>()});
  return table;
}

}  // namespace

void require_name(const std::string& name, const Place& place) {
  const bool bad = name.empty() || name.size() > 100 || name.front() == '.' ||
                   name.find_first_of("/\\:*?\"<>|,") != std::string::npos ||
                   std::any_of(name.begin(), name.end(),
                               [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; });
  if (bad) {
    throw Error(ErrorKind::input, place, "`" + name.substr(0, 40) + "` cannot be a name",
                "use 1 to 100 letters, digits, `_`, `-`, `.` or spaces, not starting with a dot");
  }
}

schema::Declaration scale_key(Vec3 BodySettings::* member) { return scale_of(member); }
schema::Declaration scale_key(Vec3 ColliderSettings::* member) { return scale_of(member); }

schema::Declaration motion_key() {
  return schema::keyframes("keyframes", &Motion::keys, motion_keyframe_table).otherwise("no motion");
}

}  // namespace muslin
