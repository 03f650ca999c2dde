#include "muslin/render/raytrace.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#if MUSLIN_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif
#include <tbb/task_arena.h>

#include "muslin/core/error.hpp"
#include "muslin/core/parallel.hpp"
#include "muslin/render/overlay.hpp"
#include "muslin/render/render_mesh.hpp"
#include "muslin/render/sampling.hpp"
#include "muslin/render/shading.hpp"

namespace muslin {
namespace {

// The calls that differ between Embree 3 and 4. The four rays of a pixel are coherent.
#if MUSLIN_EMBREE == 3
void intersect(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}
void occluded(const int* valid, RTCScene scene, RTCRay4& rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded4(valid, scene, &context, &rays);
}
void occluded(const int* valid, RTCScene scene, RTCRay8& rays) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded8(valid, scene, &context, &rays);
}
#else
void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray); }
void occluded(const int* valid, RTCScene scene, RTCRay4& rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded4(valid, scene, &rays, &arguments);
}
void occluded(const int* valid, RTCScene scene, RTCRay8& rays) { rtcOccluded8(valid, scene, &rays); }
#endif

using Vec3f = Eigen::Vector3f;
using Vec2f = Eigen::Vector2f;

constexpr int tile_side = 16;
constexpr float infinity = std::numeric_limits<float>::infinity();

Vec3f reflected_colour_guess(const Light& colour) { return 0.3f * colour; }

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// The hit of a camera ray, ready for shading. Normals face the eye.
struct Hit {
  Vec3f position;         // on the triangle
  Vec3f smooth_position;  // on the curved surface the normals suggest: shadows fall without facets
  Vec3f normal, geometric_normal;
  Light colour;
  const Material* material;
  float depth;  // thickness to step over when light comes from behind
  bool thin;    // light from behind shows
};

const Look& ground_look() {
  static const Look look = [] {
    Look ground;
    ground.colour = Vec3(0.80, 0.81, 0.82);
    ground.roughness = 0;
    return ground;
  }();
  return look;
}

}  // namespace

struct Raytracer::Impl {
  Impl(SceneView given_scene, const Camera& given_camera, const RenderOptions& given_options);
  ~Impl();

  void build(const FrameView& frame);
  Light trace(int x, int y, std::uint32_t sample) const;
  Hit surface_hit(const RTCRayHit& ray, const Vec3f& direction) const;
  Light lit(const Hit& hit, const Vec3f& to_eye, std::uint32_t sample) const;
  Light sky_light(const Hit& hit, std::uint32_t sample) const;
  /// Returns the share of the sun's disc visible from a point, by four rays.
  float visible_sun(const Vec3f& origin, std::uint32_t sample) const;
  Light background(float y) const;

  SceneView scene;
  Camera camera;
  RenderOptions options;
  std::vector<Material> materials;
  std::vector<RenderMesh> meshes;
  Material ground_material{ground_look()};
  Lighting lighting;
  Light ground_bounce;
  Light background_top, background_bottom;
  Vec3f eye, right, up, forward;
  float epsilon = 1e-5f;  // steps off a surface
  float ground_height = 0;
  float ground_near = 1, ground_far = 2;

  RTCDevice device = nullptr;
  RTCScene world = nullptr;
  std::vector<unsigned> mesh_ids;  // geometry of Embree for each surface
  std::vector<std::span<const double>> values;
  std::vector<Material> marker_materials;
  unsigned marker_id = RTC_INVALID_GEOMETRY_ID;
};

Raytracer::Impl::Impl(SceneView given_scene, const Camera& given_camera, const RenderOptions& given_options)
    : scene(std::move(given_scene)), camera(given_camera), options(given_options) {
  const auto within = [](int value, int low, int high, const char* what) {
    if (value < low || value > high)
      throw Error(ErrorKind::usage, std::string(what) + " is " + std::to_string(value),
                  "give a number from " + std::to_string(low) + " to " + std::to_string(high));
  };
  within(options.width, 1, 16384, "picture width");
  within(options.height, 1, 16384, "picture height");
  within(options.samples, 1, 4096, "samples per pixel");
  within(options.sky_rays, 1, 1024, "sky rays");
  for (const Surface& surface : scene.surfaces) {
    materials.emplace_back(surface.look);
    meshes.emplace_back(surface);
  }
  // Embree's data is in float about the target of the camera, where the scene is.
  eye = (camera.position - camera.target).cast<float>();
  right = camera.right.cast<float>();
  up = camera.up.cast<float>();
  forward = camera.forward.cast<float>();
  const float radius = static_cast<float>(camera.radius);
  epsilon = 2e-5f * std::max(radius, eye.norm());
  // The sun stands behind the eye's left shoulder, high, so that folds show.
  const Vec3f level_right = Vec3f(right.x(), 0, right.z()).normalized();
  const Vec3f level_back = level_right.cross(Vec3f(0, 1, 0));
  lighting.to_sun = (-0.85f * level_right + 0.45f * level_back + 1.05f * Vec3f(0, 1, 0)).normalized();
  const Light open_ground =
      lighting.to_sun.y() * lighting.sun / std::numbers::pi_v<float> + lighting.mean_sky();
  ground_bounce = ground_material.front.cwiseProduct(open_ground);
  if (scene.ground) {
    ground_height = static_cast<float>(*scene.ground - camera.target.y());
    const float reach = radius + std::abs(ground_height);
    ground_near = 0.9f * reach;
    ground_far = 4.0f * reach;
    lighting.below = 0.5f * ground_bounce;
  }
  background_top = inverse_tone_curve(linear_of_srgb(scene.background_top));
  background_bottom = inverse_tone_curve(linear_of_srgb(scene.background_bottom));
  device = rtcNewDevice(nullptr);
  if (!device)
    throw Error(ErrorKind::usage, "the ray tracer Embree cannot start",
                "check that libembree fits this processor");
}

Raytracer::Impl::~Impl() {
  if (world) rtcReleaseScene(world);
  rtcReleaseDevice(device);
}

void Raytracer::Impl::build(const FrameView& frame) {
  if (frame.surfaces.size() != scene.surfaces.size())
    throw Error(ErrorKind::usage, "a frame gives another number of surfaces than the scene",
                "give one entry for each surface");
  if (world) rtcReleaseScene(world);
  world = rtcNewScene(device);
  rtcSetSceneFlags(world, RTC_SCENE_FLAG_ROBUST);
  mesh_ids.clear();
  values.clear();
  for (std::size_t s = 0; s < meshes.size(); ++s) {
    RenderMesh& mesh = meshes[s];
    mesh.update(frame.surfaces[s].positions, camera.target);
    values.push_back(scene.colour_scale ? frame.surfaces[s].values : std::span<const double>());
    if (!values[s].empty() && values[s].size() != scene.surfaces[s].rest_positions.size())
      throw Error(ErrorKind::usage,
                  "surface '" + scene.surfaces[s].name + "' has a wrong number of values to show",
                  "give one for every vertex, or none");
    for (const double value : values[s])
      if (!std::isfinite(value))
        throw Error(ErrorKind::input,
                    "surface '" + scene.surfaces[s].name + "' has a value to show that is not finite",
                    "leave this frame out");
    if (mesh.primitive_count() == 0) {
      mesh_ids.push_back(RTC_INVALID_GEOMETRY_ID);
      continue;
    }
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions().size()));
    for (const Vec3f& p : mesh.positions()) vertices = std::copy(p.data(), p.data() + 3, vertices);
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.indices().size()));
    for (const auto& i : mesh.indices()) indices = std::copy(i.begin(), i.end(), indices);
    rtcCommitGeometry(geometry);
    mesh_ids.push_back(rtcAttachGeometry(world, geometry));
    rtcReleaseGeometry(geometry);
  }
  marker_materials.clear();
  marker_id = RTC_INVALID_GEOMETRY_ID;
  if (!frame.markers.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* balls = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), frame.markers.size()));
    for (const Marker& marker : frame.markers) {
      const Vec3f p = (marker.position - camera.target).cast<float>();
      balls = std::copy(p.data(), p.data() + 3, balls);
      *balls++ = static_cast<float>(marker.radius);
      marker_materials.emplace_back(solid_look(marker.colour));
    }
    rtcCommitGeometry(geometry);
    marker_id = rtcAttachGeometry(world, geometry);
    rtcReleaseGeometry(geometry);
  }
  // One thread builds the tree, so that its shape, and with it every tie, is the same on every machine.
  tbb::task_arena(1).execute([&] { rtcCommitScene(world); });
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
    throw Error(ErrorKind::usage, "the ray tracer Embree cannot take the scene",
                "free some memory or draw fewer triangles");
}

Light Raytracer::Impl::background(float y) const {
  return background_top + std::clamp(y / static_cast<float>(options.height), 0.0f, 1.0f) *
                              (background_bottom - background_top);
}

float Raytracer::Impl::visible_sun(const Vec3f& origin, std::uint32_t sample) const {
  Vec3f s, t;
  sampling::basis(lighting.to_sun, s, t);
  alignas(16) const int valid[4] = {-1, -1, -1, -1};
  alignas(16) RTCRay4 rays{};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Vec2f d = lighting.sun_spread * sampling::disc(sampling::sun_point(4 * sample + i));
    const Vec3f direction = lighting.to_sun + d.x() * s + d.y() * t;
    rays.org_x[i] = origin.x();
    rays.org_y[i] = origin.y();
    rays.org_z[i] = origin.z();
    rays.dir_x[i] = direction.x();
    rays.dir_y[i] = direction.y();
    rays.dir_z[i] = direction.z();
    rays.tfar[i] = infinity;
    rays.mask[i] = ~0u;
  }
  occluded(valid, world, rays);
  float visible = 0;
  for (const float far : rays.tfar) visible += far < 0 ? 0.0f : 0.25f;
  return visible;
}

Hit Raytracer::Impl::surface_hit(const RTCRayHit& ray, const Vec3f& direction) const {
  Hit hit;
  hit.position = eye + ray.ray.tfar * direction;
  Vec3f geometric(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
  geometric.normalize();
  if (ray.hit.geomID == marker_id) {
    hit.material = &marker_materials[ray.hit.primID];
    hit.colour = hit.material->front;
    hit.smooth_position = hit.position;
    hit.normal = hit.geometric_normal = geometric;
    hit.depth = 0;
    hit.thin = false;
    return hit;
  }
  const std::size_t s = static_cast<std::size_t>(std::find(mesh_ids.begin(), mesh_ids.end(), ray.hit.geomID) -
                                                 mesh_ids.begin());
  const Surface& surface = scene.surfaces[s];
  const RenderMesh& mesh = meshes[s];
  const RenderMesh::Primitive primitive = mesh.primitive(ray.hit.primID);
  const std::array<float, 3> weights = {1 - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v};
  std::array<Vec3f, 3> normals = mesh.normals(ray.hit.primID);
  Vec3f normal = Vec3f::Zero();
  for (std::size_t i = 0; i < 3; ++i) normal += weights[i] * normals[i];
  const bool from_behind = geometric.dot(direction) > 0;
  if (normal.dot(geometric) < 0) normal = -normal;  // triangles wound against their neighbours
  if (from_behind) {
    geometric = -geometric;
    normal = -normal;
  }
  // Normals facing away from the eye are turned just into view.
  const float away = normal.dot(direction);
  if (away > 0) normal -= 1.001f * away * direction;
  hit.geometric_normal = geometric;
  hit.normal = normal.norm() > 1e-6f ? Vec3f(normal.normalized()) : geometric;
  // Shading the flat triangle with bent normals gives facets along the shadow's edge. Lighting from the
  // bulged surface instead removes them (Hanika, "Hacking the shadow terminator", 2021).
  const auto& corners = mesh.indices()[ray.hit.primID];
  Vec3f bulge = Vec3f::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3f n = normals[i].dot(geometric) < 0 ? Vec3f(-normals[i]) : normals[i];
    const float below = (hit.position - mesh.positions()[corners[i]]).dot(n);
    bulge -= weights[i] * std::min(0.0f, below) * n;
  }
  hit.smooth_position = hit.position + bulge;

  hit.material = &materials[s];
  const bool back = (primitive.layer == RenderMesh::Layer::back) != from_behind;
  hit.thin = surface.look.translucency > 0 && primitive.layer != RenderMesh::Layer::rim;
  hit.depth = static_cast<float>(surface.thickness);
  hit.colour = back ? hit.material->back : hit.material->front;
  if (!values[s].empty()) {
    double value = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const int corner = primitive.corners[static_cast<Eigen::Index>(i)];
      value += static_cast<double>(weights[i]) *
               values[s][static_cast<std::size_t>(surface.triangles[primitive.triangle][corner])];
    }
    hit.colour = linear_of_srgb(map_colour(scene.colour_scale->map, scene.colour_scale->fraction(value)));
  } else if (!surface.pattern_positions.empty() && hit.material->pattern != Pattern::plain) {
    Vec2 place = Vec2::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = static_cast<std::size_t>(primitive.corners[static_cast<Eigen::Index>(i)]);
      place += static_cast<double>(weights[i]) * surface.pattern_positions[3 * primitive.triangle + corner];
    }
    const float cosine = std::max(0.1f, -direction.dot(geometric));
    const float footprint = 2 * static_cast<float>(camera.half_height) * ray.ray.tfar /
                            static_cast<float>(options.height) / cosine;
    hit.colour *= pattern_factor(*hit.material, place.cast<float>(), footprint);
  }
  return hit;
}

Light Raytracer::Impl::sky_light(const Hit& hit, std::uint32_t sample) const {
  Vec3f s, t;
  sampling::basis(hit.normal, s, t);
  const Vec3f origin = hit.smooth_position + epsilon * hit.geometric_normal;
  const Light blocked = reflected_colour_guess(hit.colour).cwiseProduct(lighting.mean_sky());
  const auto sky_rays = static_cast<std::uint32_t>(options.sky_rays);
  Light sum = Light::Zero();
  for (int first = 0; first < options.sky_rays; first += 8) {
    const int count = std::min(8, options.sky_rays - first);
    alignas(32) int valid[8];
    alignas(32) RTCRay8 rays{};
    std::array<Vec3f, 8> directions;
    for (int i = 0; i < 8; ++i) {
      const std::uint32_t index = sample * sky_rays + static_cast<std::uint32_t>(first + i);
      const Vec2f d = sampling::disc(sampling::sky_point(index));
      const float z = std::sqrt(std::max(0.0f, 1 - d.squaredNorm()));
      const Vec3f direction = d.x() * s + d.y() * t + z * hit.normal;
      directions[static_cast<std::size_t>(i)] = direction;
      valid[i] = i < count && direction.dot(hit.geometric_normal) > 0 ? -1 : 0;
      rays.org_x[i] = origin.x();
      rays.org_y[i] = origin.y();
      rays.org_z[i] = origin.z();
      rays.dir_x[i] = direction.x();
      rays.dir_y[i] = direction.y();
      rays.dir_z[i] = direction.z();
      rays.tfar[i] = infinity;
      rays.mask[i] = ~0u;
    }
    occluded(valid, world, rays);
    for (int i = 0; i < count; ++i)
      sum +=
          valid[i] == 0 || rays.tfar[i] < 0 ? blocked : lighting.sky(directions[static_cast<std::size_t>(i)]);
  }
  return sum / static_cast<float>(options.sky_rays);  // irradiance / π
}

Light Raytracer::Impl::lit(const Hit& hit, const Vec3f& to_eye, std::uint32_t sample) const {
  constexpr float inverse_pi = std::numbers::inv_pi_v<float>;
  const Material& material = *hit.material;
  const Light sky = sky_light(hit, sample);
  Light radiance = hit.colour.cwiseProduct(sky);
  const float rim = std::pow(1 - std::clamp(hit.normal.dot(to_eye), 0.0f, 1.0f), 4.0f);
  const Light sheen_colour = 0.5f * (hit.colour + Light::Ones());
  radiance += material.sheen * rim * sheen_colour.cwiseProduct(sky);
  if (material.gloss > 0) radiance += material.gloss * (0.04f + 0.5f * rim) * sky;

  const Vec3f& to_sun = lighting.to_sun;
  const float cosine = hit.normal.dot(to_sun);
  if (cosine > 0 && hit.geometric_normal.dot(to_sun) > -0.3f) {
    const float visible = visible_sun(hit.smooth_position + epsilon * hit.geometric_normal, sample);
    if (visible > 0) {
      const float diffuse = oren_nayar(material, hit.normal, to_sun, to_eye);
      radiance += visible * cosine *
                  lighting.sun.cwiseProduct((inverse_pi * diffuse) * hit.colour +
                                            Light::Constant(highlight(material, hit.normal, to_sun, to_eye)) +
                                            (0.35f * inverse_pi * material.sheen * rim) * sheen_colour);
    }
  } else if (hit.thin && cosine < 0) {
    const Vec3f behind = hit.position - (epsilon + 1.01f * hit.depth) * hit.geometric_normal;
    radiance += (-cosine * visible_sun(behind, sample) * material.translucency * 2 * inverse_pi) *
                lighting.sun.cwiseProduct(hit.colour);
  }
  return radiance;
}

Light Raytracer::Impl::trace(int x, int y, std::uint32_t sample) const {
  const Vec2f jitter = sampling::pixel_point(sample);
  const float px = static_cast<float>(x) + 0.5f + sampling::tent(jitter.x());
  const float py = static_cast<float>(y) + 0.5f + sampling::tent(jitter.y());
  const float u = (2 * px / static_cast<float>(options.width) - 1) * static_cast<float>(camera.half_width);
  const float v = (1 - 2 * py / static_cast<float>(options.height)) * static_cast<float>(camera.half_height);
  const Vec3f direction = (forward + u * right + v * up).normalized();

  RTCRayHit ray{};
  ray.ray.org_x = eye.x();
  ray.ray.org_y = eye.y();
  ray.ray.org_z = eye.z();
  ray.ray.dir_x = direction.x();
  ray.ray.dir_y = direction.y();
  ray.ray.dir_z = direction.z();
  ray.ray.tfar = infinity;
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect(world, ray);

  const Light behind = background(py);
  if (scene.ground && eye.y() > ground_height && direction.y() < -1e-6f) {
    const float distance = (ground_height - eye.y()) / direction.y();
    if (distance < ray.ray.tfar) {
      Hit hit;
      hit.position = hit.smooth_position = eye + distance * direction;
      const float fade = smooth_step(ground_near, ground_far, hit.position.norm());
      if (fade >= 1) return behind;
      hit.position.y() = hit.smooth_position.y() = ground_height;
      hit.normal = hit.geometric_normal = Vec3f(0, 1, 0);
      hit.material = &ground_material;
      hit.colour = ground_material.front;
      hit.depth = 0;
      hit.thin = false;
      return (1 - fade) * lit(hit, -direction, sample) + fade * behind;
    }
  }
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return behind;
  return lit(surface_hit(ray, direction), -direction, sample);
}

Raytracer::Raytracer(SceneView scene, const Camera& camera, const RenderOptions& options)
    : impl_(std::make_unique<Impl>(std::move(scene), camera, options)) {}

Raytracer::~Raytracer() = default;

Image Raytracer::render(const FrameView& frame, const Progress& progress) {
  Impl& impl = *impl_;
  impl.build(frame);
  progress.at(0, "drawing a frame");
  const RenderOptions& options = impl.options;
  Image image(options.width, options.height);
  const auto samples = static_cast<std::uint32_t>(options.samples);
  const int columns = (options.width + tile_side - 1) / tile_side;
  const int rows = (options.height + tile_side - 1) / tile_side;
  const auto draw_tile = [&](int tile_x, int tile_y) {
    const int left = tile_x * tile_side;
    const int top = tile_y * tile_side;
    for (int y = top; y < std::min(top + tile_side, options.height); ++y)
      for (int x = left; x < std::min(left + tile_side, options.width); ++x) {
        const std::uint32_t first =
            sampling::hilbert(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)) * samples;
        Light sum = Light::Zero();
        for (std::uint32_t sample = 0; sample < samples; ++sample) {
          // Tone-maps before averaging, so that one bright sample does not spoil a smooth edge.
          sum += tone_curve(impl.trace(x, y, first + sample));
        }
        const auto bytes = bytes_of_srgb(srgb_of_linear(sum / static_cast<float>(options.samples)));
        std::copy(bytes.begin(), bytes.end(), image.pixel(x, y));
      }
  };
  // In bands, so that a cancelled picture stops soon.
  const int band = std::max(1, (rows + 7) / 8);
  for (int first_row = 0; first_row < rows; first_row += band) {
    const int count = std::min(band, rows - first_row) * columns;
    parallel_for(static_cast<std::size_t>(count), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t tile = begin; tile < end; ++tile)
        draw_tile(static_cast<int>(tile) % columns, first_row + static_cast<int>(tile) / columns);
    });
    progress.at(static_cast<double>(std::min(rows, first_row + band)) / rows, "drawing a frame");
  }
  if (!frame.label.empty()) draw_label(image, frame.label);
  if (impl.scene.colour_scale) draw_legend(image, *impl.scene.colour_scale);
  return image;
}

}  // namespace muslin
