#include "ipc/control/control_request.hpp"

#include <gtest/gtest.h>

#include <string>

namespace cellmirror {
namespace {

TEST(ControlRequest, HasANameAndPlainArguments) {
  const auto sut = parse_control_request(R"({"request":"snapshot","view":3,"file":"a.png","all":true})");
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->request, "snapshot");
  EXPECT_EQ(sut->argument("view"), "3");
  EXPECT_EQ(sut->argument("file"), "a.png");
  EXPECT_EQ(sut->argument("all"), "true");
  EXPECT_EQ(sut->argument("request"), std::nullopt);
  EXPECT_EQ(sut->argument("nothing"), std::nullopt);
}

TEST(ControlRequest, EverythingElseIsRefusedWithTheForm) {
  std::string many = R"({"request":"x")";
  for (int i = 0; i < 40; ++i) many += ",\"a" + std::to_string(i) + "\":1";
  many += "}";
  const std::string deep = std::string(60'000, '[');
  for (const std::string& line :
       {std::string(""), std::string("status"), std::string("[]"), std::string("{}"), std::string(R"({"request":1})"),
        std::string(R"({"request":"x"} extra)"), std::string(R"({"request":"x","a":{}})"),
        std::string(R"({"request":"x","a":[1]})"), std::string(R"({"request":"x","a":null})"),
        std::string("{\"request\":\"\xFF\"}"), std::string("\0{}", 3), many, deep, deep + std::string(60'000, ']')}) {
    const auto sut = parse_control_request(line);
    ASSERT_FALSE(sut) << line.substr(0, 40);
    EXPECT_FALSE(sut.error().what.empty());
    EXPECT_NE(sut.error().remedy.find(R"({"request":"status"})"), std::string::npos);
  }
}

TEST(ControlRequest, LineIsReadBack) {
  const ControlRequest request{"say", {{"text", "two\nlines \"quoted\""}, {"n", "1"}}};
  const std::string line = control_request_line(request);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto sut = parse_control_request(line);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->request, "say");
  EXPECT_EQ(sut->argument("text"), "two\nlines \"quoted\"");
}

TEST(ControlError, IsReadBackFromAnAnswer) {
  const auto sut = control_error_in(control_error({"no such \"request\"", "ask for status"}));
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->what, "no such \"request\"");
  EXPECT_EQ(sut->remedy, "ask for status");
  EXPECT_FALSE(control_error_in(R"({"version":"1"})"));
  EXPECT_FALSE(control_error_in(R"({"error":3})"));
  EXPECT_FALSE(control_error_in(R"({"error":)"));
}

}  // namespace
}  // namespace cellmirror
