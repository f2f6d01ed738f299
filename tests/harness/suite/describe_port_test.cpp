#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/suite/worker.hpp"
#include "tests/harness/suite/small_suite.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::vector<std::string> profiles{"px4-v1.5.5", "px4-v1.3.4", "px4-v9.9.9"};

std::string error_of(const std::string& port) {
  const auto description = describe_port(port, profiles, 60);
  EXPECT_FALSE(description) << port;
  return description ? "" : description.error().to_string();
}

TEST(DescribePort, NamesItAndTheProfilesThatItSupports) {
  const auto builtin = describe_port("builtin", profiles, 60);
  ASSERT_TRUE(builtin) << builtin.error().to_string();
  EXPECT_THAT(builtin->profiles, ElementsAre("px4-v1.5.5", "px4-v1.3.4"));
  const auto library = describe_port(test_port("crash"), {}, 60);
  ASSERT_TRUE(library);
  EXPECT_EQ(library->name, "crash");
  EXPECT_EQ(library->version, "0.1.0");
  EXPECT_THAT(library->profiles, IsEmpty());
}

TEST(DescribePort, OneThatRefusesEveryProfileIsStillAPort) {
  const auto description = describe_port(test_port("refuses_profile"), profiles, 60);
  ASSERT_TRUE(description);
  EXPECT_THAT(description->profiles, IsEmpty());
}

TEST(DescribePort, OneThatCannotBeLoadedSaysWhy) {
  EXPECT_THAT(error_of(test_port("wrong_abi")), HasSubstr("its ABI version is 99"));
  EXPECT_THAT(error_of(test_port("null_unit")), HasSubstr("returned NULL"));
  EXPECT_THAT(error_of(test_port("no_symbol")), HasSubstr("exports no attest_unit_v1()"));
  EXPECT_THAT(error_of("lib:nowhere/libport.so"),
              AllOf(HasSubstr("nowhere/libport.so"), HasSubstr("no such library")));
  EXPECT_THAT(error_of("nonsense"), HasSubstr("unknown port `nonsense`"));
}

TEST(DescribePort, OneThatHangsSaysSo) {
  const auto load = describe_port(test_port("hangs_in_load"), {}, 0.3);
  ASSERT_TRUE(load) << load.error().to_string();
  EXPECT_THAT(load->hangs, HasSubstr("gave no answer within 0.3 s"));
  const auto create = describe_port(test_port("hangs_in_create"), profiles, 0.3);
  ASSERT_TRUE(create) << create.error().to_string();
  EXPECT_THAT(create->hangs, HasSubstr("gave no answer within 0.3 s"));
  EXPECT_EQ(describe_port("builtin", profiles, 60)->hangs, "");
}

TEST(DescribePort, ATextFileIsNoPort) {
  const TemporaryDirectory folder;
  const std::string file = folder.write("port.so", "text\n").string();
  EXPECT_THAT(error_of("lib:" + file), AllOf(HasSubstr(file), HasSubstr("cannot be loaded")));
}

// An error can have bytes of a path in it that are not UTF-8.
TEST(DescribePort, APathThatIsNotUtf8IsRepairedInMessages) {
  EXPECT_THAT(error_of("lib:\xff.so"), HasSubstr("\xef\xbf\xbd.so"));
}

}  // namespace
}  // namespace attest
