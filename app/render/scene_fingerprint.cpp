#include "app/render/scene_fingerprint.hpp"

#include <bit>
#include <span>
#include <string_view>

#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::app {

namespace {

// By words of 64 bits: multiply and rotate, as in the body of MurmurHash3 (public domain, A. Appleby).
class Hash {
 public:
  void add(std::uint64_t word) {
    word *= 0x87c3'7b91'1142'53d5ULL;
    word = std::rotl(word, 31) * 0x4cf5'ad43'2745'937fULL;
    state_ = std::rotl(state_ ^ word, 27) * 5 + 0x52dc'e729U;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(float value) { add(std::uint64_t{std::bit_cast<std::uint32_t>(value)}); }
  void add(bool value) { add(std::uint64_t{value ? 1U : 0U}); }
  void add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      word = word << 8U | static_cast<unsigned char>(text[i]);
      if (i % 8 == 7) add(word);
    }
    add(word);
  }
  template <class Derived>
  void add(const Eigen::MatrixBase<Derived>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) add(matrix.derived().data()[i]);
  }
  void add(const Pose& pose) { add(pose.matrix()); }
  void add(const Colour& colour) {
    for (const float part : colour) add(part);
  }
  // The size first, so that what ends one list does not begin the next.
  template <class List>
  auto sized(const List& list) {
    add(static_cast<std::uint64_t>(list.size()));
    return std::span(list);
  }

  [[nodiscard]] std::uint64_t state() const { return state_; }

 private:
  std::uint64_t state_ = 0x9e37'79b9'7f4a'7c15ULL;
};

void add_bodies(Hash& hash, const Scene& scene) {
  for (const SceneBody& body : hash.sized(scene.bodies)) {
    hash.add(std::uint64_t{body.object} << 32U | static_cast<std::uint64_t>(body.shape) << 24U |
             static_cast<std::uint64_t>(body.mode) << 16U | static_cast<std::uint64_t>(body.mark) << 8U |
             (body.casts_shadow ? 1U : 0U));
    hash.add(std::bit_cast<std::uint64_t>(body.mesh.get()));
    hash.add(body.size);
    hash.add(body.X_WG);
    hash.add(body.rgba);
  }
}

void add_lines(Hash& hash, const Scene& scene) {
  for (const SceneAxes& axes : hash.sized(scene.axes)) {
    hash.add(axes.X_WF);
    hash.add(axes.length_m);
    hash.add(axes.emphasized);
    hash.add(axes.name);
  }
  for (const SceneLine& line : hash.sized(scene.lines)) {
    hash.add(line.from);
    hash.add(line.to);
    hash.add(line.rgba);
    hash.add(line.width_px);
    hash.add(line.dashed);
    hash.add(line.on_top);
  }
  for (const SceneTrace& trace : hash.sized(scene.traces)) {
    hash.add(trace.rgba);
    for (const Eigen::Vector3f& point : hash.sized(trace.points)) hash.add(point);
  }
}

void add_signs(Hash& hash, const Scene& scene) {
  for (const SceneCone& cone : hash.sized(scene.cones)) {
    hash.add(cone.X_WS);
    hash.add(cone.half_angle_rad);
    hash.add(cone.length_m);
    hash.add(cone.rgba);
  }
  for (const SceneArrow& arrow : hash.sized(scene.arrows)) {
    hash.add(arrow.from);
    hash.add(arrow.along);
    hash.add(arrow.rgba);
    hash.add(arrow.torque);
  }
  for (const SceneSpark& spark : hash.sized(scene.sparks)) {
    hash.add(spark.at);
    hash.add(std::uint64_t{spark.phase});
  }
}

void add_texts(Hash& hash, const Scene& scene) {
  for (const SceneLabel& label : hash.sized(scene.labels)) {
    hash.add(label.at);
    hash.add(label.text);
    hash.add(static_cast<std::uint64_t>(label.mark));
  }
  for (const LegendEntry& entry : hash.sized(scene.legend)) {
    hash.add(entry.rgba);
    hash.add(entry.text);
  }
  for (const std::string& message : hash.sized(scene.messages)) hash.add(message);
}

// The shapes go with the step; the rest may change while the simulation stands still.
void add_tissue(Hash& hash, const Scene& scene) {
  hash.add(scene.tissue != nullptr);
  if (scene.tissue == nullptr) return;
  const TissueView& view = *scene.tissue;
  hash.add(view.step);
  for (const TissueSurface& surface : hash.sized(view.surfaces)) {
    hash.add(surface.name);
    hash.add(std::bit_cast<std::uint64_t>(surface.topology.get()));
    hash.add(std::bit_cast<std::uint64_t>(surface.look.get()));
    hash.add(surface.visible);
    hash.add(surface.wet);
  }
  for (const DrawMode mode : hash.sized(scene.tissue_modes)) hash.add(static_cast<std::uint64_t>(mode));
  for (const std::size_t count : {view.network.nodes.size(), view.particles.size(), view.clips.size()})
    hash.add(static_cast<std::uint64_t>(count));
  hash.add(view.pool.present);
  hash.add(view.pool.level_m);
  hash.add(view.pool.blood);
  hash.add(view.pool.rgba);
  hash.add(view.smoke);
  hash.add(view.lens_fog);
}

void add_volumes(Hash& hash, const Scene& scene) {
  for (const SceneVolume& volume : hash.sized(scene.volumes)) {
    hash.add(std::bit_cast<std::uint64_t>(volume.grid.get()));
    hash.add(volume.X_WV);
    const VolumeSettings& settings = volume.settings;
    for (const VolumePlane& plane : settings.planes) {
      hash.add(static_cast<std::uint64_t>(plane.side) << 1U | (plane.framed ? 1U : 0U));
      for (const double value : {plane.elevation_rad, plane.azimuth_rad, plane.distance_m}) hash.add(value);
    }
    hash.add(static_cast<std::uint64_t>(settings.table) << 1U | (settings.isosurface ? 1U : 0U));
    for (const double value : {settings.medical.air, settings.medical.fat, settings.medical.tissue,
                               settings.medical.bone, settings.iso_value}) {
      hash.add(value);
    }
    for (const VolumeTableParameters& table : settings.parameters) {
      for (const double value : {table.opacity, table.gain, table.level, table.window}) hash.add(value);
    }
    for (const auto& table : volume.user_tables) hash.add(std::bit_cast<std::uint64_t>(table.get()));
    hash.add(volume.tables_revision);
  }
}

void add_panes(Hash& hash, std::span<const Pane> panes) {
  for (const Pane& pane : hash.sized(panes)) {
    for (const double value : {pane.left, pane.top, pane.width, pane.height, pane.eye.opening_angle, pane.eye.height_m,
                               pane.eye.near_distance, pane.eye.far_distance}) {
      hash.add(value);
    }
    hash.add(pane.eye.X_WE);
    hash.add(static_cast<std::uint64_t>(pane.view));
    hash.add(std::uint64_t{pane.camera});
    hash.add(pane.title);
  }
}

}  // namespace

std::uint64_t volume_fingerprint(const Scene& scene) {
  Hash hash;
  add_volumes(hash, scene);
  return hash.state();
}

std::uint64_t content_hash(std::string_view text) {
  Hash hash;
  hash.add(text);
  return hash.state();
}

std::uint64_t fingerprint(const Scene& scene, std::span<const Pane> panes) {
  Hash hash;
  add_bodies(hash, scene);
  add_lines(hash, scene);
  add_signs(hash, scene);
  add_texts(hash, scene);
  add_tissue(hash, scene);
  add_volumes(hash, scene);
  hash.add(static_cast<std::uint64_t>(scene.modes.to_ullong()));
  hash.add(scene.floor_z_m);
  hash.add(scene.floor_low);
  hash.add(scene.floor_high);
  add_panes(hash, panes);
  return hash.state();
}

}  // namespace cellmirror::app
