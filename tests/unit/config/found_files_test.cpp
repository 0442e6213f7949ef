// The files that a cell needs, as they are noted while it is read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "config/file_finder.hpp"
#include "tests/unit/config/mesh_text.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

class FoundFilesTest : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> places() const {
    std::vector<std::string> out;
    for (const std::filesystem::path& file : files_.found())
      out.push_back(file.lexically_relative(files_.home().root()).string());
    return out;
  }
  void read_mesh(const std::string& name) {
    const auto file = files_.find(FileUse::mesh, name);
    ASSERT_TRUE(file) << file.error().text();
    Diagnostics diagnostics;
    static_cast<void>(files_.mesh(*file, Eigen::Vector3d::Ones(), std::nullopt, {}, diagnostics));
  }

  TemporaryHome home_;
  HomeFiles files_{*KismetHome::open(home_.root())};
};

TEST_F(FoundFilesTest, EachFileIsNotedOnceAndCopiesNoteIntoTheSameList) {
  home_.write("envlib/l.obj", kLObj);
  home_.write("scripts/a.spt", "\n");
  HomeFiles copy = files_;
  ASSERT_TRUE(copy.find(FileUse::mesh, "l.obj"));
  ASSERT_TRUE(files_.find(FileUse::mesh, "l.obj"));
  ASSERT_TRUE(files_.find(FileUse::script, "a"));
  EXPECT_FALSE(files_.find(FileUse::mesh, "missing.obj"));
  EXPECT_THAT(places(), ElementsAre("envlib/l.obj", "scripts/a.spt"));
}

TEST_F(FoundFilesTest, KeysAndCertificatesAreNot) {
  home_.write("key.pem", "secret");
  ASSERT_TRUE(files_.find(FileUse::security, "key.pem"));
  EXPECT_THAT(places(), IsEmpty());
}

TEST_F(FoundFilesTest, WhatAMeshNamesIsNotedToo) {
  home_.write("envlib/part.obj", std::string("mtllib part.mtl\nusemtl red\n") + kLObj);
  home_.write("envlib/part.mtl", "newmtl red\nKd 1 0 0\n");
  read_mesh("part.obj");
  EXPECT_THAT(places(), UnorderedElementsAre("envlib/part.obj", "envlib/part.mtl"));
}

TEST_F(FoundFilesTest, SoAreTheBuffersOfAGltfBesideIt) {
  home_.write("envlib/g.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"g.bin","byteLength":4},
{"uri":"../outside.bin","byteLength":4},{"uri":"missing.bin","byteLength":4}]})");
  home_.write("envlib/g.bin", "1234");
  home_.write("outside.bin", "1234");
  read_mesh("g.gltf");
  EXPECT_THAT(places(), UnorderedElementsAre("envlib/g.gltf", "envlib/g.bin"));
}

}  // namespace
}  // namespace cellmirror
