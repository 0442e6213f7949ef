#include "rt_core/base/diagnostics.hpp"

#include <gtest/gtest.h>

namespace cellmirror {
namespace {

TEST(Diagnostics, TextNamesThePlaceAsFarAsItIsKnown) {
  EXPECT_EQ((Diagnostic{Severity::error, {"f.spt", 3, 7}, "wrong", "mend it"}).text(),
            "f.spt:3:7: error: wrong; mend it");
  EXPECT_EQ((Diagnostic{Severity::warning, {"f.spt", 3, 0}, "odd", ""}).text(), "f.spt:3: warning: odd");
  EXPECT_EQ((Diagnostic{Severity::note, {"", 0, 0}, "so", ""}).text(), "input: note: so");
}

TEST(Diagnostics, KeepsABoundedNumberAndCountsTheRest) {
  Diagnostics sut;
  for (std::size_t i = 0; i < Diagnostics::kKept + 7; ++i) sut.error({"f", 1, 1}, "wrong");
  EXPECT_EQ(sut.all().size(), Diagnostics::kKept);
  EXPECT_EQ(sut.errors(), Diagnostics::kKept + 7);
  EXPECT_NE(sut.text().find("... and 7 more"), std::string::npos);
}

TEST(Diagnostics, AnErrorBehindManyWarningsIsKept) {
  Diagnostics sut;
  for (std::size_t i = 0; i < Diagnostics::kKept + 7; ++i) sut.warning({"f", 1, 1}, "odd");
  sut.error({"f", 9, 1}, "wrong");
  EXPECT_EQ(sut.all().size(), Diagnostics::kKept);
  EXPECT_EQ(sut.text(Severity::error).substr(0, 18), "f:9:1: error: wron");
  EXPECT_EQ(sut.warnings(), Diagnostics::kKept + 7);
}

TEST(Diagnostics, TakesOverWhatAnotherPassFoundWithItsCounts) {
  Diagnostics other;
  for (std::size_t i = 0; i < Diagnostics::kKept + 3; ++i) other.error({"f", 1, 1}, "wrong");
  Diagnostics sut;
  sut.warning({"g", 1, 1}, "odd");
  sut.take(other);
  EXPECT_EQ(sut.errors(), Diagnostics::kKept + 3);
  EXPECT_EQ(sut.warnings(), 1U);
  EXPECT_FALSE(sut.ok());
}

TEST(Diagnostics, TextBeginsWithTheSeverityThatIsAskedFor) {
  Diagnostics sut;
  sut.add({Severity::note, {"a.stl", 0, 0}, "it was repaired", ""});
  sut.warning({"a.toml", 1, 0}, "doubtful");
  sut.error({"a.toml", 2, 0}, "wrong");
  EXPECT_EQ(sut.text(Severity::warning), "a.toml:1: warning: doubtful\na.toml:2: error: wrong\n");
  EXPECT_EQ(sut.text(), "a.stl: note: it was repaired\n" + sut.text(Severity::warning));
}

}  // namespace
}  // namespace cellmirror
