#include "app/render/tissue_message.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <span>

#include "app/render/message_bytes.hpp"
#include "rt_core/ports/packed_vertex.hpp"

namespace cellmirror::app {

namespace {

constexpr float kFarthestTissue = 1000.0F;  // m; farther tissue is a fault of the simulation and not drawn
constexpr std::array<float, 3> kFlesh{0.72F, 0.36F, 0.34F};

// The surfaces and clips of a message, within its bounds.
struct Chosen {
  std::vector<const TissueSurface*> surfaces;
  std::span<const TissueClip> clips;
};

Chosen chosen_of(const TissueView& view) {
  Chosen out;
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  for (const TissueSurface& surface : view.surfaces) {
    if (!surface.topology || surface.normals.size() != surface.vertices.size()) continue;
    vertices += surface.vertices.size();
    triangles += surface.topology->triangles.size();
    if (out.surfaces.size() == kMostTissueSurfaces || vertices > kMostTissueVertices ||
        triangles > kMostTissueTriangles)
      break;
    out.surfaces.push_back(&surface);
  }
  out.clips = std::span(view.clips).first(std::min(view.clips.size(), kMostTissueClips));
  return out;
}

template <class Triangles>
bool fits(const Triangles& triangles, std::size_t vertices) {
  return std::ranges::all_of(triangles, [&](const auto& corners) {
    return std::ranges::all_of(corners, [&](std::uint32_t corner) { return corner < vertices; });
  });
}

void put_triangles(MessageBytes& out, const TissueTopology& topology, bool cut) {
  for (std::size_t i = 0; i < topology.triangles.size(); ++i) {
    if ((i < topology.cut_face.size() && topology.cut_face[i] != 0) != cut) continue;
    for (const std::uint32_t corner : topology.triangles[i]) out.put(corner);
  }
}

void put_shape(MessageBytes& out, const TissueSurface& surface) {
  const TissueTopology& topology = *surface.topology;
  const std::size_t count = surface.vertices.size();
  if (!fits(topology.triangles, count)) {
    for (int i = 0; i < 3; ++i) out.put(std::uint32_t{0});
    return;
  }
  const auto faces = std::span(topology.cut_face).first(std::min(topology.cut_face.size(), topology.triangles.size()));
  const auto cut = static_cast<std::size_t>(std::ranges::count_if(faces, [](std::uint8_t one) { return one != 0; }));
  out.put(static_cast<std::uint32_t>(count));
  out.put(static_cast<std::uint32_t>(topology.triangles.size()));
  out.put(static_cast<std::uint32_t>(topology.triangles.size() - cut));
  put_triangles(out, topology, false);
  put_triangles(out, topology, true);
  const bool coloured = topology.rgb.size() == count;
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<float, 3>& rgb = coloured ? topology.rgb[i] : kFlesh;
    out.put(std::array<float, 4>{rgb[0], rgb[1], rgb[2], 0.0F});
  }
}

void put_shape(MessageBytes& out, const TissueClip& clip) {
  if (!clip.vertices || !clip.triangles || !fits(*clip.triangles, clip.vertices->size())) {
    for (int i = 0; i < 2; ++i) out.put(std::uint32_t{0});
    return;
  }
  out.put(static_cast<std::uint32_t>(clip.vertices->size()));
  out.put(static_cast<std::uint32_t>(clip.triangles->size()));
  for (const Eigen::Vector3f& vertex : *clip.vertices) out.put(vertex);
  for (const auto& triangle : *clip.triangles) {
    for (const std::uint32_t corner : triangle) out.put(corner);
  }
}

void put_motion(MessageBytes& out, const TissueSurface& surface) {
  constexpr std::uint32_t kShown = 1;
  constexpr std::uint32_t kWet = 2;
  Eigen::AlignedBox3f box;
  bool sound = true;
  for (const Eigen::Vector3f& vertex : surface.vertices) {
    sound = sound && vertex.allFinite() && vertex.cwiseAbs().maxCoeff() < kFarthestTissue;
    box.extend(vertex);
  }
  sound = sound && !box.isEmpty();
  const Eigen::Vector3f low = sound ? box.min() : Eigen::Vector3f(Eigen::Vector3f::Zero());
  const Eigen::Vector3f edges = sound ? box.sizes() : Eigen::Vector3f(Eigen::Vector3f::Zero());
  out.put(low);
  out.put(edges);
  out.put((sound && surface.visible ? kShown : 0U) | (surface.wet ? kWet : 0U));
  for (const Eigen::Vector3f& vertex : surface.vertices) {
    for (int i = 0; i < 3; ++i) out.put(packed_in_box(vertex[i], low[i], edges[i]));
  }
  out.align();
  for (const Eigen::Vector3f& normal : surface.normals) {
    for (const std::int8_t value : packed_normal(normal)) out.put(value);
  }
  out.align();
  const bool burnt = surface.burn.size() == surface.vertices.size();
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) out.put(packed_burn(burnt ? surface.burn[i] : 0.0F));
  out.align();
}

}  // namespace

TissueShapeKey tissue_shape_key(const TissueView& view) {
  const Chosen chosen = chosen_of(view);
  TissueShapeKey out;
  for (const TissueSurface* surface : chosen.surfaces) {
    out.parts.push_back(surface->topology);
    out.vertices.push_back(surface->vertices.size());
  }
  for (const TissueClip& clip : chosen.clips) {
    out.parts.push_back(clip.vertices);
    out.parts.push_back(clip.triangles);
  }
  return out;
}

std::string tissue_shape(const TissueView& view, std::uint32_t number) {
  const Chosen chosen = chosen_of(view);
  MessageBytes out;
  out.put(std::string_view("CMT1"));
  out.put(number);
  out.put(static_cast<std::uint32_t>(chosen.surfaces.size()));
  out.put(static_cast<std::uint32_t>(chosen.clips.size()));
  for (const TissueSurface* surface : chosen.surfaces) put_shape(out, *surface);
  for (const TissueClip& clip : chosen.clips) put_shape(out, clip);
  return out.take();
}

std::string tissue_motion(const TissueView& view, std::uint32_t number) {
  const Chosen chosen = chosen_of(view);
  const auto particles = std::span(view.particles).first(std::min(view.particles.size(), kMostTissueParticles));
  MessageBytes out;
  out.put(std::string_view("CMM1"));
  out.put(number);
  for (const std::size_t count :
       {chosen.surfaces.size(), chosen.clips.size(), particles.size(), std::size_t{view.pool.present}}) {
    out.put(static_cast<std::uint32_t>(count));
  }
  for (const TissueSurface* surface : chosen.surfaces) put_motion(out, *surface);
  for (const TissueClip& clip : chosen.clips) out.put(clip.X_WC);
  for (const TissueParticle& particle : particles) {
    out.put(particle.at);
    out.put(particle.radius_m);
    out.put(std::uint32_t{particle.kind});
  }
  if (view.pool.present) {
    out.put(view.pool.X_WP);
    out.put(view.pool.size_m.x());
    out.put(view.pool.size_m.y());
    out.put(view.pool.level_m);
    out.put(view.pool.rgba);
  }
  return out.take();
}

}  // namespace cellmirror::app
