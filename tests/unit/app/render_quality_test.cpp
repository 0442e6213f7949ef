#include "app/render/render_quality.hpp"

#include <gtest/gtest.h>

namespace cellmirror::app {
namespace {

constexpr Nanoseconds kMs{1'000'000};

void draw(RenderQuality& sut, double requested_hz, Nanoseconds smooth, Nanoseconds plain, int pictures) {
  for (int i = 0; i < pictures; ++i) {
    sut.begin_cycle(requested_hz);
    sut.drew(sut.antialiasing() ? smooth : plain);
  }
}

TEST(RenderQuality, HasTimeForOneViewAndNotForThree) {
  RenderQuality sut;
  draw(sut, 15, 50 * kMs, 15 * kMs, 100);
  EXPECT_TRUE(sut.antialiasing()) << "750 ms of drawing a second";
  draw(sut, 45, 50 * kMs, 15 * kMs, 20);
  EXPECT_FALSE(sut.antialiasing()) << "2.25 s of drawing a second";
  draw(sut, 10, 50 * kMs, 15 * kMs, 1);
  EXPECT_TRUE(sut.antialiasing()) << "two clients have gone";
}

TEST(RenderQuality, WhatDoesNotChangeCostsNothing) {
  RenderQuality sut;
  draw(sut, 45, 50 * kMs, 15 * kMs, 40);
  ASSERT_FALSE(sut.antialiasing());
  for (int i = 0; i < 60; ++i) {
    sut.unchanged();
    sut.begin_cycle(45);
  }
  EXPECT_TRUE(sut.antialiasing()) << "a cell that stands still is shown as well as can be";
}

TEST(RenderQuality, TriesAgainAfterAWhile) {
  RenderQuality sut;
  draw(sut, 20, 100 * kMs, 10 * kMs, 40);  // another program had the processor
  ASSERT_FALSE(sut.antialiasing());
  draw(sut, 20, 20 * kMs, 10 * kMs, 1000);
  EXPECT_TRUE(sut.antialiasing());
}

}  // namespace
}  // namespace cellmirror::app
