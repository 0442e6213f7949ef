#include "app/recording_layout/tissue_messages.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "app/recording_layout/byte_planes.hpp"
#include "rt_core/base/state_bytes.hpp"
#include "rt_core/ports/packed_vertex.hpp"

namespace cellmirror::app {

namespace {

constexpr std::uint8_t kHasShape = 1;
constexpr std::uint8_t kVisible = 2;
constexpr std::uint8_t kWet = 4;
constexpr std::size_t kHeadBytes = 2 + 8 + 8 + 4;
constexpr std::size_t kNameBytes = 256;
constexpr std::size_t kMovingBytes = 6 + 2 + 1;  // of a vertex: place, normal, burn

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Error tissue_not_sound(std::string_view what) {
  return {fmt::format("the recorded tissue is not sound: {}", what), "check the file: recording check"};
}

bool fits(const Triangles& triangles, std::size_t vertices) {
  return std::ranges::all_of(triangles, [&](const std::array<std::uint32_t, 3>& corners) {
    return std::ranges::all_of(corners, [&](std::uint32_t corner) { return corner < vertices; });
  });
}

bool all_finite(const std::vector<Eigen::Vector3f>& places) {
  return std::ranges::all_of(places, [](const Eigen::Vector3f& place) { return place.allFinite(); });
}

void put_head(StateWriter& out, const TissueHead& head, std::uint8_t flags) {
  std::uint8_t version = kTissueVersion;
  if (head.has_shape) flags |= kHasShape;
  TissueHead copy = head;
  out(version, flags, copy.step, copy.time, copy.revision);
}

TissueHead take_head(StateReader& in, std::uint8_t& flags) {
  std::uint8_t version = 0;
  TissueHead head;
  in(version, flags, head.step, head.time, head.revision);
  if (version != kTissueVersion) in.fail();
  head.has_shape = (flags & kHasShape) != 0;
  return head;
}

// A number of things that have at least `bytes` each in what is left.
std::size_t take_count(StateReader& in, std::size_t most, std::size_t bytes) {
  std::uint32_t count = 0;
  in(count);
  if (in.ok() && (count > most || count > in.rest().size() / std::max<std::size_t>(bytes, 1))) in.fail();
  return in.ok() ? count : 0;
}

void put_count(StateWriter& out, std::size_t count) {
  auto number = static_cast<std::uint32_t>(count);
  out(number);
}

template <class Archive>
void three(Archive& archive, Eigen::Vector3f& vector) {
  archive(vector[0], vector[1], vector[2]);
}

// Place and turn; what is no turn fails.
template <class Archive>
void pose(Archive& archive, Pose& X) {
  Eigen::Vector3d place = X.translation();
  Eigen::Quaterniond turn(X.linear());
  archive(place, turn);
  if constexpr (Archive::kReads) {
    const double norm = turn.norm();
    if (!place.allFinite() || !(norm > 0.5 && norm < 2.0)) return archive.fail();
    X.translation() = place;
    X.linear() = turn.normalized().toRotationMatrix();
  }
}

bool recordable(const TissueSurface& surface) {
  const std::size_t vertices = surface.vertices.size();
  return surface.topology && vertices > 0 && vertices <= kMostRecordedVertices &&
         surface.topology->triangles.size() <= kMostRecordedTriangles && surface.normals.size() == vertices &&
         all_finite(surface.vertices) && fits(surface.topology->triangles, vertices);
}

void put_moving(StateWriter& out, const TissueSurface& surface) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : surface.vertices) box.extend(vertex);
  Eigen::Vector3f low = box.min();
  Eigen::Vector3f edges = box.sizes();
  three(out, low);
  three(out, edges);
  for (int axis = 0; axis < 3; ++axis) {
    put_planes(out, surface.vertices.size(),
               [&](std::size_t i) { return packed_in_box(surface.vertices[i][axis], low[axis], edges[axis]); });
  }
  for (const Eigen::Vector3f& normal : surface.normals) {
    auto packed = packed_normal(normal);
    out(packed);
  }
  const bool burnt = surface.burn.size() == surface.vertices.size();
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    std::uint8_t burn = packed_burn(burnt ? surface.burn[i] : 0.0F);
    out(burn);
  }
}

void put_shape(StateWriter& out, const TissueSurface& surface) {
  const TissueTopology& topology = *surface.topology;
  const std::size_t vertices = surface.vertices.size();
  out.text(surface.name);
  put_count(out, topology.triangles.size());
  for (std::array<std::uint32_t, 3> triangle : topology.triangles) out(triangle);
  for (std::size_t i = 0; i < topology.triangles.size(); ++i) {
    bool cut = i < topology.cut_face.size() && topology.cut_face[i] != 0;
    out(cut);
  }
  bool textured = topology.texture.size() == vertices;
  out(textured);
  for (std::size_t i = 0; textured && i < vertices; ++i) {
    Eigen::Vector2f place = topology.texture[i];
    out(place[0], place[1]);
  }
  bool coloured = topology.rgb.size() == vertices;
  out(coloured);
  for (std::size_t i = 0; coloured && i < vertices; ++i) {
    for (const float value : topology.rgb[i]) {
      auto colour = static_cast<std::uint8_t>(
          std::lround(255.0F * (std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 0.0F)));
      out(colour);
    }
  }
}

std::shared_ptr<const TissueTopology> take_topology(StateReader& in, std::uint32_t revision, std::size_t vertices) {
  auto out = std::make_shared<TissueTopology>();
  out->revision = revision;
  out->triangles.resize(take_count(in, kMostRecordedTriangles, sizeof(Triangles::value_type) + 1));
  for (auto& triangle : out->triangles) in(triangle);
  out->cut_face.resize(out->triangles.size());
  for (std::uint8_t& cut : out->cut_face) in(cut);
  bool textured = false;
  in(textured);
  if (textured && in.ok()) out->texture.resize(in.rest().size() / (2 * sizeof(float)) < vertices ? 0 : vertices);
  if (textured && out->texture.empty()) in.fail();
  for (Eigen::Vector2f& place : out->texture) {
    in(place[0], place[1]);
    if (!place.allFinite()) in.fail();
  }
  bool coloured = false;
  in(coloured);
  if (coloured && in.ok()) out->rgb.resize(in.rest().size() / 3 < vertices ? 0 : vertices);
  if (coloured && out->rgb.empty()) in.fail();
  for (auto& rgb : out->rgb) {
    for (float& value : rgb) {
      std::uint8_t colour = 0;
      in(colour);
      value = static_cast<float>(colour) / 255.0F;
    }
  }
  if (!in.ok() || !in.at_end() || !fits(out->triangles, vertices)) return nullptr;
  return out;
}

// How many vertices the message has, behind its head.
std::size_t take_vertices(StateReader& in) { return take_count(in, kMostRecordedVertices, kMovingBytes); }

void put_pool(StateWriter& out, TissuePool pool) {
  out(pool.present);
  if (!pool.present) return;
  pose(out, pool.X_WP);
  out(pool.size_m[0], pool.size_m[1], pool.level_m, pool.blood, pool.rgba, pool.columns);
  put_count(out, pool.heights_m.size());
  for (float& height : pool.heights_m) out(height);
}

bool is_sound(const TissuePool& pool) {
  constexpr double kLargest = 1000;  // m
  const auto near = [](double value) { return std::abs(value) < kLargest; };
  const std::size_t columns = pool.columns;
  const bool grid = pool.heights_m.empty() ||
                    (columns > 1 && pool.heights_m.size() % columns == 0 && pool.heights_m.size() / columns > 1);
  return near(static_cast<double>(pool.size_m[0])) && near(static_cast<double>(pool.size_m[1])) && near(pool.level_m) &&
         near(pool.blood) && grid &&
         std::ranges::all_of(pool.rgba, [](float value) { return value >= 0.0F && value <= 1.0F; }) &&
         std::ranges::all_of(pool.heights_m, [&](float height) { return near(static_cast<double>(height)); });
}

TissuePool take_pool(StateReader& in) {
  TissuePool pool;
  in(pool.present);
  if (!pool.present || !in.ok()) return pool;
  pose(in, pool.X_WP);
  in(pool.size_m[0], pool.size_m[1], pool.level_m, pool.blood, pool.rgba, pool.columns);
  pool.heights_m.resize(take_count(in, kMostRecordedVertices, sizeof(float)));
  for (float& height : pool.heights_m) in(height);
  if (in.ok() && !is_sound(pool)) in.fail();
  return pool;
}

template <class Archive>
void particle(Archive& archive, TissueParticle& one) {
  three(archive, one.at);
  archive(one.radius_m, one.kind, one.age);
  if constexpr (Archive::kReads) {
    if (!one.at.allFinite() || !std::isfinite(one.radius_m) || !std::isfinite(one.age)) archive.fail();
  }
}

// Clips whose parts fit together, within the bounds.
std::vector<const TissueClip*> clips_of(const TissueView& view) {
  std::vector<const TissueClip*> out;
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  for (const TissueClip& clip : view.clips) {
    const bool sound = clip.vertices && clip.triangles && clip.X_WC.matrix().allFinite() &&
                       all_finite(*clip.vertices) && fits(*clip.triangles, clip.vertices->size());
    if (!sound) continue;
    vertices += clip.vertices->size();
    triangles += clip.triangles->size();
    if (out.size() == kMostRecordedClips || vertices > kMostRecordedVertices || triangles > kMostRecordedTriangles)
      break;
    out.push_back(&clip);
  }
  return out;
}

RecordedClipShapes::Shape take_clip_shape(StateReader& in) {
  std::vector<Eigen::Vector3f> vertices(take_count(in, kMostRecordedVertices, 3 * sizeof(float)));
  for (Eigen::Vector3f& vertex : vertices) three(in, vertex);
  Triangles triangles(take_count(in, kMostRecordedTriangles, sizeof(Triangles::value_type)));
  for (auto& triangle : triangles) in(triangle);
  if (!all_finite(vertices) || !fits(triangles, vertices.size())) in.fail();
  return {std::make_shared<const std::vector<Eigen::Vector3f>>(std::move(vertices)),
          std::make_shared<const Triangles>(std::move(triangles))};
}

// What moves, up to the shapes of clips.
TissueView take_moving(StateReader& in) {
  TissueView view;
  std::uint8_t flags = 0;
  view.step = take_head(in, flags).step;
  in(view.smoke, view.lens_fog);
  if (!(view.smoke >= 0 && view.smoke <= 1 && view.lens_fog >= 0 && view.lens_fog <= 1)) in.fail();
  view.pool = take_pool(in);
  view.particles.resize(take_count(in, kMostRecordedParticles, sizeof(float) * 5 + 1));
  for (TissueParticle& one : view.particles) particle(in, one);
  view.clips.resize(take_count(in, kMostRecordedClips, sizeof(double) * 7 + 1));
  for (TissueClip& clip : view.clips) {
    pose(in, clip.X_WC);
    in(clip.closes_vessel);
  }
  return view;
}

}  // namespace

Result<TissueHead> read_tissue_head(std::span<const std::byte> message) {
  StateReader in(message);
  std::uint8_t flags = 0;
  const TissueHead head = take_head(in, flags);
  if (!in.ok()) return std::unexpected(tissue_not_sound("the head of a message, or another version"));
  return head;
}

bool same_but_for_time(std::span<const std::byte> a, std::span<const std::byte> b) {
  // Version and flags, then step and time.
  constexpr std::size_t kTimeEnds = 2 + 8 + 8;
  return a.size() == b.size() && a.size() >= kTimeEnds && std::ranges::equal(a.first(2), b.first(2)) &&
         std::ranges::equal(a.subspan(kTimeEnds), b.subspan(kTimeEnds));
}

bool encode_surface(const TissueHead& head, const TissueSurface& surface, std::vector<std::byte>& out) {
  if (!recordable(surface)) return false;
  const std::size_t vertices = surface.vertices.size();
  std::size_t bytes = kHeadBytes + 4 + 6 * sizeof(float) + vertices * kMovingBytes;
  if (head.has_shape)
    bytes += kNameBytes + 4 + 2 + surface.topology->triangles.size() * (3 * sizeof(std::uint32_t) + 1) +
             vertices * (2 * sizeof(float) + 3);
  out.resize(bytes);
  StateWriter writer(out);
  put_head(writer, head, static_cast<std::uint8_t>((surface.visible ? kVisible : 0U) | (surface.wet ? kWet : 0U)));
  put_count(writer, vertices);
  put_moving(writer, surface);
  if (head.has_shape) put_shape(writer, surface);
  out.resize(writer.size());
  return writer.ok();
}

Result<RecordedShape> read_shape(std::span<const std::byte> message) {
  StateReader in(message);
  std::uint8_t flags = 0;
  const TissueHead head = take_head(in, flags);
  RecordedShape out;
  out.revision = head.revision;
  out.vertices = take_vertices(in);
  in.skip(6 * sizeof(float) + out.vertices * kMovingBytes);
  in.text(out.name);
  if (in.ok() && head.has_shape) out.topology = take_topology(in, head.revision, out.vertices);
  if (!out.topology) return std::unexpected(tissue_not_sound("the shape of a surface"));
  return out;
}

Result<TissueSurface> read_surface(std::span<const std::byte> message, const RecordedShape& shape) {
  StateReader in(message);
  std::uint8_t flags = 0;
  const TissueHead head = take_head(in, flags);
  const std::size_t vertices = take_vertices(in);
  if (!in.ok() || !shape.topology || head.revision != shape.revision || vertices != shape.vertices)
    return std::unexpected(tissue_not_sound("a surface without its shape"));
  Eigen::Vector3f low = Eigen::Vector3f::Zero();
  Eigen::Vector3f edges = Eigen::Vector3f::Zero();
  three(in, low);
  three(in, edges);
  TissueSurface out;
  out.name = shape.name;
  out.topology = shape.topology;
  out.visible = (flags & kVisible) != 0;
  out.wet = (flags & kWet) != 0;
  out.vertices.resize(vertices);
  for (int axis = 0; axis < 3; ++axis) {
    take_planes(in, vertices, [&](std::size_t i, std::uint16_t packed) {
      out.vertices[i][axis] = unpacked_in_box(packed, low[axis], edges[axis]);
    });
  }
  out.normals.resize(vertices);
  for (Eigen::Vector3f& normal : out.normals) {
    std::array<std::int8_t, 2> packed{};
    in(packed);
    normal = unpacked_normal(packed);
  }
  out.burn.resize(vertices);
  for (float& burn : out.burn) {
    std::uint8_t packed = 0;
    in(packed);
    burn = unpacked_burn(packed);
  }
  if (!in.ok() || in.at_end() == head.has_shape || !all_finite(out.vertices))
    return std::unexpected(tissue_not_sound("the places of a surface"));
  return out;
}

void encode_tissue_effects(const TissueHead& head, const TissueView& view, std::vector<std::byte>& out) {
  const std::vector<const TissueClip*> clips = clips_of(view);
  std::size_t bytes = kHeadBytes + 256 + view.pool.heights_m.size() * sizeof(float) +
                      view.particles.size() * (5 * sizeof(float) + 1) + clips.size() * (7 * sizeof(double) + 1);
  for (const TissueClip* clip : clips)
    bytes += 8 + clip->vertices->size() * 3 * sizeof(float) + clip->triangles->size() * 3 * sizeof(std::uint32_t);
  out.resize(bytes);
  StateWriter writer(out);
  put_head(writer, head, 0);
  double smoke = std::isfinite(view.smoke) ? std::clamp(view.smoke, 0.0, 1.0) : 0.0;
  double fog = std::isfinite(view.lens_fog) ? std::clamp(view.lens_fog, 0.0, 1.0) : 0.0;
  writer(smoke, fog);
  const bool pool =
      view.pool.X_WP.matrix().allFinite() && is_sound(view.pool) && view.pool.heights_m.size() <= kMostRecordedVertices;
  put_pool(writer, pool ? view.pool : TissuePool());
  std::vector<TissueParticle> particles;
  for (const TissueParticle& one : view.particles) {
    const bool finite = one.at.allFinite() && std::isfinite(one.radius_m) && std::isfinite(one.age);
    if (finite && particles.size() < kMostRecordedParticles) particles.push_back(one);
  }
  put_count(writer, particles.size());
  for (TissueParticle& one : particles) particle(writer, one);
  put_count(writer, clips.size());
  for (const TissueClip* clip : clips) {
    Pose X_WC = clip->X_WC;
    bool closes = clip->closes_vessel;
    pose(writer, X_WC);
    writer(closes);
  }
  for (std::size_t i = 0; head.has_shape && i < clips.size(); ++i) {
    put_count(writer, clips[i]->vertices->size());
    for (Eigen::Vector3f vertex : *clips[i]->vertices) three(writer, vertex);
    put_count(writer, clips[i]->triangles->size());
    for (std::array<std::uint32_t, 3> triangle : *clips[i]->triangles) writer(triangle);
  }
  out.resize(writer.size());
}

Result<RecordedClipShapes> read_clip_shapes(std::span<const std::byte> message) {
  const auto head = read_tissue_head(message);
  if (!head) return std::unexpected(head.error());
  StateReader in(message);
  const TissueView moving = take_moving(in);
  RecordedClipShapes out;
  out.revision = head->revision;
  if (!head->has_shape) in.fail();
  for (std::size_t i = 0; i < moving.clips.size() && in.ok(); ++i) out.shapes.push_back(take_clip_shape(in));
  if (!in.ok() || !in.at_end()) return std::unexpected(tissue_not_sound("the shapes of clips"));
  return out;
}

Result<TissueView> read_tissue_effects(std::span<const std::byte> message, const RecordedClipShapes& shapes) {
  const auto head = read_tissue_head(message);
  if (!head) return std::unexpected(head.error());
  StateReader in(message);
  TissueView out = take_moving(in);
  if (!in.ok() || (!head->has_shape && !in.at_end())) return std::unexpected(tissue_not_sound("clips, drops or pool"));
  if (head->revision != shapes.revision || shapes.shapes.size() != out.clips.size()) out.clips.clear();
  for (std::size_t i = 0; i < out.clips.size(); ++i) {
    out.clips[i].vertices = shapes.shapes[i].vertices;
    out.clips[i].triangles = shapes.shapes[i].triangles;
  }
  return out;
}

}  // namespace cellmirror::app
