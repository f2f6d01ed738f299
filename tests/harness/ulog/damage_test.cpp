// Damaged files: what is intact is read, and the damage is counted with its place.
#include <gmock/gmock.h>

#include "tests/harness/ulog/log_file.hpp"

namespace attest::ulog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class ULogDamage : public LogFile {
 protected:
  // A log with one topic, before its first data.
  static Crafted started() {
    Crafted log;
    log.flag_bits().format("a:uint64_t timestamp;float x;uint8_t[4] _padding0;");
    return log.subscribe(0, "a");
  }
  static std::string sample(std::uint64_t time) { return raw(time, static_cast<float>(time)); }
  static std::string line(int time) {
    return "D a/0 timestamp=" + std::to_string(time) + " x=" + std::to_string(time);
  }

  // The lines after those of started(). Checks that there is damage of one kind, once.
  std::vector<std::string> data_lines(const Crafted& log, DamageKind kind, std::uint64_t offset,
                                      const std::string& message) {
    const LogLines read = this->read(log);
    EXPECT_EQ(read.damage.count(kind), 1u);
    EXPECT_EQ(read.damage.total(), 1u);
    if (read.damage.first.empty()) return {};
    EXPECT_EQ(read.damage.first[0].offset, offset);
    EXPECT_THAT(read.damage.first[0].message, HasSubstr(message));
    return {read.lines.begin() + 2, read.lines.end()};
  }
};

TEST_F(ULogDamage, AFieldMoreThanOnce) {
  Crafted log;
  log.flag_bits().format("inner:float x;float x;").format("a:uint64_t timestamp;inner b;");
  const std::uint64_t offset = log.size();
  log.subscribe(0, "a").data(0, sample(1) + std::string(4, '\0'));
  EXPECT_THAT(data_lines(log, DamageKind::bad_format, offset,
                         "a has the field b.x more than once; the first one is used"),
              Not(IsEmpty()));
}

TEST_F(ULogDamage, DataOfAnUnknownId) {
  Crafted log = started();
  const std::uint64_t offset = log.size();
  log.data(7, sample(1)).data(0, sample(2));
  EXPECT_THAT(data_lines(log, DamageKind::unknown_id, offset, "data of msg_id 7"),
              ElementsAre(line(2)));
}

TEST_F(ULogDamage, DataAfterTheEndOfTheirSubscription) {
  Crafted log = started();
  log.message('R', raw(std::uint16_t{0}));
  const std::uint64_t offset = log.size();
  log.data(0, sample(1));
  EXPECT_THAT(data_lines(log, DamageKind::unknown_id, offset, "data of msg_id 0"),
              ElementsAre("R a/0"));
}

TEST_F(ULogDamage, DataOfTheWrongSize) {
  for (const std::string& wrong : {sample(1).substr(1), sample(1) + "12345"}) {
    Crafted log = started();
    const std::uint64_t offset = log.size();
    log.data(0, wrong).data(0, sample(2) + std::string(4, '\0'));
    EXPECT_THAT(data_lines(log, DamageKind::wrong_size, offset, "bytes of a, which has 16"),
                ElementsAre(line(2)));
  }
}

TEST_F(ULogDamage, FormatsThatCannotBeParsed) {
  const std::string long_name(600, 'x');
  for (const std::string& wrong :
       {std::string("b"), std::string(":float x;"), std::string("b:"), std::string("b:;"),
        std::string("b:float;"), std::string("b:float[0] x;"), std::string("b:float[] x;"),
        std::string("b:float[-1] x;"), std::string("b:float[1 x;"), std::string("b:float x y;"),
        std::string("b:float[2][2] x;"), std::string("b: x;"), "b:float " + long_name,
        std::string("a:float x;")}) {
    Crafted log = started();
    const std::uint64_t offset = log.size();
    log.format(wrong).data(0, sample(2));
    EXPECT_THAT(data_lines(log, DamageKind::bad_format, offset, ""), ElementsAre(line(2))) << wrong;
  }
}

TEST_F(ULogDamage, SubscriptionsWhoseFormatCannotBeUsed) {
  std::string chain;  // n1:n2 x; n2:n3 x; ...
  Crafted deep = started();
  for (int i = 1; i <= 20; ++i) {
    deep.format("n" + std::to_string(i) + ":n" + std::to_string(i + 1) + " x;");
  }
  deep.format("n21:float x;");
  Crafted wide = started().format("w:e[5000] x;").format("e:uint8_t x;uint8_t y;");
  Crafted large = started().format("l:h[2] x;").format("h:uint8_t[40000] x;");
  const std::vector<std::tuple<Crafted, std::string, std::string>> rows = {
      {started(), "missing", "format missing is not defined"},
      {started().format("b:uint64_t timestamp;c x;"), "b", "format c is not defined"},
      {started().format("r:uint64_t timestamp;r x;"), "r", "nested too deeply, or in itself"},
      {started().format("s:t x;").format("t:s[3] x;"), "s", "nested too deeply, or in itself"},
      {deep, "n1", "nested too deeply, or in itself"},
      {wide, "w", "w has too many fields"},
      {large, "l", "format l is too large"},
  };
  for (const auto& [before, topic, why] : rows) {
    Crafted log = before;
    const std::uint64_t offset = log.size();
    log.subscribe(5, topic).data(5, "12345678").data(0, sample(2));
    const LogLines read = this->read(log);
    EXPECT_EQ(read.lines.back(), line(2));
    EXPECT_EQ(read.damage.count(DamageKind::bad_format), 2u);  // the subscription and its data
    EXPECT_EQ(read.damage.total(), 2u);
    EXPECT_EQ(read.damage.first[0].offset, offset);
    EXPECT_THAT(read.damage.first[0].message, HasSubstr(why));
  }
}

TEST_F(ULogDamage, ATopicIsUsableOnceItsFormatIsDefined) {
  Crafted log = started();
  log.subscribe(5, "late").format("late:uint64_t timestamp;").data(5, raw(std::uint64_t{3}));
  EXPECT_THAT(read(log).lines.back(), "D late/0 timestamp=3");
}

TEST_F(ULogDamage, BodiesThatTheirTypeDoesNotAllow) {
  const std::vector<Crafted> rows = {
      started().value('I', "char[3] x", "ab"),
      started().value('I', "point x", "ab"),
      started().value('I', "char[3]", "abc"),
      started().message('I', "\x09xyz"),
      started().value('P', "int16_t x", "ab"),
      started().value('P', "float[1] x", "abcd"),
      started().value('P', "float x", "abc"),
      started().value('M', 0, "", ""),
      started().value('Q', 1, "double x", "12345678"),
      started().message('S', "12345678"),
      started().flag_bits(),
  };
  const std::uint64_t offset = started().size();
  for (Crafted log : rows) {
    log.data(0, sample(2));
    EXPECT_THAT(data_lines(log, DamageKind::bad_message, offset, ""), ElementsAre(line(2)));
  }
}

TEST_F(ULogDamage, AnEmptyTextIsNoDamage) {
  Crafted log = started();
  log.value('I', "char[0] perf_top_preflight", "").value('M', 0, "char[0] perf_top", "");
  const LogLines read = this->read(log.data(0, sample(2)));
  EXPECT_EQ(read.damage.total(), 0u);
  EXPECT_THAT(std::vector(read.lines.begin() + 2, read.lines.end()),
              ElementsAre("I perf_top_preflight=", "M perf_top=", line(2)));
}

TEST_F(ULogDamage, OnlySomeDamageCanHaveRemovedASample) {
  const auto may_lack = [&](Crafted log) {
    const Damage damage = read(log.data(0, sample(2))).damage;
    EXPECT_GT(damage.total(), 0u);
    return damage.may_lack_samples();
  };
  EXPECT_FALSE(may_lack(started().value('I', "char[3] x", "ab")));
  EXPECT_FALSE(may_lack(started().value('M', 0, "", "")));
  EXPECT_FALSE(may_lack(started().value('Q', 1, "double x", "12345678")));
  EXPECT_TRUE(may_lack(started().value('P', "int16_t x", "ab")));
  EXPECT_TRUE(may_lack(started().data(0, sample(1).substr(1))));
  EXPECT_TRUE(may_lack(started().append(std::string("\x04\0I1234567", 10)).sync()));
  EXPECT_TRUE(may_lack(started().append("123").sync()));
}

TEST_F(ULogDamage, DamageInAnAppendedPartRemovesNoSample) {
  const auto build = [](std::uint64_t appended_at) {
    Crafted log;
    log.flag_bits(1, appended_at).format("a:uint64_t timestamp;").subscribe(0, "a");
    return log.data(0, raw(std::uint64_t{1}));
  };
  Crafted log = build(build(0).size());
  const Damage damage = read(log.append("123")).damage;
  EXPECT_EQ(damage.total(), 1u);
  EXPECT_FALSE(damage.may_lack_samples());
}

TEST_F(ULogDamage, GarbageUpToASyncMessage) {
  // Bytes that are no head, a body too short for its type, and a length past the end.
  for (const std::string& garbage : {std::string(100, '\0'), std::string("\x01\0A12", 5),
                                     std::string("\xff\xff"
                                                 "D12345",
                                                 8)}) {
    Crafted log = started();
    log.data(0, sample(1));
    const std::uint64_t offset = log.size();
    log.append(garbage).sync().data(0, sample(2));
    EXPECT_THAT(data_lines(log, DamageKind::garbage, offset,
                           std::to_string(garbage.size() + 11) + " bytes are skipped"),
                ElementsAre(line(1), line(2)));
  }
}

TEST_F(ULogDamage, GarbageWithoutASyncMessageEndsTheReading) {
  Crafted log = started();
  const std::uint64_t offset = log.size();
  log.append(std::string(100, '\0')).data(0, sample(2));
  EXPECT_TRUE(
      data_lines(log, DamageKind::garbage, offset, "to the end, without a sync message").empty());
  EXPECT_EQ(read(log).damage.skipped_bytes, log.size() - offset);
}

TEST_F(ULogDamage, AWrongLengthIsNotFollowed) {
  // The length leads into the next message, where no message starts.
  for (const std::string& head : {std::string("\x0c\0D", 3), std::string("\x05\0Z", 3)}) {
    Crafted log = started();
    const std::uint64_t offset = log.size();
    log.append(head + raw(std::uint16_t{0}) + sample(1)).sync().data(0, sample(2));
    const LogLines read = this->read(log);
    EXPECT_EQ(read.lines.back(), line(2));
    EXPECT_EQ(read.damage.count(DamageKind::garbage), 1u);
    EXPECT_EQ(read.damage.first.back().offset, offset);
  }
}

TEST_F(ULogDamage, ASyncMessageFarBehindTheWindow) {
  for (std::size_t size = (1u << 20) - 40; size < (1u << 20) + 8; ++size) {
    Crafted log = started();
    log.append(std::string(size, '\0')).sync().data(0, sample(2));
    ASSERT_EQ(read(log).lines.back(), line(2)) << size;
  }
}

TEST_F(ULogDamage, AppendedDataOutsideOfTheFile) {
  for (const std::uint64_t offset : {std::uint64_t{17}, std::uint64_t{1000}, ~std::uint64_t{0}}) {
    Crafted log;
    log.flag_bits(1, offset).format("a:uint64_t timestamp;").subscribe(0, "a");
    EXPECT_EQ(data_lines(log, DamageKind::bad_message, 16, "no appended data at byte").size(), 0u);
  }
}

TEST_F(ULogDamage, KeepsTheFirstFindingsAndCountsAll) {
  Crafted log = started();
  for (int i = 0; i < 25; ++i) log.data(9, sample(1));
  const LogLines read = this->read(log);
  EXPECT_EQ(read.damage.first.size(), Damage::most_findings);
  EXPECT_EQ(read.damage.count(DamageKind::unknown_id), 25u);
}

TEST_F(ULogDamage, FindingsArePrintable) {
  Crafted log = started();
  log.subscribe(1, "\x1b[31mred\n");
  EXPECT_EQ(read(log).damage.first.at(0).message, "format \\x1b[31mred\\x0a is not defined");
  EXPECT_EQ(open(log).find("\x1b[31mred\n", 0, "x").error().message, "the format is damaged");
  EXPECT_EQ(open(log).find("\x1b[31mred", 1, "x").error().message,
            "no instance 1 of the topic \\x1b[31mred; did you mean `\\x1b[31mred\\x0a`?");
}

// Every message type, twice, and an appended part.
Crafted rich_log() {
  const auto build = [](std::uint64_t appended_at) {
    Crafted log;
    log.flag_bits(1, appended_at).value('I', "char[3] sys_name", "PX4");
    log.value('M', 1, "uint16_t[2] perf", "abcd").value('P', "float MC_ROLL_P", raw(6.5f));
    log.value('Q', 1, "int32_t MAV_TYPE", raw(2)).format("in:float[3] x;uint8_t[4] _padding0;");
    log.format("a:uint64_t timestamp;in[2] b;uint8_t[3] c;uint8_t[5] _padding0;");
    log.subscribe(0, "a").subscribe(2, "a", 1);
    const std::string inner = raw(1.0f, 2.0f, 3.0f, 0.0f);
    for (std::uint64_t time = 1; time <= 3; ++time) {
      log.data(0, raw(time) + inner + inner + "abc").sync();
      log.data(2, raw(time) + inner + inner + "abc" + "12345").log('6', time, "text");
      log.message('C', "3" + raw(std::uint16_t{5}, time) + "late");
      log.message('O', raw(std::uint16_t{40})).message('z', "new");
    }
    return log.message('R', raw(std::uint16_t{0}));
  };
  Crafted log = build(build(0).size());
  return log.data(2, raw(std::uint64_t{9}) + std::string(40, 'x')).sync();
}

TEST_F(ULogDamage, ATruncatedLogGivesAPrefix) {
  const std::string whole = rich_log().bytes();
  const std::vector<std::string> lines = read(rich_log()).lines;
  ASSERT_EQ(read(rich_log()).damage.total(), 0u);
  std::size_t most = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    auto reader = Reader::open(directory_.write("cut.ulg", whole.substr(0, size)));
    ASSERT_EQ(reader.has_value(), size >= 16) << size;
    if (!reader) continue;
    const LogLines cut = lines_of(*reader);
    ASSERT_LE(cut.lines.size(), lines.size()) << size;
    ASSERT_TRUE(std::equal(cut.lines.begin(), cut.lines.end(), lines.begin())) << size;
    ASSERT_GE(cut.lines.size(), most) << size;
    ASSERT_LE(cut.damage.count(DamageKind::cut_off), 1u) << size;
    most = cut.lines.size();
  }
  EXPECT_EQ(most, lines.size() - 1);
}

TEST_F(ULogDamage, AnyWrongByteIsSurvived) {
  const std::string whole = rich_log().bytes();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int change : {0x01, 0x80, 0xff}) {
      std::string wrong = whole;
      wrong[at] = static_cast<char>(wrong[at] ^ change);
      auto reader = Reader::open(directory_.write("wrong.ulg", wrong));
      if (reader) lines_of(*reader);
    }
  }
}

}  // namespace
}  // namespace attest::ulog
