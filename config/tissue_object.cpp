#include "config/tissue_object.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "config/msh/tetra_surface.hpp"
#include "config/tables_file.hpp"
#include "config/tissue_parts.hpp"
#include "config/tissue_surface.hpp"
#include "rt_core/base/counted.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;
using geometry::TriangleMesh;
using tissue::ObjectDescription;

namespace {

constexpr Range kElementSize{0.0005, 0.5};
constexpr Range kTissueScale{0.0, 1e6, true};

class ObjectReader {
 public:
  ObjectReader(const FileFinder& files, Diagnostics& of_tetrahedra) : files_(files), of_tetrahedra_(of_tetrahedra) {}

  void read(TableReader& top, ObjectDescription& object) {
    object.name = fs::path(top.file()).filename().string();
    object.file = top.file();
    static_cast<void>(top.text("description"));
    read_material_table(top, object.material);
    object.regions = read_regions(top, object.material);
    object.fixed = read_fixed_zones(top);
    object.vessels = read_vessels(top);
    object.pools = read_pools(top);
    object.attributes = read_attributes(top);
    read_rgba(top, object.rgba);
    check_attributes(top, object);
    read_volume(top, object);
    read_surface(top, object);
    if (object.surface.vertices.empty()) return;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : object.surface.vertices) box.extend(p);
    check_places(top, object, box);
    check_size(top, object, box);
  }

 private:
  static void read_material_table(TableReader& top, tissue::Material& material) {
    auto table = top.table("material");
    if (!table) return;
    read_material(*table, material);
    table->finish();
  }

  // An attribute that needs a figure which no material has would never show.
  static void check_attributes(TableReader& top, const ObjectDescription& object) {
    const auto somewhere = [&](double tissue::Material::* strain) {
      bool found = object.material.*strain > 0;
      for (const tissue::Region& region : object.regions) found = found || region.material.*strain > 0;
      return found;
    };
    const auto warn = [&](TissueAttribute which, double tissue::Material::* strain, const char* word, const char* key) {
      if (!has(object.attributes, which) || somewhere(strain)) return;
      top.diagnostics().warning(top.place("attributes"), fmt::format("{} is on, but no material has a {}", word, key),
                                fmt::format("give {} in [material] or in a [[region]]", key));
    };
    warn(TissueAttribute::tear, &tissue::Material::tear_strain, "TEAR", "tear_strain");
    warn(TissueAttribute::plastic, &tissue::Material::yield_strain, "PLASTIC", "yield_strain");
  }

  void read_volume(TableReader& top, ObjectDescription& object) {
    auto table = top.table("volume");
    if (!table) return;
    const auto size = table->number("element_size_m", kElementSize);
    object.element_size_m = size.value_or(object.element_size_m);
    object.most_substeps = static_cast<int>(table->integer("most_substeps", 1, 4).value_or(object.most_substeps));
    const auto name = table->text("msh");
    const double scale = table->number("scale", kTissueScale).value_or(1.0);
    for (const auto& [key, other, given] :
         {std::tuple("element_size_m", "msh", name.has_value()), std::tuple("scale", "element_size_m", !name)}) {
      if (table->has(key) && given)
        table->error(key, fmt::format("{} does not go with {}", key, other),
                     "tetrahedra come from a file (msh, scale) or from a lattice (element_size_m)");
    }
    if (name) read_tetrahedra(*table, *name, scale, object);
    table->finish();
  }

  void read_tetrahedra(TableReader& table, const std::string& name, double scale, ObjectDescription& object) {
    has_msh_ = true;
    const auto found = files_.find(FileUse::mesh, name);
    if (!found) return table.error("msh", found.error().what, found.error().remedy);
    if (!equal_ignoring_case(found->extension().string(), ".msh"))
      return table.error("msh", fmt::format("{} is no .msh file", printable(name)), "save it with gmsh -format msh41");
    Diagnostics findings;
    auto mesh = files_.tetrahedra(*found, scale, findings);
    of_tetrahedra_.take(findings);
    if (!mesh) {
      return table.error("msh", fmt::format("{} is refused", found->filename().string()),
                         fmt::format("cellmirror check {} shows why", found->string()));
    }
    if (mesh->tetrahedra.size() > kMostObjectElements) {
      return table.error("msh",
                         fmt::format("{} has {} tetrahedra, more than {}", found->filename().string(),
                                     mesh->tetrahedra.size(), kMostObjectElements),
                         "make a coarser mesh");
    }
    object.volume = std::move(*mesh);
  }

  void read_surface(TableReader& top, ObjectDescription& object) {
    auto table = top.table("surface");
    if (!table) {
      if (!has_msh_ && !top.has("surface")) {
        top.error({}, "the object has no surface",
                  "give [surface] mesh = \"NAME.obj\", or [volume] msh = \"NAME.msh\"");
      }
      if (!object.volume.tetrahedra.empty()) surface_of_tetrahedra(top, object);
      return;
    }
    table->require("mesh");
    const auto name = table->text("mesh");
    const Eigen::Vector3d scale = table->vector3("scale", kTissueScale).value_or(Eigen::Vector3d::Ones());
    if (name) read_mesh(*table, *name, scale, object);
    table->finish();
  }

  static void surface_of_tetrahedra(TableReader& top, ObjectDescription& object) {
    auto surface = msh::surface_of(object.volume);
    if (!surface) return top.error("volume", surface.error().what, surface.error().remedy);
    if (surface->triangles.size() > kMostSurfaceTriangles)
      return top.error("volume", fmt::format("the surface has {} triangles, more than {}", surface->triangles.size(),
                                             kMostSurfaceTriangles));
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : surface->vertices) box.extend(p);
    if (const auto size = check_object_size(box); !size)
      return top.error("volume", "the object has an impossible size: " + size.error().what, size.error().remedy);
    object.surface = std::move(*surface);
  }

  void read_mesh(TableReader& table, const std::string& name, const Eigen::Vector3d& scale, ObjectDescription& object) {
    const auto found = files_.find(FileUse::mesh, name);
    if (!found) return table.error("mesh", found.error().what, found.error().remedy);
    if (const auto checked = check_mesh(*found); !checked)
      return table.error("mesh", checked.error().what, checked.error().remedy);
    auto content = files_.mesh(*found, scale, CollideAs::exact, table.place("mesh"), table.diagnostics());
    if (!content) return table.error("mesh", content.error().what, content.error().remedy);
    if (!content->mesh) return;
    if (const auto checked = check_tissue_surface(content->mesh); !checked)
      return table.error("mesh", checked.error().what, checked.error().remedy);
    auto made = tissue_surface(*content->mesh, content->look.get());
    if (made.without_picture > 0) {
      table.diagnostics().warning(table.place("mesh"),
                                  fmt::format("{} of the mesh {} show another texture than most",
                                              number_of(made.without_picture, "triangle"), content->mesh->name),
                                  "objects have one texture: combine them in one picture");
    }
    object.surface = std::move(made.surface);
    object.look = std::move(made.look);
  }

  // How many tetrahedra the lattice will have: twelve a cube, and half a cube for each face on the surface.
  static void check_size(TableReader& top, const ObjectDescription& object, const Eigen::AlignedBox3d& box) {
    if (!object.volume.tetrahedra.empty()) return check_volume_place(top, object, box);
    double volume = 0;
    double area = 0;
    for (const auto& [a, b, c] : object.surface.triangles) {
      const Eigen::Vector3d o = object.surface.vertices[a] - box.center();
      const Eigen::Vector3d normal = (object.surface.vertices[b] - object.surface.vertices[a])
                                         .cross(object.surface.vertices[c] - object.surface.vertices[a]);
      volume += o.dot(normal) / 6.0;
      area += normal.norm() / 2.0;
    }
    const auto elements = [&](double size) {
      constexpr double kInCube = 12.0;
      return kInCube * (volume / (size * size * size) + 0.5 * area / (size * size));
    };
    if (elements(object.element_size_m) <= static_cast<double>(kMostObjectElements)) return;
    double enough = object.element_size_m;
    while (elements(enough) > static_cast<double>(kMostObjectElements)) enough *= 1.1;
    top.error("volume",
              fmt::format("elements of {:g} m make about {:.2g} tetrahedra, more than {}", object.element_size_m,
                          elements(object.element_size_m), kMostObjectElements),
              fmt::format("write element_size_m = {:.2g} or more, or check the scale of the mesh", enough));
  }

  // A surface that its tetrahedra do not hold cannot follow them.
  static void check_volume_place(TableReader& top, const ObjectDescription& object, const Eigen::AlignedBox3d& box) {
    Eigen::AlignedBox3d around;
    for (const Eigen::Vector3d& p : object.volume.nodes) around.extend(p);
    constexpr double kSlack = 0.2;  // of the size: a coarse mesh leaves parts of a fine surface outside
    const Eigen::Vector3d slack = Eigen::Vector3d::Constant(kSlack * around.sizes().norm());
    if (Eigen::AlignedBox3d(around.min() - slack, around.max() + slack).contains(box)) return;
    top.error(
        "surface", "the surface lies beside the tetrahedra of the volume",
        fmt::format("give both the same frame and unit (scale): the surface reaches from {} to {}, the "
                    "tetrahedra from {} to {}",
                    place_text(box.min()), place_text(box.max()), place_text(around.min()), place_text(around.max())));
  }

  const FileFinder& files_;
  Diagnostics& of_tetrahedra_;
  bool has_msh_ = false;
};

}  // namespace

std::optional<ObjectDescription> parse_object(std::string_view text, const std::string& file, const FileFinder& files,
                                              Diagnostics& diagnostics) {
  Diagnostics of_tetrahedra;
  ObjectReader reader(files, of_tetrahedra);
  auto object = parse_tables<ObjectDescription>(
      text, file, diagnostics, [&](TableReader& top, ObjectDescription& made) { reader.read(top, made); });
  diagnostics.take(of_tetrahedra);
  return object;
}

std::optional<ObjectDescription> read_object(const fs::path& path, const FileFinder& files, Diagnostics& diagnostics) {
  const auto text = text_of_file(path, kLargestObjectFile, path.string(), diagnostics);
  return text ? parse_object(*text, path.string(), files, diagnostics) : std::nullopt;
}

}  // namespace cellmirror
