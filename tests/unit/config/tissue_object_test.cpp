// Deformable objects (.mpo); what else is refused of their text stands in tests/golden/config/bad/tissue_object.
#include "config/tissue_object.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "config/clip_file.hpp"
#include "config/tissue_crossings.hpp"
#include "config/tissue_surface.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"
#include "tests/unit/config/picture_bytes.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

// Boxes with edges along the axes, each with vertices of its own, one after the other.
std::string box_obj(const std::vector<Eigen::AlignedBox3d>& boxes, bool inside_out = false) {
  static constexpr std::array<std::array<int, 4>, 6> kFaces{
      {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}}};
  std::string text;
  for (const auto& box : boxes) {
    for (int i = 0; i < 8; ++i) {
      text += "v";
      for (int k = 0; k < 3; ++k)
        text +=
            " " + std::to_string(((static_cast<unsigned>(i) >> static_cast<unsigned>(k)) & 1U) != 0U ? box.max()[k]
                                                                                                     : box.min()[k]);
      text += "\n";
    }
  }
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    for (auto face : kFaces) {
      if (inside_out) std::ranges::reverse(face);
      text += "f";
      for (const int vertex : face) text += " " + std::to_string(vertex + static_cast<int>(8 * b));
      text += "\n";
    }
  }
  return text;
}

Eigen::AlignedBox3d box(double x, double y, double z, double size) {
  return {Eigen::Vector3d(x, y, z), Eigen::Vector3d(x + size, y + size, z + size)};
}

double enclosed(const tissue::SurfaceMesh& surface) {
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles)
    volume += surface.vertices[a].dot(surface.vertices[b].cross(surface.vertices[c])) / 6.0;
  return volume;
}

const char* const kTetraMsh =
    "$NOD\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n$ELM\n1\n1 4 1 1 4 1 2 3 4\n$ENDELM\n";

struct TissueObject : testing::Test {
  TissueObject() : files(KismetHome::open(home.root()).value()) {
    home.write("envlib/cube.obj", box_obj({box(0, 0, 0, 0.1)}));
    home.write("envlib/tetra.msh", kTetraMsh);
  }
  std::optional<tissue::ObjectDescription> read(const std::string& text) {
    diagnostics = {};
    return read_object(home.write("envlib/liver.mpo", "format = 1\n" + text), files, diagnostics);
  }
  std::string refusal(const std::string& text) {
    EXPECT_FALSE(read(text));
    return diagnostics.text();
  }
  TemporaryHome home;
  HomeFiles files;
  Diagnostics diagnostics;
};

const std::string kCube = "[surface]\nmesh = \"cube.obj\"\n";

TEST_F(TissueObject, NeedsASurfaceAndNothingElse) {
  const auto sut = read(kCube);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.text();
  EXPECT_EQ(sut->name, "liver.mpo");
  EXPECT_EQ(sut->surface.vertices.size(), 8U);
  EXPECT_EQ(sut->surface.triangles.size(), 12U);
  EXPECT_NEAR(enclosed(sut->surface), 0.001, 1e-9);
  EXPECT_TRUE(sut->surface.texture.empty());
  EXPECT_TRUE(sut->surface.same_as.empty());
  EXPECT_TRUE(sut->volume.tetrahedra.empty());
  EXPECT_EQ(sut->element_size_m, tissue::ObjectDescription().element_size_m);
  EXPECT_EQ(sut->attributes, kDefaultTissueAttributes);
  EXPECT_EQ(sut->material.youngs_modulus_pa, tissue::Material().youngs_modulus_pa);
  EXPECT_TRUE(sut->regions.empty() && sut->fixed.empty() && sut->vessels.empty() && sut->pools.empty());
  EXPECT_EQ(sut->look, nullptr);
  EXPECT_TRUE(sut->X_WO.isApprox(Pose::Identity()));
}

TEST_F(TissueObject, TakesEveryKey) {
  const auto sut = read(R"(
description = "of a test"
rgba = [0.1, 0.2, 0.3, 0.4]
[surface]
mesh = "cube.obj"
scale = [2, 2, 2]
[volume]
element_size_m = 0.02
most_substeps = 2
[material]
youngs_modulus_pa = 3000
poissons_ratio = 0.4
density_kg_m3 = 1060
damping_s = 2e-4
drag_1_s = 3
yield_strain = 0.5
tear_strain = 0.8
[attributes]
on = ["GRAVITY", "TEAR"]
off = ["WET"]
[[region]]
name = "hilum"
a_m = [0, 0, 0]
b_m = [0.1, 0, 0]
radius_m = 0.01
youngs_modulus_pa = 9000
rgb = [1, 0.5, 0]
[[region]]
a_m = [0.2, 0.2, 0.2]
radius_m = 0.02
[[fixed]]
low_m = [0, 0, 0]
high_m = [0.2, 0.2, 0.01]
[[fixed]]
center_m = [0.1, 0.1, 0.2]
radius_m = 0.03
[[vessel]]
name = "cystic_artery"
kind = "artery"
radius_m = 0.001
points_m = [[0.01, 0.1, 0.1], [0.1, 0.1, 0.1], [0.19, 0.1, 0.1]]
[[vessel]]
name = "cystic_duct"
kind = "duct"
points_m = [[0.1, 0.01, 0.1], [0.1, 0.19, 0.1]]
[pool]
size_m = [0.3, 0.2]
level_m = -0.01
max_level_m = 0.05
rgba = [0, 0, 1, 0.5]
)");
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.text();
  EXPECT_NEAR(enclosed(sut->surface), 0.008, 1e-8);
  EXPECT_EQ(sut->rgba, (std::array<float, 4>{0.1F, 0.2F, 0.3F, 0.4F}));
  EXPECT_EQ(sut->element_size_m, 0.02);
  EXPECT_EQ(sut->most_substeps, 2);
  EXPECT_EQ(sut->material.youngs_modulus_pa, 3000);
  EXPECT_EQ(sut->material.poissons_ratio, 0.4);
  EXPECT_EQ(sut->material.density_kg_m3, 1060);
  EXPECT_EQ(sut->material.damping_s, 2e-4);
  EXPECT_EQ(sut->material.drag_1_s, 3);
  EXPECT_EQ(sut->material.yield_strain, 0.5);
  EXPECT_EQ(sut->material.tear_strain, 0.8);
  EXPECT_TRUE(has(sut->attributes, TissueAttribute::gravity) && has(sut->attributes, TissueAttribute::tear));
  EXPECT_FALSE(has(sut->attributes, TissueAttribute::wet));
  ASSERT_EQ(sut->regions.size(), 2U);
  EXPECT_EQ(sut->regions[0].name, "hilum");
  EXPECT_EQ(sut->regions[0].b, Eigen::Vector3d(0.1, 0, 0));
  EXPECT_EQ(sut->regions[0].radius_m, 0.01);
  EXPECT_EQ(sut->regions[0].material.youngs_modulus_pa, 9000);
  EXPECT_EQ(sut->regions[0].material.poissons_ratio, 0.4) << "as the object's";
  EXPECT_TRUE(sut->regions[0].has_colour);
  EXPECT_EQ(sut->regions[0].rgb, (std::array<float, 3>{1, 0.5, 0}));
  EXPECT_EQ(sut->regions[1].a, sut->regions[1].b) << "a sphere";
  EXPECT_FALSE(sut->regions[1].has_colour);
  ASSERT_EQ(sut->fixed.size(), 2U);
  EXPECT_EQ(sut->fixed[0].high, Eigen::Vector3d(0.2, 0.2, 0.01));
  EXPECT_EQ(sut->fixed[0].radius_m, 0);
  EXPECT_EQ(sut->fixed[1].low, Eigen::Vector3d(0.1, 0.1, 0.2));
  EXPECT_EQ(sut->fixed[1].radius_m, 0.03);
  ASSERT_EQ(sut->vessels.size(), 2U);
  EXPECT_EQ(sut->vessels[0].name, "cystic_artery");
  EXPECT_EQ(sut->vessels[0].kind, tissue::VesselKind::artery);
  EXPECT_EQ(sut->vessels[0].radius_m, 0.001);
  EXPECT_EQ(sut->vessels[0].centre_line.size(), 3U);
  EXPECT_EQ(sut->vessels[0].centre_line[1], Eigen::Vector3d(0.1, 0.1, 0.1));
  EXPECT_EQ(sut->vessels[1].kind, tissue::VesselKind::duct);
  ASSERT_EQ(sut->pools.size(), 1U);
  EXPECT_EQ(sut->pools[0].size_m, Eigen::Vector2d(0.3, 0.2));
  EXPECT_EQ(sut->pools[0].level_m, -0.01);
  EXPECT_EQ(sut->pools[0].max_level_m, 0.05);
  EXPECT_EQ(sut->pools[0].rgba[2], 1.0F);
}

TEST_F(TissueObject, TakesTetrahedraOfAFileAndTheirSurface) {
  const auto sut = read("[volume]\nmsh = \"tetra.msh\"\nscale = 0.1\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(sut->volume.nodes.size(), 4U);
  EXPECT_EQ(sut->volume.tetrahedra.size(), 1U);
  EXPECT_EQ(sut->surface.triangles.size(), 4U);
  EXPECT_NEAR(enclosed(sut->surface), 0.001 / 6, 1e-12);
}

TEST_F(TissueObject, TakesASurfaceWithTetrahedraIfBothAreInOnePlace) {
  EXPECT_TRUE(read(kCube + "[volume]\nmsh = \"tetra.msh\"\nscale = 0.12\n")) << diagnostics.text();
  EXPECT_NE(refusal(kCube + "[volume]\nmsh = \"tetra.msh\"\nscale = 0.001\n")
                .find("liver.mpo:2:1: error: the surface lies beside the tetrahedra of the volume; give both the same "
                      "frame and unit (scale): the surface reaches from [0, 0, 0] m to [0.1, 0.1, 0.1] m"),
            std::string::npos)
      << diagnostics.text();
}

TEST_F(TissueObject, IsRefusedWithoutASurface) {
  EXPECT_NE(refusal("").find("the object has no surface; give [surface] mesh"), std::string::npos);
}

TEST_F(TissueObject, SaysWhatIsWrongWithTetrahedraOfAFileAndWhere) {
  home.write("envlib/bad.msh", std::string(kTetraMsh).replace(std::string(kTetraMsh).find("2 1 0 0"), 7, "2 x 0 0"));
  const std::string text = refusal("[volume]\nmsh = \"bad.msh\"\n");
  EXPECT_NE(text.find("liver.mpo:3:7: error: [volume]: bad.msh is refused; cellmirror check "), std::string::npos)
      << text;
  EXPECT_NE(text.find("bad.msh:4:3: error: \"x\" is not a number"), std::string::npos) << text;
  EXPECT_NE(refusal("[volume]\nmsh = \"cube.obj\"\n").find("cube.obj is no .msh file"), std::string::npos);
}

TEST_F(TissueObject, IsRefusedWithAnOpenSurface) {
  std::string open = box_obj({box(0, 0, 0, 0.1)});
  home.write("envlib/cube.obj", open.erase(open.rfind("f ")));
  EXPECT_NE(refusal(kCube).find("the mesh cube.obj is no surface of an object: 4 edges belong to one triangle only, "
                                "near [0.1, "),
            std::string::npos)
      << diagnostics.text();
}

TEST_F(TissueObject, TurnsASurfaceThatIsInsideOutAndSaysSo) {
  home.write("envlib/cube.obj", box_obj({box(0, 0, 0, 0.1)}, true));
  const auto sut = read(kCube);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_NEAR(enclosed(sut->surface), 0.001, 1e-9);
  EXPECT_NE(diagnostics.text().find("note: the mesh cube.obj: 1 shell was inside out"), std::string::npos)
      << diagnostics.text();
}

TEST_F(TissueObject, IsRefusedWithASurfaceThatCrossesItself) {
  home.write("envlib/cube.obj", box_obj({box(0, 0, 0, 0.1), box(0.05, 0.04, 0.03, 0.1)}));
  const std::string text = refusal(kCube);
  EXPECT_NE(text.find("liver.mpo:3:8: error: [surface]: the mesh cube.obj is no surface of an object: it crosses "
                      "itself, "),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("unite its parts or separate them"), std::string::npos) << text;
}

TEST_F(TissueObject, IsRefusedWithoutVolumeOrOfAnImpossibleSize) {
  home.write("envlib/cube.obj", box_obj({box(0, 0, 0, 100)}));
  EXPECT_NE(refusal(kCube).find("it is 100 m long, but 0.0001 to 10 m are possible; give the scale"), std::string::npos)
      << diagnostics.text();
  home.write("envlib/cube.obj", box_obj({{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(5, 5, 1e-6)}}));
  EXPECT_NE(refusal(kCube).find("its volume is "), std::string::npos) << diagnostics.text();
}

TEST_F(TissueObject, IsRefusedWithTetrahedraOfAnImpossibleSize) {
  for (const char* scale : {"1e-5", "100"}) {
    EXPECT_NE(refusal(std::string("[volume]\nmsh = \"tetra.msh\"\nscale = ") + scale + "\n")
                  .find("the object has an impossible size: it is "),
              std::string::npos)
        << diagnostics.text();
  }
}

TEST_F(TissueObject, IsRefusedWithTooManyElementsAndSaysHowManyFit) {
  const std::string text = refusal(kCube + "[volume]\nelement_size_m = 0.001\n");
  EXPECT_NE(text.find("elements of 0.001 m make about 1.2e+07 tetrahedra, more than 100000; write element_size_m = "),
            std::string::npos)
      << text;
  const std::size_t at = text.find("element_size_m = ") + 17;
  EXPECT_TRUE(read(kCube + "[volume]\nelement_size_m = " + text.substr(at, text.find(' ', at) - at) + "\n"))
      << diagnostics.text();
}

TEST_F(TissueObject, IsRefusedWithPartsBesideIt) {
  const std::string text = refusal(kCube +
                                   "[[region]]\na_m = [0.3, 0, 0]\nradius_m = 0.05\n"
                                   "[[fixed]]\ncenter_m = [0, 0, -0.2]\nradius_m = 0.1\n"
                                   "[[fixed]]\nlow_m = [1, 1, 1]\nhigh_m = [2, 2, 2]\n"
                                   "[[vessel]]\nname = \"a\"\nkind = \"vein\"\npoints_m = [[0, 0, 0], [0, 0, 5]]\n");
  for (const char* words : {"region 1 lies beside", "fixed zone 1 lies beside", "fixed zone 2 lies beside",
                            "point 2 of vessel a lies beside the object; the surface reaches from [0, 0, 0] m to"})
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
}

TEST_F(TissueObject, IsRefusedWithTooManyParts) {
  std::string many;
  for (std::size_t i = 0; i <= kMostObjectParts; ++i) many += "[[fixed]]\ncenter_m = [0, 0, 0]\nradius_m = 0.01\n";
  EXPECT_NE(refusal(kCube + many).find("there are 65 tables fixed, more than 64"), std::string::npos)
      << diagnostics.text();
}

TEST_F(TissueObject, WarnsOfAttributesThatCannotShow) {
  ASSERT_TRUE(read(kCube + "[attributes]\non = [\"TEAR\", \"PLASTIC\"]\n")) << diagnostics.text();
  EXPECT_EQ(diagnostics.warnings(), 2U) << diagnostics.text();
  ASSERT_TRUE(read(kCube + "[attributes]\non = [\"TEAR\"]\n[[region]]\na_m = [0, 0, 0]\nradius_m = 0.1\n"
                           "tear_strain = 0.5\n"))
      << diagnostics.text();
  EXPECT_EQ(diagnostics.warnings(), 0U) << diagnostics.text();
}

TEST_F(TissueObject, DividesVerticesAtTheSeamsOfItsTexture) {
  std::string text = "mtllib cube.mtl\n" + box_obj({box(0, 0, 0, 0.1)});
  const std::size_t faces = text.find("\nf ") + 1;
  std::string textured = text.substr(0, faces) + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl skin\n";
  std::istringstream rows(text.substr(faces));
  for (std::string f, a, b, c, d; rows >> f >> a >> b >> c >> d;)
    textured += "f " + a + "/1 " + b + "/2 " + c + "/3 " + d + "/4\n";
  home.write("envlib/cube.obj", textured);
  home.write("envlib/cube.mtl", "newmtl skin\nmap_Kd skin.png\n");
  home.write("envlib/skin.png", four_pixels());
  const auto sut = read(kCube);
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.text();
  ASSERT_NE(sut->look, nullptr);
  ASSERT_EQ(sut->look->palette.size(), 1U);
  EXPECT_NE(sut->look->palette[0].picture, nullptr);
  const tissue::SurfaceMesh& surface = sut->surface;
  EXPECT_GT(surface.vertices.size(), 8U);
  EXPECT_LE(surface.vertices.size(), 24U);
  ASSERT_EQ(surface.texture.size(), surface.vertices.size());
  ASSERT_EQ(surface.same_as.size(), surface.vertices.size());
  std::set<std::uint32_t> places;
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    EXPECT_LE(surface.same_as[i], i);
    EXPECT_EQ(surface.vertices[surface.same_as[i]], surface.vertices[i]);
    places.insert(surface.same_as[i]);
  }
  EXPECT_EQ(places.size(), 8U);
  EXPECT_NEAR(enclosed(surface), 0.001, 1e-9);
}

TEST_F(TissueObject, GivesTheShapeOfAClip) {
  home.write("envlib/cube.obj", box_obj({{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.003, 0.002, 0.009)}}));
  ASSERT_TRUE(read(kCube)) << diagnostics.text();
  const auto sut = load_clip(files.home(), "liver.mpo");
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->name, "liver.mpo");
  EXPECT_EQ(sut->shape.triangles.size(), 12U);
  EXPECT_NEAR(sut->length_m, 0.009, 1e-9);
  EXPECT_NEAR(sut->width_m, 0.003, 1e-9);
  EXPECT_TRUE(load_clip(files.home(), "liver"));
  const auto missing = load_clip(files.home(), "livre.mpo");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().text().find("did you mean liver.mpo?"), std::string::npos) << missing.error().text();
  home.write("envlib/bad.mpo", "format = 1\nrgba = 1\nsurface = 2\nvolume = 3\n");
  const auto bad = load_clip(files.home(), "bad.mpo");
  ASSERT_FALSE(bad);
  EXPECT_NE(bad.error().text().find("bad.mpo:2:8: error: rgba must be"), std::string::npos) << bad.error().text();
  EXPECT_NE(bad.error().text().find("(and 2 more)"), std::string::npos) << bad.error().text();
}

std::shared_ptr<const geometry::TriangleMesh> mesh_of(const std::vector<Eigen::AlignedBox3d>& boxes) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<geometry::TriangleIndices> triangles;
  std::istringstream rows(box_obj(boxes));
  for (std::string kind; rows >> kind;) {
    std::array<double, 3> p{};
    std::array<std::uint32_t, 4> f{};
    if (kind == "v") {
      rows >> p[0] >> p[1] >> p[2];
      vertices.emplace_back(p[0], p[1], p[2]);
    } else {
      rows >> f[0] >> f[1] >> f[2] >> f[3];
      triangles.push_back({f[0] - 1, f[1] - 1, f[2] - 1});
      triangles.push_back({f[0] - 1, f[2] - 1, f[3] - 1});
    }
  }
  geometry::MeshFindings findings;
  return std::make_shared<const geometry::TriangleMesh>(
      geometry::make_mesh("boxes", std::move(vertices), std::move(triangles), findings).value());
}

TEST(SelfCrossings, AreFoundWhereSurfacesPassThroughEachOther) {
  EXPECT_EQ(find_self_crossings(mesh_of({box(0, 0, 0, 1)})).pairs, 0U);
  EXPECT_EQ(find_self_crossings(mesh_of({box(0, 0, 0, 1), box(2, 0, 0, 1)})).pairs, 0U) << "beside each other";
  EXPECT_EQ(find_self_crossings(mesh_of({box(0, 0, 0, 1), box(0.2, 0.2, 0.2, 0.5)})).pairs, 0U) << "a cavity";
  EXPECT_GT(find_self_crossings(mesh_of({box(0, 0, 0, 1), box(1, 0.3, 0.2, 0.5)})).pairs, 0U) << "flush";
  const auto crossing = find_self_crossings(mesh_of({box(0, 0, 0, 1), box(0.9, 0.2, 0.2, 0.5)}));
  EXPECT_GT(crossing.pairs, 0U);
  EXPECT_TRUE(crossing.complete);
  EXPECT_NEAR(crossing.place.x(), 1, 1e-9);
  // Aligned edges and diagonals.
  EXPECT_GT(find_self_crossings(mesh_of({box(0, 0, 0, 1), box(0.5, 0.5, 0.5, 1)})).pairs, 0U);
}

}  // namespace
}  // namespace cellmirror
