#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/host/port_process.hpp"
#include "tests/harness/casefile/case_files.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::vector<std::string> profiles{"px4-v1.5.5", "px4-v1.3.4", "px4-v9.9.9"};

std::string test_port(const std::string& name) {
  return fmt::format("lib:{}/port_{}.so", ATTEST_TEST_PORTS, name);
}

Result<PortDescription> described(const std::string& port,
                                  const std::vector<std::string>& asked = profiles,
                                  double timeout_s = 60) {
  HostOptions options;
  options.port = port;
  options.timeout_s = timeout_s;
  return describe_port(options, asked);
}

std::string error_of(const std::string& port) {
  const auto description = described(port);
  EXPECT_FALSE(description) << port;
  return description ? "" : description.error().to_string();
}

TEST(DescribePort, NamesItAndTheProfilesThatItSupports) {
  const auto builtin = described("builtin");
  ASSERT_TRUE(builtin) << builtin.error().to_string();
  EXPECT_THAT(builtin->profiles, ElementsAre("px4-v1.5.5", "px4-v1.3.4"));
  const auto library = described(test_port("crash"), {});
  ASSERT_TRUE(library);
  EXPECT_EQ(library->name, "crash");
  EXPECT_EQ(library->version, "0.1.0");
  EXPECT_THAT(library->profiles, IsEmpty());
}

TEST(DescribePort, OneThatRefusesEveryProfileIsStillAPort) {
  const auto description = described(test_port("refuses_profile"));
  ASSERT_TRUE(description);
  EXPECT_THAT(description->profiles, IsEmpty());
  EXPECT_EQ(description->refusals.at("px4-v1.5.5"), "no gains for px4-v1.5.5");
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
  const auto load = described(test_port("hangs_in_load"), {}, 0.3);
  ASSERT_TRUE(load) << load.error().to_string();
  EXPECT_EQ(load->hangs, "no answer within 0.3 s of CPU time, when it was loaded");
  const auto create = described(test_port("hangs_in_create"), profiles, 0.3);
  ASSERT_TRUE(create) << create.error().to_string();
  EXPECT_EQ(create->hangs, "");
  EXPECT_EQ(create->goes_wrong,
            "profile px4-v1.5.5: no answer within 0.3 s of CPU time in create()");
  EXPECT_THAT(create->profiles, IsEmpty());
  EXPECT_EQ(described("builtin")->hangs, "");
  EXPECT_EQ(described("builtin")->goes_wrong, "");
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
