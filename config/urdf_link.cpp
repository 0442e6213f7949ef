#include <fmt/format.h>

#include <cmath>

#include "config/node_reader.hpp"
#include "config/urdf_model.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

using tinyxml2::XMLElement;

namespace {

// A shape that is only drawn may be missing: the rest of the cell works.
void report_shape(const XMLElement& shape, const UrdfXml& xml, bool collides, std::string what,
                  std::string remedy = {}) {
  if (collides) return xml.error(shape, std::move(what), std::move(remedy));
  xml.warning(shape, std::move(what), "it is not drawn");
}

// Positive lengths of a shape.
bool read_lengths(const XMLElement& shape, const UrdfXml& xml, bool collides,
                  std::initializer_list<const char*> attributes, Eigen::Vector3d& size) {
  Eigen::Index i = 0;
  for (const char* attribute : attributes) {
    const auto value = xml.number(shape, attribute, true);
    if (!value) return false;
    if (*value <= 0.0) {
      report_shape(shape, xml, collides, fmt::format("{} is {:g}, but must be positive", attribute, *value));
      return false;
    }
    size[i++] = *value;
  }
  return true;
}

bool read_mesh(const XMLElement& shape, const UrdfXml& xml, const std::filesystem::path& path, const FileFinder& files,
               bool collides, Geometry& geometry) {
  geometry.shape = Shape::mesh;
  geometry.size = xml.vector3(shape, "scale", Eigen::Vector3d::Ones());
  const bool scale_is_good = (geometry.size.array() != 0.0).all();
  if (!scale_is_good) xml.error(shape, "a scale factor is 0");
  const std::string name = xml.text(shape, "filename", true);
  if (shape.Attribute("filename") == nullptr) return false;
  const auto found = files.find_mesh_of_urdf(path, name);
  if (!found) {
    report_shape(shape, xml, collides, found.error().what, found.error().remedy);
    return false;
  }
  if (const auto checked = check_mesh(*found); !checked) {
    report_shape(shape, xml, collides, checked.error().what, checked.error().remedy);
    return false;
  }
  geometry.mesh_file = found->string();
  if (!scale_is_good) return true;
  // What is drawn alone needs no hull and no pieces.
  const auto collide_as = collides ? std::nullopt : std::optional(CollideAs::exact);
  const Place place{xml.file(), shape.GetLineNum(), 0};
  auto content = files.mesh(*found, geometry.size, collide_as, place, xml.diagnostics());
  if (!content && !collides) {
    xml.diagnostics().add({Severity::warning, place, content.error().what, "it is not drawn"});
    return true;
  }
  if (!content) {
    xml.error(shape, content.error().what, content.error().remedy);
    return false;
  }
  geometry.look = std::move(content->look);
  geometry.collide_as = content->collide_as;
  geometry.mesh = std::move(content->mesh);
  geometry.pieces = std::move(content->pieces);
  return true;
}

std::optional<Geometry> read_shape(const XMLElement& element, const UrdfXml& xml, const std::filesystem::path& path,
                                   const FileFinder& files, bool collides) {
  const XMLElement* geometry_element = element.FirstChildElement("geometry");
  const XMLElement* shape = geometry_element == nullptr ? nullptr : geometry_element->FirstChildElement();
  if (shape == nullptr) {
    xml.error(element, "there is no <geometry> with a shape");
    return std::nullopt;
  }
  Geometry geometry;
  geometry.X_NG = xml.origin(element);
  const std::string_view kind = shape->Name();
  bool understood = true;
  if (kind == "box") {
    const auto size = xml.numbers(*shape, "size", 3, true);
    understood = size.has_value();
    if (size) geometry.size = {(*size)[0], (*size)[1], (*size)[2]};
    if (size && (geometry.size.array() <= 0.0).any()) {
      report_shape(*shape, xml, collides, "an edge of the box is not positive");
      understood = false;
    }
  } else if (kind == "cylinder" || kind == "capsule") {
    geometry.shape = kind == "cylinder" ? Shape::cylinder : Shape::capsule;
    understood = read_lengths(*shape, xml, collides, {"radius", "length"}, geometry.size);
  } else if (kind == "sphere") {
    geometry.shape = Shape::sphere;
    understood = read_lengths(*shape, xml, collides, {"radius"}, geometry.size);
  } else if (kind == "mesh") {
    understood = read_mesh(*shape, xml, path, files, collides, geometry);
  } else {
    xml.error(*shape, "this is not a shape", "shapes are box, cylinder, sphere, capsule and mesh");
    understood = false;
  }
  return understood ? std::optional(geometry) : std::nullopt;
}

BodyInertia read_inertial(const XMLElement& link, const UrdfXml& xml) {
  BodyInertia body;
  const XMLElement* inertial = link.FirstChildElement("inertial");
  if (inertial == nullptr) return body;
  const Pose X_NC = xml.origin(*inertial);
  body.p_NC = X_NC.translation();
  if (const XMLElement* mass = inertial->FirstChildElement("mass")) {
    body.mass_kg = xml.number(*mass, "value", true).value_or(0.0);
    if (body.mass_kg < 0.0) xml.error(*mass, "the mass is negative");
  } else {
    xml.error(*inertial, "there is no <mass>");
  }
  const XMLElement* inertia = inertial->FirstChildElement("inertia");
  if (inertia == nullptr) return body;
  const auto moment = [&](const char* attribute) { return xml.number(*inertia, attribute, true).value_or(0.0); };
  const double xx = moment("ixx");
  const double xy = moment("ixy");
  const double xz = moment("ixz");
  const double yy = moment("iyy");
  const double yz = moment("iyz");
  const double zz = moment("izz");
  Eigen::Matrix3d I;
  I << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  if (xx < 0.0 || yy < 0.0 || zz < 0.0) xml.error(*inertia, "a moment of inertia is negative");
  body.I_C = X_NC.linear() * I * X_NC.linear().transpose();
  return body;
}

}  // namespace

std::optional<std::array<float, 4>> read_urdf_color(const XMLElement& material, const UrdfXml& xml) {
  const XMLElement* color = material.FirstChildElement("color");
  if (color == nullptr) return std::nullopt;
  const auto rgba = xml.numbers(*color, "rgba", 4, true);
  if (!rgba) return std::nullopt;
  std::array<float, 4> out{};
  for (std::size_t i = 0; i < 4; ++i) out[i] = static_cast<float>(std::clamp((*rgba)[i], 0.0, 1.0));
  return out;
}

std::optional<UrdfLink> read_urdf_link(const XMLElement& element, const UrdfXml& xml, const UrdfMaterials& materials,
                                       const std::filesystem::path& path, const FileFinder& files) {
  const auto name = xml.name(element, "name");
  UrdfLink link;
  link.line = element.GetLineNum();
  link.inertia = read_inertial(element, xml);
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const std::string_view kind = child->Name();
    if (kind != "visual" && kind != "collision") continue;
    if (link.geometry.size() >= kMostGeometry) {
      xml.error(*child, fmt::format("the link has more than {} shapes", kMostGeometry));
      break;
    }
    const bool collides = kind == "collision";
    auto geometry = read_shape(*child, xml, path, files, collides);
    if (!geometry) continue;
    geometry->drawn = !collides;
    geometry->collides = collides;
    if (const XMLElement* material = child->FirstChildElement("material")) {
      const auto known = materials.find(xml.text(*material, "name", false));
      if (known != materials.end()) geometry->rgba = known->second;
      if (const auto color = read_urdf_color(*material, xml)) geometry->rgba = *color;
    }
    link.geometry.push_back(std::move(*geometry));
  }
  if (!name) return std::nullopt;
  link.name = *name;
  return link;
}

}  // namespace cellmirror
