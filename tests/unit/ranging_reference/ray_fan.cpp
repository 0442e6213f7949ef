#include "tests/unit/ranging_reference/ray_fan.hpp"

#include <embree3/rtcore.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

namespace cellmirror {

namespace {

using Eigen::Vector3d;

float single(double value) { return static_cast<float>(value); }

}  // namespace

struct RayFan::Scene {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene top = rtcNewScene(device);
  std::map<const geometry::TriangleMesh*, RTCScene> of_mesh;
  std::vector<RTCGeometry> instances;

  Scene() { rtcSetSceneFlags(top, RTC_SCENE_FLAG_DYNAMIC); }
  ~Scene() {
    rtcReleaseScene(top);
    for (RTCGeometry instance : instances) rtcReleaseGeometry(instance);
    for (const auto& [mesh, scene] : of_mesh) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  RTCScene scene_of(const geometry::TriangleMesh& mesh) {
    const auto known = of_mesh.find(&mesh);
    if (known != of_mesh.end()) return known->second;
    RTCGeometry triangles = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = static_cast<float*>(rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                3 * sizeof(float), mesh.vertices.size()));
    for (const Vector3d& v : mesh.vertices) {
      for (int i = 0; i < 3; ++i) *corners++ = single(v[i]);
    }
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) *indices++ = index;
    }
    rtcCommitGeometry(triangles);
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene, triangles);
    rtcReleaseGeometry(triangles);
    rtcCommitScene(scene);
    of_mesh.emplace(&mesh, scene);
    return scene;
  }
};

RayFan::RayFan() : scene_(std::make_unique<Scene>()) {}
RayFan::~RayFan() = default;

std::size_t RayFan::add(const std::shared_ptr<const geometry::TriangleMesh>& mesh) {
  RTCGeometry instance = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, scene_->scene_of(*mesh));
  rtcSetGeometryTimeStepCount(instance, 1);
  rtcAttachGeometry(scene_->top, instance);
  scene_->instances.push_back(instance);
  place(scene_->instances.size() - 1, Pose::Identity());
  return scene_->instances.size() - 1;
}

void RayFan::place(std::size_t instance, const Pose& X_WG) {
  std::array<float, 12> columns{};
  std::size_t at = 0;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row) {
      columns[at++] = single(X_WG.matrix()(row, column));
    }
  }
  rtcSetGeometryTransform(scene_->instances[instance], 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  rtcCommitGeometry(scene_->instances[instance]);
}

void RayFan::commit() { rtcCommitScene(scene_->top); }

std::optional<double> RayFan::along(const Vector3d& from, const Vector3d& direction, double range) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  ray.ray.org_x = single(from.x());
  ray.ray.org_y = single(from.y());
  ray.ray.org_z = single(from.z());
  ray.ray.dir_x = single(direction.x());
  ray.ray.dir_y = single(direction.y());
  ray.ray.dir_z = single(direction.z());
  ray.ray.tfar = single(range);
  ray.ray.mask = ~0U;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_->top, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return static_cast<double>(ray.ray.tfar);
}

std::optional<double> RayFan::nearest(const Pose& X_WS, double half_angle, double range, std::size_t rays) const {
  constexpr std::size_t kPacket = 8;
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const std::size_t packets = (rays + kPacket - 1) / kPacket;
  const double count = static_cast<double>(packets * kPacket);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) const std::array<int, kPacket> valid{-1, -1, -1, -1, -1, -1, -1, -1};
  float nearest = std::numeric_limits<float>::infinity();
  for (std::size_t packet = 0; packet < packets; ++packet) {
    alignas(32) RTCRayHit8 ray{};
    for (std::size_t i = 0; i < kPacket; ++i) {
      const double number = static_cast<double>(packet * kPacket + i);
      const double cosine = 1.0 - (1.0 - std::cos(half_angle)) * (number + 0.5) / count;
      const double sine = std::sqrt(1.0 - cosine * cosine);
      const double turn = golden_angle * number;
      const Vector3d u = X_WS.linear() * Vector3d(sine * std::cos(turn), sine * std::sin(turn), cosine);
      ray.ray.org_x[i] = single(X_WS.translation().x());
      ray.ray.org_y[i] = single(X_WS.translation().y());
      ray.ray.org_z[i] = single(X_WS.translation().z());
      ray.ray.dir_x[i] = single(u.x());
      ray.ray.dir_y[i] = single(u.y());
      ray.ray.dir_z[i] = single(u.z());
      ray.ray.tfar[i] = std::min(nearest, single(range));  // what is farther than the best so far does not matter
      ray.ray.mask[i] = ~0U;
      ray.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid.data(), scene_->top, &context, &ray);
    for (std::size_t i = 0; i < kPacket; ++i) {
      if (ray.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) nearest = std::min(nearest, ray.ray.tfar[i]);
    }
  }
  if (!std::isfinite(nearest)) return std::nullopt;
  return static_cast<double>(nearest);
}

}  // namespace cellmirror
