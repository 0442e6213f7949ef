#include "config/mesh_appearance.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "config/obj_materials.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

void leave_out(AppearanceRequest& request, std::string what, std::string remedy) {
  if (request.left_out.size() < AppearanceRequest::kMostLeftOut)
    request.left_out.push_back({std::move(what), remedy.empty() ? "it is drawn without it" : std::move(remedy)});
}

// The share of each corner of a triangle in the point p of its plane.
Eigen::Vector3d shares(const std::array<Eigen::Vector3d, 3>& t, const Eigen::Vector3d& p) {
  std::array<double, 3> distances{};
  for (std::size_t i = 0; i < 3; ++i) distances[i] = (t[i] - p).norm();
  const auto nearest = std::ranges::min_element(distances) - distances.begin();
  Eigen::Vector3d at_corner = Eigen::Vector3d::Zero();
  at_corner[nearest] = 1.0;
  // Corners were moved by welding, at most: their texture coordinates stay exactly as in the file.
  constexpr double kSamePlace = 1e-6;
  const Eigen::Vector3d u = t[1] - t[0];
  const Eigen::Vector3d v = t[2] - t[0];
  if (distances[static_cast<std::size_t>(nearest)] <= kSamePlace * std::max(u.norm(), v.norm())) return at_corner;
  const Eigen::Vector3d normal = u.cross(v);
  const double area = normal.squaredNorm();
  if (!(area > 0.0)) return at_corner;
  const Eigen::Vector3d w = p - t[0];
  const double b = w.cross(v).dot(normal) / area;
  const double c = u.cross(w).dot(normal) / area;
  const Eigen::Vector3d found(1.0 - b - c, b, c);
  return found.allFinite() && found.minCoeff() > -1.0 && found.maxCoeff() < 2.0 ? found : at_corner;
}

std::string decoded(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto value =
        text[i] == '%' && i + 2 < text.size() ? parse_integer("0x" + text.substr(i + 1, 2)) : std::nullopt;
    out.push_back(value ? static_cast<char>(*value) : text[i]);
    if (value) i += 2;
  }
  return out;
}

// Null if it is not available, which is reported.
Picture load_picture(const SceneMaterial& from, const ScenePolygons& polygons, AppearanceRequest& request) {
  std::string name = from.embedded ? "in the file" : from.picture;
  std::ranges::replace(name, '\\', '/');
  auto picture = from.embedded ? request.embedded(polygons.embedded[*from.embedded]) : request.picture(name);
  if (picture) return std::move(*picture);
  const std::string place = from.place.empty() ? "" : fmt::format(" ({})", from.place);
  leave_out(request, fmt::format("its texture {}{}: {}", printable(name), place, picture.error().what),
            picture.error().remedy);
  return nullptr;
}

}  // namespace

void name_obj_pictures(std::string_view bytes, AppearanceRequest& request, ScenePolygons& polygons) {
  const bool has_places = !polygons.places.empty();
  ObjMaterials known;
  for (const std::string& name : material_files(bytes)) {
    const auto text = request.text(name);
    if (text)
      read_obj_materials(*text, printable(name), known);
    else if (has_places)  // without places there is nothing to lay a picture on
      leave_out(request, fmt::format("its materials: {}", text.error().what), text.error().remedy);
  }
  for (SceneMaterial& material : polygons.palette) {
    const auto at = known.find(material.name);
    if (at == known.end()) continue;
    material.rgb = at->second.rgb;
    material.picture = at->second.picture;
    material.place = at->second.place;
  }
}

void decode_picture_names(ScenePolygons& polygons) {
  for (SceneMaterial& material : polygons.palette) material.picture = decoded(material.picture);
}

std::optional<std::vector<MeshMaterial>> load_palette(const ScenePolygons& polygons, AppearanceRequest& request) {
  std::vector<bool> used(polygons.palette.size());
  for (const std::uint16_t material : polygons.materials) used[material] = true;
  std::vector<MeshMaterial> palette(polygons.palette.size());
  const auto is_white = [](const MeshAppearance::Rgba& colour) {
    return colour == MeshAppearance::Rgba{255, 255, 255, 255};
  };
  bool anything = !std::ranges::all_of(polygons.colours, is_white);
  // Null where a picture cannot be had: thousands of materials may name it.
  std::map<std::pair<std::optional<std::size_t>, std::string>, Picture> known;
  for (std::size_t i = 0; i < palette.size(); ++i) {
    const SceneMaterial& from = polygons.palette[i];
    if (from.is_factor || polygons.colours.empty()) palette[i].rgb = from.rgb;
    if (!used[i] || polygons.places.empty() || (from.picture.empty() && !from.embedded)) continue;
    const auto [at, is_new] = known.try_emplace({from.embedded, from.picture});
    if (is_new) at->second = load_picture(from, polygons, request);
    if (!at->second) continue;
    palette[i].picture = at->second;
    if (!from.is_factor) palette[i].rgb = {1, 1, 1};
    anything = true;
  }
  return anything ? std::optional(std::move(palette)) : std::nullopt;
}

MeshAppearance lay_over(const geometry::TriangleMesh& mesh, const std::vector<std::uint32_t>& origins,
                        const ScenePolygons& from, std::vector<MeshMaterial> palette) {
  MeshAppearance look;
  look.palette = std::move(palette);
  const std::size_t count = mesh.triangles.size();
  look.materials.reserve(count);
  look.places.reserve(3 * count);
  if (!from.colours.empty()) look.colours.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const geometry::TriangleIndices& origin = from.triangles[origins[i]];
    look.materials.push_back(from.materials[origins[i]]);
    const std::array<Eigen::Vector3d, 3> corners{from.vertices[origin[0]], from.vertices[origin[1]],
                                                 from.vertices[origin[2]]};
    for (const std::uint32_t vertex : mesh.triangles[i]) {
      const Eigen::Vector3d part = shares(corners, mesh.vertices[vertex]);
      Eigen::Vector2d place = Eigen::Vector2d::Zero();
      Eigen::Vector4d colour = Eigen::Vector4d::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const double share = part[static_cast<Eigen::Index>(k)];
        if (!from.places.empty()) place += share * from.places[origin[k]].cast<double>();
        if (from.colours.empty()) continue;
        for (std::size_t c = 0; c < 4; ++c) colour[static_cast<Eigen::Index>(c)] += share * from.colours[origin[k]][c];
      }
      // assimp's v goes up from the lower edge.
      look.places.emplace_back(static_cast<float>(place.x()), static_cast<float>(1.0 - place.y()));
      if (from.colours.empty()) continue;
      MeshAppearance::Rgba& to = look.colours.emplace_back();
      for (std::size_t c = 0; c < 4; ++c)
        to[c] = static_cast<std::uint8_t>(std::clamp(std::lround(colour[static_cast<Eigen::Index>(c)]), 0L, 255L));
    }
  }
  return look;
}

}  // namespace cellmirror
