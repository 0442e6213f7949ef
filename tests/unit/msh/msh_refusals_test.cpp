// What is refused of .msh files, and with which words.
#include <gtest/gtest.h>

#include "config/msh/msh_file.hpp"
#include "tests/unit/msh/msh_text.hpp"

namespace cellmirror::msh {
namespace {

std::string refusal(const std::string& bytes) {
  Diagnostics diagnostics;
  EXPECT_FALSE(parse_msh(bytes, "a.msh", 1, diagnostics));
  EXPECT_FALSE(diagnostics.ok());
  return diagnostics.text();
}

#define EXPECT_REFUSED(bytes, words) EXPECT_NE(refusal(bytes).find(words), std::string::npos) << refusal(bytes)

TEST(MshRefusals, NameLineAndColumn) {
  EXPECT_EQ(refusal(with(msh2(), "3 0 1 0", "3 0 l 0")),
            "a.msh:12:5: error: \"l\" is not a number, but a coordinate is expected\n");
  EXPECT_EQ(refusal(with(msh1(), "4 4 9 1 4 2 3 4 5", "4 4 9 1 4 2 3 4 6")),
            "a.msh:14:1: error: tetrahedron 4 names node 6, which does not exist; export the mesh again\n");
}

TEST(MshRefusals, NameTheByteInBinaryFiles) {
  std::string cut = msh4_binary();
  cut.resize(cut.find("$Elements") + 60);
  const std::string text = refusal(cut);
  EXPECT_NE(text.find("at byte "), std::string::npos) << text;
}

TEST(MshRefusals, OtherFormatsAndKinds) {
  EXPECT_REFUSED(with(msh4(), "4.1", "4"), "a.msh:2:1: error: format 4 is not read; save it as format 4.1, 2.2 or 1");
  EXPECT_REFUSED(with(msh4(), "4.1", "3"), "format 3 is not read");
  EXPECT_REFUSED("solid tetra\n", "a section is expected, but \"solid\" is found");
  EXPECT_REFUSED("", "the file has no nodes");
  EXPECT_REFUSED(with(msh2(), "2.2 0 8", "2.2 2 8"), "the kind of file is 2");
  EXPECT_REFUSED(msh2() + "$Nodes\n0\n$EndNodes\n", "the section appears twice");
  EXPECT_REFUSED(std::string(kNodes2), "stands before $MeshFormat");
  EXPECT_REFUSED("$Mine\n", "the section $Mine has no end");
}

TEST(MshRefusals, TetrahedraOfSecondOrderWithARemedy) {
  EXPECT_REFUSED(with(msh2(), "3 4 2 9 1 1 2 3 4", "3 11 2 9 1 1 2 3 4 5 1 2 3 4 5"),
                 "a.msh:20:1: error: the tetrahedra are of order 2 (elements of kind 11); only linear ones are read: "
                 "gmsh -3 -order 1");
  EXPECT_REFUSED(with(msh2(), "3 4 2 9 1", "3 77 2 9 1"), "elements of kind 77 are unknown");
}

TEST(MshRefusals, IdsThatAppearTwice) {
  EXPECT_REFUSED(with(msh2(), "5 1 1 1", "4 1 1 1"), "the id 4 belongs to two nodes");
  EXPECT_REFUSED(with(msh2(), "4 4 2 9", "3 4 2 9"), "the id 3 belongs to two elements");
  EXPECT_REFUSED(with(msh2(), "2 3 4 5\n", "4 3 2 1\n"), "tetrahedron 4 has the same nodes as another one");
}

TEST(MshRefusals, CoordinatesThatAreNotFiniteOrTooLarge) {
  EXPECT_REFUSED(with(msh2(), "5 1 1 1", "5 nan 1 1"), "a coordinate of node 5 is not a finite number");
  EXPECT_REFUSED(with(msh2(), "5 1 1 1", "5 1 -inf 1"), "a coordinate of node 5 is not a finite number");
  EXPECT_REFUSED(with(msh2(), "5 1 1 1", "5 1 1e999 1"), "a coordinate of node 5 is not a finite number");
  EXPECT_REFUSED(with(msh2(), "5 1 1 1", "5 1e7 1 1"), "node 5 is 1e+07 m away from the origin");
}

TEST(MshRefusals, TetrahedraWithoutVolume) {
  EXPECT_REFUSED(with(msh2(), "2 3 4 5\n", "2 3 4 4\n"), "tetrahedron 4 has no volume");
  EXPECT_REFUSED(with(msh2(), "4 0 0 1", "4 1 1 0"), "tetrahedron 3 has no volume");
}

TEST(MshRefusals, CountsBeyondTheFileOrTheLimit) {
  EXPECT_REFUSED(with(msh2(), "$Nodes\n5", "$Nodes\n1999999"), "more than the rest of the file can hold");
  EXPECT_REFUSED(with(msh2(), "$Nodes\n5", "$Nodes\n2000001"), "there are 2000001 nodes, more than 2000000");
  EXPECT_REFUSED(with(msh2(), "$Elements\n4", "$Elements\n-4"), "the number of elements is -4");
  EXPECT_REFUSED(with(msh2(), "$Elements\n4", "$Elements\n9000000000000000000"), "more than 2000000");
  EXPECT_REFUSED(with(msh2(), "$Elements\n4", "$Elements\n3"), "$EndElements is expected, but \"4\" is found");
  EXPECT_REFUSED(with(msh2(), "$Elements\n4", "$Elements\n5"), "is not an integer");
  EXPECT_REFUSED(with(msh4(), "3 1 4 2\n", "3 1 4 9\n"), "the blocks have more elements than are announced");
  EXPECT_REFUSED(with(msh4(), "3 4 1 4\n", "3 5 1 4\n"), "the blocks have 4 elements, but 5 are announced");
}

TEST(MshRefusals, MeshesWithoutTetrahedra) {
  EXPECT_REFUSED(msh2_of(kNodes2, "$Elements\n1\n2 2 2 7 1 1 2 3\n$EndElements\n"), "the file has no tetrahedra");
  EXPECT_REFUSED(msh2_of(kNodes2, ""), "the file has no elements");
}

TEST(MshRefusals, FacesOfThreeTetrahedra) {
  EXPECT_REFUSED(msh2_of("$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 2\n6 0 0 -1\n$EndNodes\n",
                         "$Elements\n3\n1 4 0 1 2 3 4\n2 4 0 1 2 3 5\n3 4 0 1 2 3 6\n$EndElements\n"),
                 "belongs to 3 tetrahedra");
}

TEST(MshRefusals, NeighboursThatOverlap) {
  EXPECT_REFUSED(with(msh2(), "1 0 0 0", "1 2 2 2"),
                 "two tetrahedra with a common face near [1, 0, 0] m overlap; remesh the volume");
}

TEST(MshRefusals, TellTheFirstTenAndCountTheOthers) {
  std::string elements = "$Elements\n30\n";
  for (int i = 1; i <= 30; ++i) elements += std::to_string(i) + " 4 0 1 2 3 99\n";
  const std::string text = refusal(msh2_of(kNodes2, elements + "$EndElements\n"));
  EXPECT_NE(text.find("20 more tetrahedra have unknown nodes"), std::string::npos) << text;
}

}  // namespace
}  // namespace cellmirror::msh
