#include "muslin/schema/keyframe_keys.hpp"

namespace muslin::schema {

const Table& number_keyframe_table() {
  static const Table table = table_of<NumberKeyframe>(
      "keyframes of a number",
      {number("time", &NumberKeyframe::time)
           .unit("s")
           .required()
           .means("time of the keyframe, later than the previous one"),
       number("value", &NumberKeyframe::value).required().means("the number at that time"),
       interpolation_key<NumberKeyframe>()});
  return table;
}

}  // namespace muslin::schema
