#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "rt_core/rt/ring.hpp"

namespace cellmirror {
namespace {

TEST(Ring, IsEmptyAtFirst) {
  const Ring<int, 4> sut;
  EXPECT_TRUE(sut.newest().empty());
  EXPECT_EQ(sut.written(), 0U);
}

TEST(Ring, GivesFewerEntriesThanAskedForWhileFilling) {
  Ring<int, 4> sut;
  sut.push(1);
  sut.push(2);
  EXPECT_EQ(sut.newest(), (std::vector<int>{1, 2}));
}

TEST(Ring, KeepsTheNewestOldestFirst) {
  Ring<int, 4> sut;
  for (int i = 1; i <= 10; ++i) {
    sut.push(i);
  }
  EXPECT_EQ(sut.newest(), (std::vector<int>{7, 8, 9, 10}));
  EXPECT_EQ(sut.newest(2), (std::vector<int>{9, 10}));
  EXPECT_EQ(sut.newest(0), (std::vector<int>{}));
  EXPECT_EQ(sut.newest(100), (std::vector<int>{7, 8, 9, 10}));
  EXPECT_EQ(sut.written(), 10U);
  EXPECT_EQ(sut.torn(), 0U);
}

TEST(Ring, CopiesIntoMemoryOfTheCaller) {
  Ring<int, 4> sut;
  sut.push(5);
  sut.push(6);
  std::array<int, 3> out{};
  EXPECT_EQ(sut.newest(std::span<int>(out)), 2U);
  EXPECT_EQ(out, (std::array<int, 3>{5, 6, 0}));
}

// Sizes around the 64-bit words in which entries travel.
template <class T>
class RingOfSize : public testing::Test {};
template <std::size_t N>
struct Bytes {
  std::array<unsigned char, N> bytes;
};
using Sizes = testing::Types<Bytes<1>, Bytes<7>, Bytes<8>, Bytes<9>, Bytes<63>, Bytes<64>, Bytes<1000>>;
TYPED_TEST_SUITE(RingOfSize, Sizes);

TYPED_TEST(RingOfSize, EveryByteArrives) {
  Ring<TypeParam, 2> sut;
  TypeParam in{};
  for (std::size_t i = 0; i < in.bytes.size(); ++i) {
    in.bytes[i] = static_cast<unsigned char>(i * 7 + 1);
  }
  sut.push(in);
  const auto out = sut.newest();
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].bytes, in.bytes);
}

}  // namespace
}  // namespace cellmirror
