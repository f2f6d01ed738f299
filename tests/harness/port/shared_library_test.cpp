#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/port/port.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string test_port(const std::string& name) { return ATTEST_TEST_PORTS "/port_" + name + ".so"; }

std::string error_of(const std::string& path) {
  const auto port = open_port("lib:" + path);
  EXPECT_FALSE(port) << path;
  return port ? "" : port.error().to_string();
}

TEST(SharedLibrary, IsOpenedByItsPath) {
  const auto port = open_port("lib:" + test_port("crash"));
  ASSERT_TRUE(port) << port.error().to_string();
  EXPECT_EQ((*port)->name(), "crash");
  EXPECT_EQ((*port)->version(), "0.1.0");
  EXPECT_NE((*port)->create("px4-v1.5.5"), nullptr);
  EXPECT_EQ((*port)->create("px4-v9.9.9"), nullptr);
}

// dlopen searches the system's folders for a name without a slash.
TEST(SharedLibrary, ARelativePathIsFromTheCurrentFolder) {
  const auto relative = std::filesystem::relative(test_port("crash")).string();
  EXPECT_TRUE(open_port("lib:" + relative)) << relative;
  EXPECT_THAT(error_of("libc.so.6"), HasSubstr("no such library"));
}

TEST(SharedLibrary, MayRefuseEveryProfile) {
  const auto port = open_port("lib:" + test_port("refuses_profile"));
  ASSERT_TRUE(port);
  EXPECT_EQ((*port)->create("px4-v1.5.5"), nullptr);
}

TEST(SharedLibrary, OneThatIsNotThereIsAnError) {
  for (const std::string path : {"", "nowhere/libport.so"}) {
    EXPECT_THAT(error_of(path), HasSubstr("no such library"));
  }
  EXPECT_THAT(error_of("."), HasSubstr("is a folder"));
  // The system refuses so long a path.
  EXPECT_THAT(error_of(std::string(5000, 'x')), HasSubstr("no such library"));
}

TEST(SharedLibrary, ATextFileIsAnError) {
  const TemporaryDirectory folder;
  const std::string path = folder.write("libport.so", "not an ELF file\n").string();
  EXPECT_THAT(error_of(path), AllOf(HasSubstr(path), HasSubstr("cannot be loaded")));
}

TEST(SharedLibrary, OneThatIsNoPortIsAnError) {
  const std::string path = test_port("no_symbol");
  EXPECT_THAT(error_of(path), AllOf(HasSubstr(path), HasSubstr("exports no attest_unit_v1()")));
  EXPECT_THAT(error_of(test_port("null_unit")), HasSubstr("attest_unit_v1() returned NULL"));
  EXPECT_THAT(error_of(test_port("wrong_arithmetic")), HasSubstr("its arithmetic is `decimal`"));
  EXPECT_THAT(error_of(test_port("wrong_fixed_step")), HasSubstr("its fixed step: "));
  EXPECT_THAT(error_of(test_port("incomplete_mixer")),
              HasSubstr("a member of its extension attest.mixer.v1 is NULL"));
  EXPECT_THAT(error_of(test_port("incomplete_timestamp_sample")),
              HasSubstr("a member of its extension attest.timestamp_sample.v1 is NULL"));
}

TEST(SharedLibrary, AnotherAbiVersionIsAnErrorThatNamesBoth) {
  EXPECT_THAT(error_of(test_port("wrong_abi")),
              HasSubstr("its ABI version is 99, this attest speaks 1"));
  EXPECT_THAT(error_of(test_port("older_abi")),
              HasSubstr("its ABI version is 0, this attest speaks 1"));
}

}  // namespace
}  // namespace attest
