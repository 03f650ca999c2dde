#include "character.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "muslin/cache/point_cache.hpp"
#include "muslin/core/output_file.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/geometry/mesh.hpp"
#include "muslin/io/mesh_writers.hpp"

namespace muslin::bench {
namespace {

using Rotation = Eigen::Quaterniond;
using Move = Eigen::Affine3d;

enum Bone {
  pelvis,
  chest,
  left_arm,
  left_forearm,
  left_thigh,
  left_shin,
  right_arm,
  right_forearm,
  right_thigh,
  right_shin,
  bone_count
};

/// Lengths below are shares of the stature, for a girth of 1.
constexpr double blend = 0.014;          // radius of the smooth union
constexpr double skin_softness = 0.018;  // over which bones share the skin
/// Points of the skin that are at least this far from a bone's part at rest may cross it in a pose.
constexpr double apart_at_rest = 0.03;
constexpr double waist = 0.62, under_arms = 0.715, hips = 0.55, hem = 0.3;
constexpr double sleeve_from = 0.45;                  // along the upper arm
constexpr double skin_cell = 0.015;                   // of the mesh of the skin
constexpr double coarse_cell = 0.03;                  // of the mesh that crossings are measured on
constexpr int dress_around = 52, sleeve_around = 19;  // vertices of a ring
constexpr int frames = 60, frame_rate = 24;
/// A pose is taken as far as parts of the body cross by this, or this many times as far [m].
constexpr double least_crossing = 0.004, deepest_crossing = 0.016, least_reach = 0.4, farthest_reach = 1.3;

/// A cone with round ends.
struct Part {
  Vec3 a, b;
  double ra, rb;
  Bone bone;

  double distance(const Vec3& x) const {
    const Vec3 along = b - a;
    const double t = std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (x - a - t * along).norm() - (1 - t) * ra - t * rb;
  }
};

/// Directions of the left limbs in a pose, in the frame of the bone that they hang on; the right ones are
/// their mirror images.
struct Pose {
  const char* name;
  Vec3 arm, forearm, thigh, shin;
  double lean;   // of the chest, forward [degrees]
  double lower;  // of the pelvis, as a share of the stature
  double apart;  // by which the forearms differ in height, so that one is above the other
};

const Vec3 arm_at_rest = Vec3(1, -1, 0).normalized();
const Vec3 leg_at_rest = Vec3(0.13, -1, 0).normalized();

const std::array<Pose, 5> poses{{
    {"crossed arms", {0.28, -0.93, 0.3}, {-0.8, 0.2, 0.62}, leg_at_rest, leg_at_rest, 4, 0, 0.3},
    {"sitting", {0.22, -0.95, 0.2}, {-0.05, -0.45, 0.9}, {0.16, -0.1, 0.98}, {0.04, -1, 0.05}, 6, 0.2, 0},
    {"crouching",
     {0.3, -0.7, 0.65},
     {-0.45, -0.35, 0.82},
     {0.3, 0.1, 0.95},
     {0.02, -0.9, -0.42},
     25,
     0.24,
     0.1},
    {"raised arms", {0.35, 0.93, 0.05}, {0.1, 0.98, 0.1}, leg_at_rest, leg_at_rest, 0, 0, 0},
    {"hands on hips", {0.62, -0.76, -0.15}, {-0.62, -0.68, 0.38}, leg_at_rest, leg_at_rest, 0, 0, 0},
}};
const Vec3 lowered_arm(0.2, -0.98, 0.05);  // before arms are raised

/// Numbers from 0 to 1 that depend on a seed only (splitmix64; Steele, Lea, Flood 2014).
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed * 0x632be59bd9b4e019ULL + 1) {}
  double between(double low, double high) {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return low + (high - low) * static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

class Character {
 public:
  explicit Character(int index)
      : index_(index), pose_(poses[static_cast<std::size_t>(index) % poses.size()]) {
    Numbers numbers(static_cast<std::uint64_t>(index));
    stature = numbers.between(1.5, 1.9);
    girth_ = numbers.between(0.85, 1.2);
    arms_ = numbers.between(0.92, 1.08);
    vary_ = Vec3(numbers.between(-0.08, 0.08), numbers.between(-0.08, 0.08), numbers.between(-0.08, 0.08));
    ease = numbers.between(0.008, 0.016);
    flare = numbers.between(0.15, 0.4);
    crossing_ = numbers.between(least_crossing, deepest_crossing);
    make_parts();
    choose_reach();
  }

  const char* pose() const { return pose_.name; }
  bool starts_tangled() const { return index_ % 5 == 4; }

  /// Signed distance to the skin at rest, about; `chosen` picks parts.
  double field(const Vec3& x, const std::function<bool(const Part&)>& chosen) const {
    const double radius = blend * stature;
    double sum = 0;
    for (const Part& part : parts_)
      if (chosen(part)) sum += std::exp(-part.distance(x) / radius);
    return -radius * std::log(sum);
  }

  /// The first place along a ray from inside that is `distance` outside the skin of the chosen parts.
  Vec3 beyond(const Vec3& from, const Vec3& direction, double distance,
              const std::function<bool(const Part&)>& chosen) const {
    double low = 0, high = 0.25 * stature;
    for (int i = 0; i < 40; ++i) {
      const double middle = (low + high) / 2;
      (field(from + middle * direction, chosen) < distance ? low : high) = middle;
    }
    return from + high * direction;
  }

  /// The surface nets of the field (Gibson, Constrained Elastic Surface Nets, 1998), moved onto its zero.
  Mesh skin(double cell) const;
  Mesh dress(int around) const;
  Mesh sleeve(int around) const;

  /// The place at `time` [s] of points that are at `rest` in the A-pose: of the skin, or of what follows a
  /// bone.
  std::vector<Vec3> posed(ConstVectors rest, double time) const;
  std::vector<Vec3> carried(ConstVectors rest, Bone bone, double time) const;

  /// The deepest that a point of the skin is in another part of the body at `time` [m].
  double crossing(ConstVectors rest, double time) const;

  double stature;
  double ease;   ///< of the dress under the arms [m]
  double flare;  ///< radius that the dress gains by height

 private:
  void make_parts();
  void choose_reach();
  std::array<Move, bone_count> moves(double time) const;

  int index_;
  Pose pose_;
  double girth_, arms_;
  double crossing_;   // wanted [m]
  double reach_ = 1;  // share of the way to the pose
  Vec3 vary_;
  std::vector<Part> parts_;
  std::array<Vec3, bone_count> joints_;
};

const auto everything = [](const Part&) { return true; };
const auto torso = [](const Part& part) { return part.bone == pelvis || part.bone == chest; };
const auto left_sleeve = [](const Part& part) { return part.bone == left_arm || part.bone == left_forearm; };

void Character::make_parts() {
  const double s = stature;
  const auto add = [&](const Vec3& a, const Vec3& b, double ra, double rb, Bone bone) {
    parts_.push_back({s * a, s * b, s * girth_ * ra, s * girth_ * rb, bone});
  };
  for (const double x : {-0.04, 0.0, 0.04}) {
    add({x, 0.53, 0}, {0.85 * x, waist, 0}, 0.062, 0.053, pelvis);
    add({0.85 * x, waist, 0}, {1.2 * x, 0.755, 0}, 0.053, 0.055, chest);
  }
  add({0, 0.77, 0}, {0, 0.88, 0}, 0.032, 0.03, chest);
  add({0, 0.91, 0.01}, {0, 0.94, 0.01}, 0.05, 0.052, chest);
  add({-0.08, 0.79, 0}, {0.08, 0.79, 0}, 0.03, 0.03, chest);
  joints_[pelvis] = s * Vec3(0, hips, 0);
  joints_[chest] = s * Vec3(0, waist, 0);
  for (const int side : {0, 1}) {
    const double sign = side == 0 ? 1 : -1;
    const auto mirrored = [&](Vec3 x) { return Vec3(sign * x.x(), x.y(), x.z()); };
    const auto bone = [&](Bone left) { return static_cast<Bone>(left + side * (right_arm - left_arm)); };
    const Vec3 shoulder = mirrored({0.105, 0.79, 0});
    const Vec3 elbow = shoulder + 0.17 * arms_ * mirrored(arm_at_rest);
    const Vec3 wrist = elbow + 0.15 * arms_ * mirrored(arm_at_rest);
    const Vec3 fingers = wrist + 0.075 * arms_ * mirrored(arm_at_rest);
    const Vec3 hip = mirrored({0.055, 0.51, 0});
    const Vec3 knee = hip + 0.235 * mirrored(leg_at_rest), ankle = knee + 0.225 * mirrored(leg_at_rest);
    add(shoulder, elbow, 0.03, 0.025, bone(left_arm));
    add(elbow, wrist, 0.025, 0.018, bone(left_forearm));
    add(wrist, fingers, 0.018, 0.016, bone(left_forearm));
    add(hip, knee, 0.05, 0.034, bone(left_thigh));
    add(knee, ankle, 0.034, 0.024, bone(left_shin));
    add(ankle - Vec3(0, 0.01, 0), ankle + Vec3(0, -0.018, 0.09), 0.024, 0.016, bone(left_shin));
    joints_[bone(left_arm)] = s * shoulder;
    joints_[bone(left_forearm)] = s * elbow;
    joints_[bone(left_thigh)] = s * hip;
    joints_[bone(left_shin)] = s * knee;
  }
}

Mesh Character::skin(double cell) const {
  const double width = cell * stature;
  const Vec3 low(-0.45 * stature, -0.05 * stature, -0.15 * stature);
  const std::array<int, 3> size{static_cast<int>(0.9 / cell) + 1, static_cast<int>(1.1 / cell) + 1,
                                static_cast<int>(0.32 / cell) + 1};
  const auto number = [&](int i, int j, int k) {
    return (static_cast<std::size_t>(i) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size[2]) +
           static_cast<std::size_t>(k);
  };
  const auto corner = [&](int i, int j, int k) { return Vec3(low + width * Vec3(i, j, k)); };
  const auto at = [&](const Vec3& x) { return field(x, everything); };
  std::vector<double> values(number(size[0], 0, 0));
  for (int i = 0; i < size[0]; ++i)
    for (int j = 0; j < size[1]; ++j)
      for (int k = 0; k < size[2]; ++k) values[number(i, j, k)] = at(corner(i, j, k));

  Mesh mesh;
  mesh.name = "skin";
  std::vector<int> vertex(values.size(), -1);  // of the cell
  for (int i = 0; i + 1 < size[0]; ++i)
    for (int j = 0; j + 1 < size[1]; ++j)
      for (int k = 0; k + 1 < size[2]; ++k) {
        Vec3 sum = Vec3::Zero();
        int count = 0;
        for (int edge = 0; edge < 12; ++edge) {
          const int axis = edge / 4, u = (axis + 1) % 3, v = (axis + 2) % 3;
          std::array<int, 3> a{i, j, k};
          a[static_cast<std::size_t>(u)] += edge & 1;
          a[static_cast<std::size_t>(v)] += (edge >> 1) & 1;
          std::array<int, 3> b = a;
          ++b[static_cast<std::size_t>(axis)];
          const double fa = values[number(a[0], a[1], a[2])], fb = values[number(b[0], b[1], b[2])];
          if ((fa < 0) == (fb < 0)) continue;
          sum += corner(a[0], a[1], a[2]) +
                 fa / (fa - fb) * (corner(b[0], b[1], b[2]) - corner(a[0], a[1], a[2]));
          ++count;
        }
        if (count == 0) continue;
        Vec3 x = sum / count;
        for (int step = 0; step < 3; ++step) {
          const double h = 0.01 * width, f = at(x);
          const Vec3 slope =
              Vec3(at(x + Vec3(h, 0, 0)) - f, at(x + Vec3(0, h, 0)) - f, at(x + Vec3(0, 0, h)) - f) / h;
          x -= f / slope.squaredNorm() * slope;
        }
        vertex[number(i, j, k)] = static_cast<int>(mesh.positions.size());
        mesh.positions.push_back(x);
      }
  for (int axis = 0; axis < 3; ++axis) {
    const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
    for (int i = 1; i + 1 < size[0]; ++i)
      for (int j = 1; j + 1 < size[1]; ++j)
        for (int k = 1; k + 1 < size[2]; ++k) {
          const std::array<int, 3> a{i, j, k};
          std::array<int, 3> b = a;
          ++b[static_cast<std::size_t>(axis)];
          const bool inside = values[number(i, j, k)] < 0;
          if (inside == (values[number(b[0], b[1], b[2])] < 0)) continue;
          std::array<int, 4> face{};
          for (int c = 0; c < 4; ++c) {
            std::array<int, 3> cell_at = a;
            cell_at[u] -= c == 0 || c == 3 ? 1 : 0;
            cell_at[v] -= c < 2 ? 1 : 0;
            face[static_cast<std::size_t>(c)] = vertex[number(cell_at[0], cell_at[1], cell_at[2])];
          }
          if (!inside) std::reverse(face.begin(), face.end());
          mesh.add_face(face);
        }
  }
  return mesh;
}

/// A tube of rings; ring 0 is the group "top".
Mesh tube(const char* name, int around, int rings, const std::function<Vec3(int ring, double angle)>& place) {
  Mesh mesh;
  mesh.name = name;
  mesh.positions.reserve(static_cast<std::size_t>(rings) * static_cast<std::size_t>(around));
  for (int r = 0; r < rings; ++r)
    for (int i = 0; i < around; ++i) mesh.positions.push_back(place(r, 2 * std::numbers::pi * i / around));
  MeshGroup top{"top", {}, {}};
  for (int r = 0; r + 1 < rings; ++r)
    for (int i = 0; i < around; ++i) {
      const int next = (i + 1) % around;
      mesh.add_face(
          std::array{r * around + i, r * around + next, (r + 1) * around + next, (r + 1) * around + i});
    }
  top.vertices.resize(static_cast<std::size_t>(around));
  std::iota(top.vertices.begin(), top.vertices.end(), 0);
  mesh.groups.push_back(std::move(top));
  return mesh;
}

Mesh Character::dress(int around) const {
  const double top = under_arms * stature, length = top - hem * stature;
  const int rings = std::max(8, static_cast<int>(std::lround(0.42 * around)));
  return tube("dress", around, rings, [&](int ring, double angle) {
    const double down = length * ring / (rings - 1), y = top - down;
    const Vec3 direction(std::cos(angle), 0, std::sin(angle));
    Vec3 x = beyond({0, std::max(y, hips * stature), 0}, direction, ease, torso);
    x += flare * down * direction;
    x.y() = y;
    return x;
  });
}

Mesh Character::sleeve(int around) const {
  const Vec3 from = joints_[left_arm] + sleeve_from * (joints_[left_forearm] - joints_[left_arm]);
  const Vec3 to = joints_[left_forearm] + 0.14 * arms_ * stature * arm_at_rest;
  const Vec3 along = (to - from).normalized(), across(0, 0, 1), up = along.cross(across);
  const double spacing = 0.011 * stature * 20 / around;
  const int rings = static_cast<int>((to - from).norm() / spacing) + 1;
  const double gap = starts_tangled() ? -0.001 : 0.004;
  return tube("sleeve", around, rings, [&](int ring, double angle) {
    const Vec3 direction = std::cos(angle) * across + std::sin(angle) * up;
    return beyond(from + (to - from) * ring / (rings - 1), direction, gap, left_sleeve);
  });
}

std::array<Move, bone_count> Character::moves(double time) const {
  const bool raises = std::string_view(pose_.name) == "raised arms";
  const double reached = smooth((time - 0.25) / 0.9);
  const double back = raises ? 0 : smooth((time - 1.6) / 0.8);
  const double share = reach_ * (reached - back);
  const double lowered = reach_ * smooth((time - 0.2) / 0.5), raised = smooth((time - 1) / 0.9);
  std::array<Move, bone_count> moves;
  const auto turn = [&](Bone bone, const Move& parent, const Rotation& rotation) {
    const Vec3& joint = joints_[bone];
    moves[bone] = parent * Eigen::Translation3d(joint) * rotation * Eigen::Translation3d(-joint);
  };
  const auto part_of = [](const Vec3& from, const Vec3& to, double part) {
    return Rotation::Identity().slerp(part, Rotation::FromTwoVectors(from, to));
  };
  const Move root(Eigen::Translation3d(0, -share * pose_.lower * stature, 0));
  moves[pelvis] = root;
  turn(chest, root, Rotation(Eigen::AngleAxisd(share * pose_.lean * std::numbers::pi / 180, Vec3::UnitX())));
  for (const int side : {0, 1}) {
    const double sign = side == 0 ? 1 : -1;
    const auto mirrored = [&](Vec3 x) { return Vec3(sign * x.x(), x.y(), x.z()); };
    const auto bone = [&](Bone left) { return static_cast<Bone>(left + side * (right_arm - left_arm)); };
    const Vec3 arm = mirrored(arm_at_rest), leg = mirrored(leg_at_rest);
    const Vec3 arm_goal = mirrored(pose_.arm + (raises ? 0.3 : 1) * vary_);
    const Vec3 forearm_goal =
        mirrored(pose_.forearm) + Vec3(0, sign * pose_.apart / 2, sign * pose_.apart / 6);
    Rotation shoulder = part_of(arm, arm_goal, share);
    Rotation elbow = part_of(shoulder * arm, forearm_goal, share);
    if (raises) {
      shoulder = part_of(arm, mirrored(lowered_arm + 0.5 * vary_), lowered);
      shoulder = part_of(shoulder * arm, arm_goal, raised) * shoulder;
      elbow = part_of(shoulder * arm, forearm_goal, raised);
    }
    turn(bone(left_arm), moves[chest], shoulder);
    turn(bone(left_forearm), moves[bone(left_arm)], shoulder.inverse() * elbow * shoulder);
    const Rotation hip = part_of(leg, mirrored(pose_.thigh), share);
    const Rotation knee = part_of(hip * leg, mirrored(pose_.shin), share);
    turn(bone(left_thigh), moves[pelvis], hip);
    turn(bone(left_shin), moves[bone(left_thigh)], hip.inverse() * knee * hip);
  }
  return moves;
}

std::vector<Vec3> Character::posed(ConstVectors rest, double time) const {
  const std::array<Move, bone_count> bones = moves(time);
  std::vector<Vec3> posed;
  posed.reserve(rest.size());
  for (const Vec3& x : rest) {
    std::array<double, bone_count> nearest{};
    nearest.fill(INFINITY);
    for (const Part& part : parts_) nearest[part.bone] = std::min(nearest[part.bone], part.distance(x));
    const double least = *std::min_element(nearest.begin(), nearest.end());
    Vec3 sum = Vec3::Zero();
    double total = 0;
    for (std::size_t b = 0; b < bone_count; ++b) {
      const double weight = std::exp((least - nearest[b]) / (skin_softness * stature));
      if (weight < 0.01) continue;
      sum += weight * (bones[b] * x);
      total += weight;
    }
    posed.push_back(sum / total);
  }
  return posed;
}

double Character::crossing(ConstVectors rest, double time) const {
  const std::array<Move, bone_count> bones = moves(time);
  const std::vector<Vec3> now = posed(rest, time);
  double deepest = 0;
  for (const Part& part : parts_) {
    const Move back = bones[part.bone].inverse();
    for (std::size_t v = 0; v < rest.size(); ++v)
      if (part.distance(rest[v]) > apart_at_rest * stature)
        deepest = std::max(deepest, -part.distance(back * now[v]));
  }
  return deepest;
}

void Character::choose_reach() {
  const Mesh coarse = skin(coarse_cell);
  const auto deepest = [&] {
    double most = 0;
    for (int frame = 0; frame <= frames; frame += 4)
      most = std::max(most, crossing(coarse.positions, static_cast<double>(frame) / frame_rate));
    return most;
  };
  double low = least_reach, high = farthest_reach;
  reach_ = high;
  if (deepest() <= crossing_) return;
  for (int i = 0; i < 8; ++i) {
    reach_ = (low + high) / 2;
    (deepest() <= crossing_ ? low : high) = reach_;
  }
  reach_ = low;
}

std::vector<Vec3> Character::carried(ConstVectors rest, Bone bone, double time) const {
  const Move move = moves(time)[bone];
  std::vector<Vec3> carried;
  carried.reserve(rest.size());
  for (const Vec3& x : rest) carried.push_back(move * x);
  return carried;
}

}  // namespace

std::string write_character(const std::filesystem::path& folder, int index) {
  make_directory(folder);
  const Character character(index);
  const auto write = [&](const char* name, const Mesh& mesh, const auto& place) {
    write_atomically(folder / (std::string(name) + ".obj"), to_obj(mesh, mesh.positions), false);
    Pc2Writer motion(folder / (std::string(name) + ".pc2"), mesh.positions.size(), OutputFile::Mode::replace);
    for (int frame = 0; frame <= frames; ++frame)
      motion.append(place(mesh.positions, static_cast<double>(frame) / frame_rate));
    motion.close();
  };
  const auto follow = [&](Bone bone) {
    return [&character, bone](ConstVectors rest, double time) { return character.carried(rest, bone, time); };
  };
  write("skin", character.skin(skin_cell),
        [&](ConstVectors rest, double time) { return character.posed(rest, time); });
  write("dress", character.dress(dress_around), follow(chest));
  write("sleeve", character.sleeve(sleeve_around), follow(left_arm));
  constexpr std::array<const char*, 3> fabrics{"cotton", "polyester", "wool"};
  const auto fabric = [&](int i) { return fabrics[static_cast<std::size_t>(i) % fabrics.size()]; };
  std::string scene = fmt::format(
      "title = \"{}\"\n\n[time]\nduration = {}\nframe_rate = {}\n\n[contact]\nfriction = 0.3\n\n"
      "[[collider]]\nname = \"skin\"\nshape = \"mesh\"\nmesh = \"skin.obj\"\nsequence = \"skin.pc2\"\n"
      "colour = [0.76, 0.57, 0.46]\n\n[[force]]\ntype = \"gravity\"\n\n[[force]]\ntype = \"wind\"\n"
      "velocity = [0, 0, 0]\n",
      character.pose(), static_cast<double>(frames) / frame_rate, frame_rate);
  for (const auto& [name, material] :
       {std::pair{"dress", fabric(index)}, std::pair{"sleeve", fabric(index / 3 + 1)}}) {
    scene += fmt::format(
        "\n[[body]]\nname = \"{0}\"\nmodel = \"shell\"\nmesh = \"{0}.obj\"\nwarp = [0, 1, 0]\nmaterial = "
        "\"{1}\"\n\n[[pin]]\n"
        "name = \"top of {0}\"\nbody = \"{0}\"\nwhere = {{ group = \"top\" }}\nsequence = "
        "\"{0}.pc2\"\nstiffness = 400\ndamping = 4\n",
        name, material);
  }
  write_atomically(folder / "scene.toml", scene, false);
  return character.pose();
}

}  // namespace muslin::bench
