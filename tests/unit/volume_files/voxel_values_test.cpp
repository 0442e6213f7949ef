#include "config/volume/voxel_values.hpp"

#include <gtest/gtest.h>

#include "tests/unit/config/temporary_home.hpp"
#include "tests/unit/volume_files/volume_text.hpp"

namespace cellmirror {
namespace {

class VoxelsOfType : public testing::Test {
 protected:
  template <class T>
  Result<VoxelValues> read(const std::vector<T>& values, VoxelType type, bool big_endian = false) {
    VoxelSource source;
    source.files = {home_.write("envlib/a.raw", bytes_of(values, big_endian))};
    return read_voxels(source, {{2, 2, 2}, type, big_endian, false});
  }
  TemporaryHome home_;
};

TEST_F(VoxelsOfType, KeepEightAndSixteenBits) {
  const auto bytes = read<std::uint8_t>({0, 1, 2, 3, 4, 5, 6, 255}, VoxelType::u8);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(bytes->values).back(), 255);
  const auto words = read<std::int16_t>({-32768, 1, 2, 3, 4, 5, 6, 32767}, VoxelType::s16, true);
  ASSERT_TRUE(words);
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(words->values).front(), -32768);
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(words->values)[1], 1);
  const auto small = read<std::int8_t>({-128, 1, 2, 3, 4, 5, 6, 127}, VoxelType::s8);
  ASSERT_TRUE(small);
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(small->values).front(), -128);
}

TEST_F(VoxelsOfType, KeepIntegersThatFitIntoSixteenBits) {
  const auto sut = read<std::int32_t>({-1024, 0, 3071, 1, 2, 3, 4, 5}, VoxelType::s32, true);
  ASSERT_TRUE(sut);
  EXPECT_FALSE(sut->rounded);
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(sut->values)[2], 3071);
  const auto far = read<double>({100000, 100001, 165535, 100000, 100000, 100000, 100000, 100000}, VoxelType::f64);
  ASSERT_TRUE(far);
  EXPECT_FALSE(far->rounded);
  EXPECT_EQ(far->intercept, 100000);
  EXPECT_EQ(std::get<std::vector<std::uint16_t>>(far->values)[2], 65535);
}

TEST_F(VoxelsOfType, RoundWiderRangesByHalfAStepAtMost) {
  const std::vector<float> values{-1.5F, 0.25F, 1000.75F, 3.14159F, 500.0F, 20.0F, 999.0F, -1.0F};
  const auto sut = read(values, VoxelType::f32);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->rounded);
  const auto& stored = std::get<std::vector<std::uint16_t>>(sut->values);
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(sut->slope * stored[i] + sut->intercept, values[i], 0.5001 * sut->slope);
}

TEST_F(VoxelsOfType, AreNotCalledExactWhereDoublesAreNot) {
  constexpr std::int64_t kFar = std::int64_t{1} << 60;
  const auto sut = read<std::int64_t>({kFar, kFar + 1, kFar + 40000, kFar, kFar, kFar, kFar, kFar}, VoxelType::s64);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->rounded);
}

TEST_F(VoxelsOfType, MayAllBeTheSame) {
  const auto sut = read(std::vector<float>(8, 0.5F), VoxelType::f32);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->slope * std::get<std::vector<std::uint16_t>>(sut->values)[3] + sut->intercept, 0.5);
}

TEST_F(VoxelsOfType, AreRefusedWhereTheyAreInfinite) {
  const auto sut = read(std::vector<double>(8, std::numeric_limits<double>::infinity()), VoxelType::f64);
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().what.find("the voxel (0, 0, 0) is inf"), std::string::npos) << sut.error().what;
}

}  // namespace
}  // namespace cellmirror
