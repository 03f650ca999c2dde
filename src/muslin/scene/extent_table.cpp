#include "muslin/scene/extent_table.hpp"

#include "muslin/force/falloff.hpp"
#include "muslin/force/region.hpp"
#include "muslin/scene/points_key.hpp"

namespace muslin {
namespace {

const schema::Table& sphere_region_table() {
  static const schema::Table table = sphere_keys<Region::SphereShape>("`region.sphere`");
  return table;
}

const schema::Table& cylinder_region_table() {
  using Cylinder = Region::CylinderShape;
  static const schema::Table table = [] {
    schema::Table cylinder = schema::table_of<Cylinder>(
        "`region.cylinder`",
        {schema::vector("from", &Cylinder::from).unit("m").required().means("centre of one end"),
         schema::vector("to", &Cylinder::to).unit("m").required().means("centre of the other end"),
         schema::number("radius", &Cylinder::radius)
             .unit("m")
             .range(Range::positive())
             .required()
             .means("its radius")});
    schema::add_rule<Cylinder>(cylinder, [](const Cylinder& settings, const schema::Subject& subject) {
      if (settings.from == settings.to)
        throw subject.error("to", "the cylinder ends where it begins", "give it a length");
    });
    return cylinder;
  }();
  return table;
}

const schema::Table& half_space_table() {
  using Plane = Region::PlaneShape;
  static const schema::Table table = schema::table_of<Plane>(
      "`region.plane`",
      {schema::vector("point", &Plane::point).unit("m").required().means("a point of the plane"),
       schema::direction("normal", &Plane::normal, "[0, 1, 0]")
           .required()
           .means("normal of the plane, on the side of the region")});
  return table;
}

schema::Table declare_region() {
  schema::Table table = schema::table_of<Region>(
      "`region`",
      {box_key(&Region::box)
           .means("the box between two corners `[[x, y, z], [x, y, z]]`, the smaller coordinates first"),
       schema::nested("sphere", &Region::sphere, sphere_region_table)
           .means("the ball within `radius` of `center`"),
       schema::nested("cylinder", &Region::cylinder, cylinder_region_table)
           .means("the cylinder of this `radius` with its flat ends at `from` and `to`"),
       schema::nested("plane", &Region::plane, half_space_table)
           .means("the half space of the plane through `point` to which `normal` points"),
       schema::number("fade", &Region::fade)
           .unit("m")
           .range(Range::non_negative())
           .means("depth below its surface at which the field is full; at the surface it is 0")});
  schema::add_rule<Region>(table, [](const Region& region, const schema::Subject& subject) {
    if (!region.box && !region.sphere && !region.cylinder && !region.plane)
      throw subject.error("", "`region` has no shape", "give `box`, `sphere`, `cylinder` or `plane`");
  });
  return table;
}

schema::Table declare_falloff() {
  schema::Table table = schema::table_of<Falloff>(
      "`falloff`", {schema::number("power", &Falloff::power)
                        .range({0, 100, false})
                        .means("the weight is (1 + (r − `min`) / `length`)^−`power` at the distance r"),
                    schema::number("min", &Falloff::min)
                        .unit("m")
                        .range(Range::non_negative())
                        .means("distance up to which the weight is 1"),
                    schema::number("length", &Falloff::length)
                        .unit("m")
                        .range(Range::positive())
                        .otherwise("`min`, or 1 if that is 0")
                        .means("distance beyond `min` at which the weight is ½ for a power of 1"),
                    schema::number("max", &Falloff::max)
                        .unit("m")
                        .range(Range::positive())
                        .otherwise("none")
                        .means("distance beyond which the weight is 0")});
  schema::add_rule<Falloff>(table, [](const Falloff& falloff, const schema::Subject& subject) {
    if (falloff.max && *falloff.max < falloff.min)
      throw subject.error("max", fmt::format("`max` = {} m is below `min` = {} m", *falloff.max, falloff.min),
                          "raise it");
  });
  return table;
}

}  // namespace

const schema::Table& falloff_table() {
  static const schema::Table table = declare_falloff();
  return table;
}

const schema::Table& region_table() {
  static const schema::Table table = declare_region();
  return table;
}

}  // namespace muslin
