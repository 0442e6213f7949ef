#include <fmt/format.h>

#include <array>
#include <string>

#include "config/node_reader.hpp"

namespace cellmirror {

namespace {

constexpr Range kLength{0.0, 1e4, true};

// Exactly one of the shape keys.
void read_shape(TableReader& reader, const FileFinder& files, Geometry& geometry) {
  static constexpr std::array<std::string_view, 5> kShapes{"box_m", "cylinder_m", "sphere_m", "capsule_m", "mesh"};
  int given = 0;
  for (const std::string_view key : kShapes) given += reader.has(key) ? 1 : 0;
  if (given != 1) {
    reader.error({}, given == 0 ? "no shape is given" : "more than one shape is given",
                 "give one of box_m, cylinder_m, sphere_m, capsule_m and mesh");
  }
  if (const auto size = reader.vector3("box_m", kLength)) {
    geometry.shape = Shape::box;
    geometry.size = *size;
  }
  if (const auto size = reader.numbers("cylinder_m", 2, kLength)) {
    geometry.shape = Shape::cylinder;
    geometry.size = {(*size)[0], (*size)[1], 0.0};
  }
  if (const auto radius = reader.number("sphere_m", kLength)) {
    geometry.shape = Shape::sphere;
    geometry.size = {*radius, 0.0, 0.0};
  }
  if (const auto size = reader.numbers("capsule_m", 2, kLength)) {
    geometry.shape = Shape::capsule;
    geometry.size = {(*size)[0], (*size)[1], 0.0};
  }
  const auto mesh = reader.text("mesh");
  const Eigen::Vector3d scale = reader.vector3("scale", {0.0, 1e6, true}).value_or(Eigen::Vector3d::Ones());
  const auto collide_as = read_collide_as(reader);
  for (const char* key : {"scale", "collide_as"}) {
    if (reader.has(key) && !reader.has("mesh")) reader.error(key, fmt::format("{} belongs to a mesh only", key));
  }
  if (!mesh) return;
  geometry.shape = Shape::mesh;
  geometry.size = scale;
  const auto found = files.find(FileUse::mesh, *mesh);
  if (!found) return reader.error("mesh", found.error().what, found.error().remedy);
  if (const auto checked = check_mesh(*found); !checked)
    return reader.error("mesh", checked.error().what, checked.error().remedy);
  geometry.mesh_file = found->string();
  if (!geometry.collides && !geometry.drawn) return;
  const auto shape = geometry.collides ? collide_as : CollideAs::exact;
  auto content = files.mesh(*found, scale, shape, reader.place("mesh"), reader.diagnostics());
  if (!content && !geometry.collides) {
    reader.diagnostics().add({Severity::warning, reader.place("mesh"), content.error().what, "it is not drawn"});
    return;
  }
  if (!content) return reader.error("mesh", content.error().what, content.error().remedy);
  geometry.look = std::move(content->look);
  geometry.collide_as = content->collide_as;
  geometry.mesh = std::move(content->mesh);
  geometry.pieces = std::move(content->pieces);
}

Geometry read_one(TableReader& reader, const FileFinder& files) {
  Geometry geometry;
  const Place place = reader.place();
  geometry.line = place.line;
  geometry.column = place.column;
  geometry.name = reader.text("name").value_or("");
  geometry.collides = reader.boolean("collides").value_or(true);
  geometry.drawn = reader.boolean("drawn").value_or(true);
  read_shape(reader, files, geometry);
  geometry.X_NG = reader.pose();
  if (const auto rgba = reader.numbers("rgba", 4, {0.0, 1.0})) {
    for (std::size_t i = 0; i < 4; ++i) geometry.rgba[i] = static_cast<float>((*rgba)[i]);
  }
  geometry.stands_for = reader.texts("stands_for").value_or(std::vector<std::string>());
  reader.finish();
  return geometry;
}

}  // namespace

std::optional<CollideAs> read_collide_as(TableReader& reader) {
  return reader.choice<CollideAs>(
      "collide_as", {{"exact", CollideAs::exact}, {"hull", CollideAs::hull}, {"parts", CollideAs::parts}});
}

std::vector<Geometry> read_geometry(TableReader& reader, const FileFinder& files) {
  std::vector<Geometry> list;
  for (TableReader& item : reader.tables("geometry", kMostGeometry)) list.push_back(read_one(item, files));
  return list;
}

BodyInertia read_body(TableReader& reader) {
  BodyInertia body;
  auto table = reader.table("body");
  if (!table) return body;
  table->require("mass_kg");
  body.mass_kg = table->number("mass_kg", kNotNegative).value_or(0.0);
  body.p_NC = table->vector3("center_m").value_or(Eigen::Vector3d::Zero());
  if (const auto moments = table->numbers("inertia_kg_m2", 6)) {
    const auto& m = *moments;
    body.I_C << m[0], m[3], m[4], m[3], m[1], m[5], m[4], m[5], m[2];
    if (m[0] < 0 || m[1] < 0 || m[2] < 0)
      table->error("inertia_kg_m2", "a moment of inertia is negative", "the order is xx, yy, zz, xy, xz, yz");
  }
  table->finish();
  return body;
}

}  // namespace cellmirror
