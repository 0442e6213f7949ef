#include "rt_core/volume/transfer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace cellmirror::volume {
namespace {

constexpr ValueRange kCt{-1000, 2000};

TransferRequest request_of(VolumeTable table) {
  TransferRequest request;
  request.settings.table = table;
  request.range = kCt;
  request.hounsfield = true;
  return request;
}

double extinction(const TransferRequest& request, double value) {
  return static_cast<double>(make_transfer(request).at(value).extinction);
}

VolumeTableParameters& parameters_of(TransferRequest& request) {
  return request.settings.parameters[static_cast<std::size_t>(request.settings.table)];
}

TEST(MedicalTable, EachWeightShowsItsKindAndNoOther) {
  struct Kind {
    double MedicalTableParameters::* weight;
    double value;  // HU
  };
  constexpr std::array<Kind, 4> kKinds = {
      Kind{&MedicalTableParameters::air, -900}, Kind{&MedicalTableParameters::fat, -90},
      Kind{&MedicalTableParameters::tissue, 50}, Kind{&MedicalTableParameters::bone, 800}};
  for (const Kind& shown : kKinds) {
    double last = -1;
    for (const double weight : {0.0, 0.1, 0.3, 0.6, 1.0}) {
      TransferRequest request = request_of(VolumeTable::medical);
      request.settings.medical = {.air = 0, .fat = 0, .tissue = 0, .bone = 0};
      request.settings.medical.*shown.weight = weight;
      for (const Kind& other : kKinds) {
        const double seen = extinction(request, other.value);
        if (other.value == shown.value) {
          EXPECT_GT(seen, last) << other.value;
          EXPECT_NEAR(seen, 1000 * weight * weight * weight * weight, 1e-3);
          last = seen;
        } else {
          EXPECT_EQ(seen, 0) << other.value;
        }
      }
    }
  }
}

TEST(MedicalTable, BoneIsPaleAndFleshIsRed) {
  const TransferFunction table = make_transfer(request_of(VolumeTable::medical));
  EXPECT_GT(table.at(800).rgb[2], 0.7F);
  EXPECT_GT(table.at(50).rgb[0], table.at(50).rgb[2] + 0.3F);
}

TEST(MedicalTable, OtherUnitsAreReadByTheirRange) {
  TransferRequest request = request_of(VolumeTable::medical);
  const double bone = extinction(request, 800);
  request.hounsfield = false;
  request.range = {0, 255};
  EXPECT_NEAR(extinction(request, 255.0 * 1800 / 3000), bone, 1e-3);
}

class RampedTable : public testing::TestWithParam<VolumeTable> {
 protected:
  // Extinctions while one parameter takes these values.
  static std::vector<double> swept(VolumeTable table, double value, double VolumeTableParameters::* parameter,
                                   std::initializer_list<double> values) {
    std::vector<double> seen;
    for (const double v : values) {
      TransferRequest request = request_of(table);
      parameters_of(request).*parameter = v;
      seen.push_back(extinction(request, value));
    }
    return seen;
  }
  static void expect_strict(const std::vector<double>& seen, const std::function<bool(double, double)>& order) {
    for (std::size_t i = 1; i < seen.size(); ++i)
      EXPECT_TRUE(order(seen[i - 1], seen[i])) << testing::PrintToString(seen);
  }
};

TEST_P(RampedTable, EachParameterHasAMonotonicEffect) {
  const VolumeTable table = GetParam();
  const double below = -250;  // x = 1/4
  const double above = 1250;  // x = 3/4
  expect_strict(swept(table, above, &VolumeTableParameters::opacity, {0, 0.5, 1, 2, 3}), std::less{});
  expect_strict(swept(table, below, &VolumeTableParameters::gain, {0, 0.5, 1, 2, 3}), std::less{});
  expect_strict(swept(table, 500, &VolumeTableParameters::level, {1.2, 1.6, 2, 2.4, 2.8}), std::greater{});
  expect_strict(swept(table, above, &VolumeTableParameters::window, {0, 0.3, 0.7, 1.0}), std::less{});
  expect_strict(swept(table, below, &VolumeTableParameters::window, {0, 0.3, 0.7, 1.0}), std::greater{});
}

TEST_P(RampedTable, StrengthIsBoundedByTheEdgeOfTheVolume) {
  TransferRequest request = request_of(GetParam());
  parameters_of(request) = {.opacity = 3, .gain = 20, .level = 1, .window = 1.5};
  EXPECT_NEAR(extinction(request, 2000), 3 * 40 / request.longest_edge_m, 1e-3);
  request.longest_edge_m *= 2;
  EXPECT_NEAR(extinction(request, 2000), 3 * 40 / request.longest_edge_m, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(All, RampedTable,
                         testing::Values(VolumeTable::linear, VolumeTable::exponential, VolumeTable::rainbow,
                                         VolumeTable::user1, VolumeTable::user2));

TEST(LinearTable, IsProportionalToTheValueByDefault) {
  const TransferRequest request = request_of(VolumeTable::linear);
  const double densest = 40 / request.longest_edge_m;
  for (const double x : {0.0, 0.25, 0.5, 1.0}) EXPECT_NEAR(extinction(request, -1000 + 3000 * x), densest * x, 0.03);
}

TEST(RainbowTable, RunsFromBlueToRed) {
  const TransferFunction table = make_transfer(request_of(VolumeTable::rainbow));
  EXPECT_THAT(table.entries.front().rgb, testing::Pointwise(testing::FloatNear(1e-6F), {0.0F, 0.0F, 1.0F}));
  EXPECT_THAT(table.entries.back().rgb, testing::Pointwise(testing::FloatNear(1e-6F), {1.0F, 0.0F, 0.0F}));
  EXPECT_GT(table.at(500).rgb[1], 0.99F);
}

TEST(UserTables, RowsAreInterpolatedAndMissingOnesHaveABuiltInTable) {
  TransferRequest request = request_of(VolumeTable::user1);
  EXPECT_EQ(extinction(request, 700), extinction(request_of(VolumeTable::linear), 700));
  VolumeUserTable rows;
  rows.rows = {{0, {1, 0, 0}, 0}, {1000, {0, 0, 1}, 1}};
  request.user[0] = std::make_shared<const VolumeUserTable>(rows);
  const TransferFunction table = make_transfer(request);
  EXPECT_EQ(table.at(-500).extinction, 0);
  EXPECT_NEAR(table.at(250).extinction, 25, 0.05);
  EXPECT_NEAR(table.at(250).rgb[0], 0.75, 1e-3);
  EXPECT_EQ(table.at(1500).rgb[2], 1);
  request.settings.table = VolumeTable::user2;
  EXPECT_EQ(extinction(request, 700), extinction(request_of(VolumeTable::rainbow), 700));
}

TEST(Tables, NumbersOutOfRangeAreBroughtIntoIt) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t t = 0; t < kVolumeTables; ++t) {
    TransferRequest request = request_of(static_cast<VolumeTable>(t));
    parameters_of(request) = {.opacity = kNan, .gain = 1e30, .level = -5, .window = kNan};
    request.settings.medical = {.air = kNan, .fat = 7, .tissue = -1, .bone = 1e300};
    request.range = {kNan, 3};
    request.longest_edge_m = 0;
    for (const Appearance& look : make_transfer(request).entries) {
      EXPECT_TRUE(std::isfinite(look.extinction) && look.extinction >= 0);
      for (const float part : look.rgb) EXPECT_TRUE(part >= 0 && part <= 1.001F);
    }
  }
}

}  // namespace
}  // namespace cellmirror::volume
