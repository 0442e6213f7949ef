#include "drivers/display/geometry_export.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/display/internal/glb_writer.hpp"
#include "drivers/display/internal/primitives.hpp"
#include "drivers/display/internal/surface.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/geometry/shape.hpp"

namespace cellmirror::display {

namespace {

constexpr double kFarthest = 1e5;  // m: as the renderer

bool usable(double size) { return size > 0 && size < kFarthest; }

Colour finite(Colour colour) {
  for (float& value : colour) value = std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 1.0F;
  return colour;
}

// IEC 61966-2-1; glTF has linear colours.
double linear(float value) {
  const double v = value;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::shared_ptr<const Surface> surface_of(const geometry::TriangleMesh& mesh) {
  return std::make_shared<const Surface>(smooth_surface(mesh));
}

// The same geometry at several bodies: a shape of unit size, a capsule by its two sizes, or a mesh.
struct GeometryKey {
  Shape shape{};
  const geometry::TriangleMesh* mesh = nullptr;
  std::array<double, 2> sizes{};
  auto operator<=>(const GeometryKey&) const = default;
};

struct Placed {
  GeometryKey key;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

// None: the body cannot be drawn.
std::optional<Placed> placed(const SceneBody& body) {
  const Eigen::Vector3d& size = body.size;
  switch (body.shape) {
    case Shape::box:
      if (!usable(size.x()) || !usable(size.y()) || !usable(size.z())) return std::nullopt;
      return Placed{{body.shape}, size};
    case Shape::cylinder:
      if (!usable(size.x()) || !usable(size.y())) return std::nullopt;
      return Placed{{body.shape}, {size.x(), size.x(), size.y()}};
    case Shape::sphere:
      if (!usable(size.x())) return std::nullopt;
      return Placed{{body.shape}, Eigen::Vector3d::Constant(size.x())};
    case Shape::capsule:
      if (!usable(size.x()) || !(size.y() >= 0) || !usable(size.x() + size.y())) return std::nullopt;
      return Placed{{body.shape, nullptr, {size.x(), size.y()}}};
    case Shape::mesh:
      if (body.mesh == nullptr) return std::nullopt;
      return Placed{{body.shape, body.mesh.get()}};
  }
  return std::nullopt;
}

geometry::TriangleMesh primitive(const GeometryKey& key) {
  switch (key.shape) {
    case Shape::box:
      return unit_box();
    case Shape::cylinder:
      return unit_cylinder();
    case Shape::sphere:
      return unit_sphere();
    case Shape::capsule:
      return capsule(key.sizes[0], key.sizes[1]);
    case Shape::mesh:
      break;
  }
  return {};
}

void write_numbers(JsonWriter& out, std::string_view name, std::initializer_list<double> numbers) {
  out.key(name).begin_array();
  for (const double number : numbers) out.value(number);
  out.end_array();
}

// Builds the document while the buffer grows.
class Document {
 public:
  Document() : buffer_(GeometryExport::kMaxBytes) {
    for (JsonWriter* list : {&materials_, &meshes_, &nodes_}) list->begin_array();
  }

  void begin_nodes(std::size_t count) {
    const double half = std::sqrt(0.5);
    nodes_.begin_object().member("name", "cell");
    write_numbers(nodes_, "rotation", {-half, 0, 0, half});  // z up to y up
    if (count > 0) {
      nodes_.key("children").begin_array();
      for (std::size_t i = 1; i <= count; ++i) nodes_.value(i);
      nodes_.end_array();
    }
    nodes_.end_object();
  }

  void add(std::size_t index, const SceneBody& body, const BodyName& name, const std::optional<std::size_t>& mesh,
           const Eigen::Vector3d& scale) {
    nodes_.begin_object().member("name", std::string_view(name.path));
    if (mesh) nodes_.member("mesh", *mesh);
    const Eigen::Matrix4d& X_WG = body.X_WG.matrix();
    if (X_WG.allFinite() && X_WG.cwiseAbs().maxCoeff() < kFarthest) {
      const Eigen::Quaterniond turn = Eigen::Quaterniond(body.X_WG.linear()).normalized();
      const Eigen::Vector3d at = body.X_WG.translation();
      write_numbers(nodes_, "translation", {at.x(), at.y(), at.z()});
      write_numbers(nodes_, "rotation", {turn.x(), turn.y(), turn.z(), turn.w()});
    }
    write_numbers(nodes_, "scale", {scale.x(), scale.y(), scale.z()});
    nodes_.key("extras").begin_object().member("index", index).member("object", body.object);
    nodes_.member("path", std::string_view(name.path)).member("robot", std::string_view(name.robot));
    nodes_.end_object().end_object();
  }

  // None: it has no triangles, or the file is full.
  // `closed`: nobody sees it from inside.
  [[nodiscard]] std::optional<std::size_t> mesh_of(const GeometryKey& key, const Surface* surface, const Colour& rgba,
                                                   bool closed) {
    auto known = blocks_.find(key);
    if (known == blocks_.end()) known = blocks_.emplace(key, buffer_.add(*surface)).first;
    if (!known->second) {
      if (!surface->corners.empty()) ++left_out_;
      return std::nullopt;
    }
    const std::size_t material = material_of(rgba, closed);
    const auto [mesh, is_new] = mesh_numbers_.try_emplace({key, material}, mesh_numbers_.size());
    if (is_new) {
      meshes_.begin_object().key("primitives").begin_array().begin_object().key("attributes").begin_object();
      meshes_.member("POSITION", known->second->positions).member("NORMAL", known->second->normals).end_object();
      meshes_.member("indices", known->second->indices).member("material", material);
      meshes_.end_object().end_array().end_object();
    }
    return mesh->second;
  }

  [[nodiscard]] std::string finish() {
    const std::size_t buffer_bytes = buffer_.size();
    std::string text = R"({"asset":{"version":"2.0","generator":"cellmirror","extras":{"left_out":)";
    text += std::to_string(left_out_) + R"(}},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)";
    text += nodes_.end_array().take();
    if (!mesh_numbers_.empty()) {
      text += R"(,"meshes":)" + meshes_.end_array().take() + R"(,"materials":)" + materials_.end_array().take();
      text += R"(,"accessors":)" + buffer_.take_accessors() + R"(,"bufferViews":)" + buffer_.take_views();
      text += R"(,"buffers":[{"byteLength":)" + std::to_string(buffer_bytes) + "}]";
    }
    text += '}';
    return glb_container(text, buffer_.take_bytes());
  }

 private:
  std::size_t material_of(const Colour& of_body, bool closed) {
    const Colour rgba = finite(of_body);
    const auto [material, is_new] = material_numbers_.try_emplace({rgba, closed}, material_numbers_.size());
    if (!is_new) return material->second;
    const double alpha = rgba[3];
    materials_.begin_object().key("pbrMetallicRoughness").begin_object();
    write_numbers(materials_, "baseColorFactor", {linear(rgba[0]), linear(rgba[1]), linear(rgba[2]), alpha});
    materials_.member("metallicFactor", 0).member("roughnessFactor", 0.8).end_object();
    if (!closed) materials_.member("doubleSided", true);
    if (alpha < 1) materials_.member("alphaMode", "BLEND");
    materials_.end_object();
    return material->second;
  }

  GlbBuffer buffer_;
  JsonWriter materials_{7};
  JsonWriter meshes_{7};
  JsonWriter nodes_{9};
  std::map<GeometryKey, std::optional<GlbBlock>> blocks_;
  std::map<std::pair<Colour, bool>, std::size_t> material_numbers_;
  std::map<std::pair<GeometryKey, std::size_t>, std::size_t> mesh_numbers_;
  std::size_t left_out_ = 0;
};

}  // namespace

std::string GeometryExport::make(std::span<const SceneBody> bodies,
                                 const std::function<BodyName(std::uint32_t object)>& name_of) {
  Document document;
  document.begin_nodes(bodies.size());
  std::map<GeometryKey, std::shared_ptr<const Surface>> primitives;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const SceneBody& body = bodies[i];
    const std::optional<Placed> place = placed(body);
    std::optional<std::size_t> mesh;
    if (place) {
      std::shared_ptr<const Surface>& surface =
          body.shape == Shape::mesh ? surfaces_[body.mesh] : primitives[place->key];
      if (surface == nullptr) surface = surface_of(body.shape == Shape::mesh ? *body.mesh : primitive(place->key));
      mesh = document.mesh_of(place->key, surface.get(), body.rgba, body.shape != Shape::mesh || body.mesh->closed);
    }
    document.add(i, body, name_of(body.object), mesh, place ? place->scale : Eigen::Vector3d::Ones());
  }
  // Meshes that the cell does not have any more.
  std::erase_if(surfaces_, [](const auto& item) { return item.first.use_count() == 1; });
  return document.finish();
}

}  // namespace cellmirror::display
