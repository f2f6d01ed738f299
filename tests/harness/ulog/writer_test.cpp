// What the writer writes, and what it refuses so that no reader gets a bad file.
#include "harness/ulog/writer.hpp"

#include <gmock/gmock.h>

#include "harness/core/file.hpp"
#include "tests/harness/ulog/log_file.hpp"

namespace attest::ulog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ULogWriter : public LogFile {
 protected:
  std::filesystem::path path() const { return directory_.path() / "w.ulg"; }
  LogLines written(Writer& writer) {
    EXPECT_TRUE(writer.commit());
    auto reader = Reader::open(path()).value();
    return lines_of(reader);
  }

  Writer writer_ = Writer::open(path(), 77).value();
};

TEST_F(ULogWriter, WritesEveryTypeOfMessage) {
  EXPECT_TRUE(writer_.info("sys_name", "attest"));
  EXPECT_TRUE(writer_.parameter("MC_ROLL_P", 6.5f));
  EXPECT_TRUE(writer_.parameter("MAV_TYPE", -2));
  EXPECT_TRUE(writer_.define("a/b-c:uint64_t timestamp;float[2] q;bool on;"));
  EXPECT_EQ(writer_.subscribe("a/b-c").value(), 0);
  EXPECT_EQ(writer_.subscribe("a/b-c", 3).value(), 1);
  EXPECT_TRUE(writer_.data(1, raw(std::uint64_t{5}, 1.0f, 2.0f, true)));
  EXPECT_TRUE(writer_.log('4', 6, "careful"));
  EXPECT_TRUE(writer_.dropout(12));
  const LogLines read = written(writer_);
  EXPECT_THAT(
      read.lines,
      ElementsAre("I sys_name=attest", "P MC_ROLL_P=6.5", "P MAV_TYPE=-2", "F a/b-c", "A a/b-c/0",
                  "A a/b-c/3", "D a/b-c/3 timestamp=5 q=1,2 on=1", "L 4 6: careful", "O 12 ms"));
  EXPECT_EQ(read.damage.total(), 0u);
}

TEST_F(ULogWriter, WritesTheBytesOfTheFormat) {
  ASSERT_TRUE(writer_.define("a:uint64_t timestamp;"));
  ASSERT_TRUE(writer_.subscribe("a"));
  ASSERT_TRUE(writer_.data(0, raw(std::uint64_t{5})));
  ASSERT_TRUE(writer_.commit());
  Crafted log(1, 77);
  log.flag_bits().format("a:uint64_t timestamp;").subscribe(0, "a").data(0, raw(std::uint64_t{5}));
  EXPECT_EQ(read_file(path()).value(), log.bytes());
}

TEST_F(ULogWriter, RefusesTopicsThatNotEveryReaderReads) {
  const auto error = [&](const std::string& definition) {
    const auto defined = writer_.define(definition);
    return defined ? "" : defined.error().message;
  };
  EXPECT_THAT(error("a b:uint64_t timestamp;"), HasSubstr("`a b` is not a name"));
  EXPECT_THAT(error("a"), HasSubstr("not a format"));
  EXPECT_THAT(error("a:"), HasSubstr("no fields"));
  EXPECT_THAT(error("a:float x;"), HasSubstr("first field must be `uint64_t timestamp`"));
  EXPECT_THAT(error("a:uint64_t[1] timestamp;"), HasSubstr("first field"));
  EXPECT_THAT(error("a:uint64_t timestamp;float x\xC3\xA4;"), HasSubstr("is not a name"));
  EXPECT_THAT(error("a:uint64_t timestamp;float x[2];"), HasSubstr("is not a name"));
  EXPECT_THAT(error("a:uint64_t timestamp;uint8_t[4] _padding0;"), HasSubstr("starts with _"));
  EXPECT_THAT(error("a:uint64_t timestamp;b x;"), HasSubstr("a.x has no basic type"));
  EXPECT_THAT(error("a:uint64_t timestamp;float x;float x;"), HasSubstr("a.x occurs twice"));
  EXPECT_THAT(error("a:uint64_t timestamp;uint8_t x;float y;"), HasSubstr("a.y is larger"));
  EXPECT_THAT(error("a:uint64_t timestamp;uint8_t[65526] x;"), HasSubstr("too large"));
  EXPECT_EQ(error("a:uint64_t timestamp;uint8_t[65525] x;"), "");
  EXPECT_THAT(error("a:uint64_t timestamp;"), HasSubstr("a is defined twice"));
  ASSERT_TRUE(writer_.subscribe("a"));
  EXPECT_THAT(error("b:uint64_t timestamp;"), HasSubstr("before the first subscription"));
  EXPECT_THAT(written(writer_).lines, ElementsAre("F a", "A a/0"));
}

TEST_F(ULogWriter, RefusesOtherMistakes) {
  ASSERT_TRUE(writer_.define("a:uint64_t timestamp;"));
  EXPECT_THAT(writer_.subscribe("b").error().message, HasSubstr("b is not defined"));
  EXPECT_THAT(writer_.data(0, "12345678").error().message, HasSubstr("no msg_id 0"));
  ASSERT_TRUE(writer_.subscribe("a"));
  EXPECT_THAT(writer_.subscribe("a").error().message, HasSubstr("subscribed already"));
  EXPECT_THAT(writer_.data(0, "1234567").error().message, HasSubstr("a has 8 bytes, not 7"));
  EXPECT_THAT(writer_.info("a b", "x").error().message, HasSubstr("is not a name"));
  EXPECT_THAT(writer_.info("a", "").error().message, HasSubstr("no text"));
  EXPECT_THAT(writer_.info("a", std::string(65536, 'x')).error().message, HasSubstr("65535"));
  EXPECT_THAT(writer_.parameter("", 1).error().message, HasSubstr("is not a name"));
  EXPECT_THAT(writer_.parameter(std::string(250, 'x'), 1).error().message, HasSubstr("too long"));
  EXPECT_THAT(writer_.log('8', 1, "x").error().message, HasSubstr("level"));
  EXPECT_THAT(writer_.log('1', 1, std::string(65527, 'x')).error().message, HasSubstr("65535"));
  EXPECT_THAT(written(writer_).lines, ElementsAre("F a", "A a/0"));
}

TEST_F(ULogWriter, LeavesNoFileWithoutCommit) {
  ASSERT_TRUE(writer_.info("sys_name", "attest"));
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(ULogWriter, ALongLogHasSyncMessages) {
  ASSERT_TRUE(writer_.define("a:uint64_t timestamp;uint8_t[1000] x;"));
  ASSERT_TRUE(writer_.subscribe("a"));
  for (std::uint64_t time = 0; time < 1000; ++time) {
    ASSERT_TRUE(writer_.data(0, raw(time) + std::string(1000, 'x')));
  }
  ASSERT_TRUE(writer_.commit());
  std::string bytes = read_file(path()).value();
  bytes.replace(200'000, 2000, 2000, '\0');
  auto reader = Reader::open(directory_.write("wrong.ulg", bytes)).value();
  const LogLines read = lines_of(reader);
  EXPECT_GT(read.lines.size(), 900u);
  EXPECT_THAT(read.lines.back(), HasSubstr("timestamp=999 "));
  EXPECT_EQ(read.damage.count(DamageKind::garbage), 1u);
}

TEST_F(ULogWriter, ReportsAFullDisk) {
  auto full = Writer::open("/dev/full", 0);
  ASSERT_TRUE(full);
  EXPECT_THAT(full->commit().error().to_string(), HasSubstr("/dev/full: cannot write the file"));
  // The first block fails. The file is not completed with what would fit later.
  auto blocks = Writer::open("/dev/full", 0);
  EXPECT_TRUE(blocks->info("a", std::string(60'000, 'x')));
  EXPECT_FALSE(blocks->info("b", std::string(60'000, 'x')));
  EXPECT_FALSE(blocks->commit());
}

}  // namespace
}  // namespace attest::ulog
