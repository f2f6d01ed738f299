// Each type of message, in whole files.
#include "harness/ulog/reader.hpp"

#include <gmock/gmock.h>

#include "tests/harness/ulog/log_file.hpp"

namespace attest::ulog {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using ULogReader = LogFile;

TEST_F(ULogReader, ReadsVersion0WithoutFlagBits) {
  Crafted log(0, 5);
  log.format("pose:uint64_t timestamp;float[2] q;").subscribe(3, "pose");
  log.data(3, raw(std::uint64_t{7}, 1.0f, 0.5f));
  Reader reader = open(log);
  EXPECT_EQ(reader.header().version, 0);
  EXPECT_EQ(reader.header().start_us, 5u);
  EXPECT_THAT(lines_of(reader).lines,
              ElementsAre("F pose", "A pose/0", "D pose/0 timestamp=7 q=1,0.5"));
  EXPECT_EQ(reader.damage().total(), 0u);
}

TEST_F(ULogReader, ReadsEveryTypeOfMessage) {
  Crafted log;
  log.flag_bits().value('I', "char[3] sys_name", "PX4").value('I', "uint32_t ver", raw(9));
  log.value('M', 0, "char[2] perf", "ab").value('M', 1, "char[1] perf", "c");
  log.value('P', "int32_t MAV_TYPE", raw(2)).value('P', "float MC_ROLL_P", raw(6.5f));
  log.value('Q', 3, "float MC_ROLL_P", raw(6.0f));
  log.format("a:uint64_t timestamp;").subscribe(0, "a").subscribe(1, "a", 1);
  log.data(1, raw(std::uint64_t{4})).log('6', 10, "armed").sync();
  log.message('C', "3" + raw(std::uint16_t{500}, std::uint64_t{11}) + "late");
  log.message('O', raw(std::uint16_t{40})).message('R', raw(std::uint16_t{1}));
  log.data(0, raw(std::uint64_t{5}));
  const LogLines read = this->read(log);
  EXPECT_THAT(read.lines,
              ElementsAre("I sys_name=PX4", "I ver=9", "M perf=ab", "M 1 perf=c", "P MAV_TYPE=2",
                          "P MC_ROLL_P=6.5", "Q 3 MC_ROLL_P=6", "F a", "A a/0", "A a/1",
                          "D a/1 timestamp=4", "L 6 10: armed", "S", "L 3 tag 500 11: late",
                          "O 40 ms", "R a/1", "D a/0 timestamp=5"));
  EXPECT_EQ(read.damage.total(), 0u);
}

TEST_F(ULogReader, PassesOverDataUpToTheFirstThatIsWanted) {
  Crafted log;
  log.format("a:uint64_t timestamp;").subscribe(0, "a");
  for (std::uint64_t time = 1; time < 4; ++time) log.data(0, raw(time));
  log.log('6', 10, "armed").data(0, raw(std::uint64_t{4}));
  Reader reader = open(log);
  Message message;
  for (const char* definition : {"F", "A"}) ASSERT_TRUE(*reader.next(message)) << definition;
  const auto time_of = [](const Data& data) { return load<std::uint64_t>(data.bytes.data()); };
  reader.skip_data([&](const Data& data) { return time_of(data) < 2; });
  ASSERT_TRUE(*reader.next(message));
  EXPECT_EQ(time_of(std::get<Data>(message)), 2u);
  reader.skip_data([](const Data&) { return true; });
  ASSERT_TRUE(*reader.next(message));
  EXPECT_TRUE(std::holds_alternative<LogLine>(message)) << "only data are passed over";
}

TEST_F(ULogReader, ReadsEveryTypeOfValue) {
  Crafted log;
  log.format(
      "all:uint64_t timestamp;int64_t a;double b;int32_t c;uint32_t d;float e;int16_t f;"
      "uint16_t g;int8_t h;uint8_t i;bool j;char k;char[3] l");
  log.subscribe(0, "all");
  log.data(0, raw(~std::uint64_t{0}, std::int64_t{-2}, -2.5, std::int32_t{-3}, 0xffffffffu, 1.5f,
                  std::int16_t{-4}, std::uint16_t{65535}, std::int8_t{-5}, std::uint8_t{255},
                  std::uint8_t{2}, 'x') +
                  "abc");
  EXPECT_EQ(read(log).lines.back(),
            "D all/0 timestamp=1.8446744073709552e+19 a=-2 b=-2.5 c=-3 d=4294967295 e=1.5 f=-4 "
            "g=65535 h=-5 i=255 j=1 k=120 l=abc");
  const Reader reader = open(log);
  Data data{nullptr, std::string_view(log.bytes()).substr(log.size() - 47)};
  EXPECT_EQ(reader.find("all", 0, "timestamp")->of<std::uint64_t>(data), ~std::uint64_t{0});
  EXPECT_EQ(reader.find("all", 0, "a")->of<std::int64_t>(data), -2);
  EXPECT_EQ(reader.find("all", 0, "e")->of<float>(data), 1.5f);
  EXPECT_EQ(reader.find("all", 0, "l[2]")->of<char>(data), 'c');
}

TEST_F(ULogReader, FindsFieldsThroughNestedFormats) {
  Crafted log;
  // A format may be used before it is defined.
  log.format("esc_status:uint64_t timestamp;esc[2] esc;uint8_t count;uint8_t[7] _padding0;");
  log.format("esc:point at;int16_t rpm;uint8_t[2] _padding0;").format("point:float[2] x;");
  log.subscribe(9, "esc_status");
  const auto esc = [](float x, std::int16_t rpm) { return raw(x, x + 1, rpm, std::int16_t{0}); };
  log.data(9, raw(std::uint64_t{1}) + esc(10, -7) + esc(20, 8) + raw(std::uint8_t{2}));
  Reader reader = open(log);
  const auto x = reader.find("esc_status", 0, "esc[1].at.x[1]");
  const auto rpm = reader.find("esc_status", 0, "esc[0].rpm");
  ASSERT_TRUE(x && rpm);
  Message message;
  while (!std::holds_alternative<Data>(message) || !std::get<Data>(message).subscription) {
    ASSERT_TRUE(reader.next(message).value());
  }
  EXPECT_TRUE(x->is_in(std::get<Data>(message)));
  EXPECT_EQ(x->of(std::get<Data>(message)), 21);
  EXPECT_EQ(rpm->of<int>(std::get<Data>(message)), -7);
  const Format& format = reader.formats().all().at("esc_status");
  EXPECT_EQ(format.bytes, 40u);
  EXPECT_EQ(format.least_bytes, 33u);  // data may lack the last padding
  EXPECT_EQ(reader.damage().total(), 0u);
}

TEST_F(ULogReader, NamesFieldsThatDoNotExist) {
  Crafted log;
  log.format("pose:uint64_t timestamp;float[4] q;float roll;").subscribe(0, "pose");
  const Reader reader = open(log);
  const auto error = [&](std::string_view topic, std::uint8_t multi_id, std::string_view path) {
    const auto found = reader.find(topic, multi_id, path);
    return found ? "" : found.error().message;
  };
  EXPECT_EQ(error("pose", 0, "q[3]"), "");
  EXPECT_EQ(error("pse", 0, "roll"), "no instance 0 of the topic pse; did you mean `pose`?");
  EXPECT_EQ(error("pose", 1, "roll"), "no instance 1 of the topic pose");
  EXPECT_EQ(error("pose", 0, "rol"), "pose has no number rol; did you mean `roll`?");
  EXPECT_EQ(error("pose", 0, "roll[0]"), "pose has no number roll[0]");
  EXPECT_EQ(error("pose", 0, "q[4]"), "pose has no number q[4]; did you mean `q[3]`?");
  for (const std::string path : {"q", "q[-1]", "q[]", "q[1x]", "q[99999999999]", "", "[0]"}) {
    EXPECT_THAT(error("pose", 0, path), HasSubstr("pose has no number " + path));
  }
}

TEST_F(ULogReader, FindsColumnsBeforeTheFirstMessageIsRead) {
  Crafted log;
  log.format("a:uint64_t timestamp;").subscribe(0, "a").data(0, raw(std::uint64_t{4}));
  log.subscribe(1, "a", 1).data(1, raw(std::uint64_t{5}));
  Reader reader = open(log);
  EXPECT_TRUE(reader.find("a", 0, "timestamp"));
  EXPECT_FALSE(reader.find("a", 1, "timestamp"));  // it is subscribed after the first data
  lines_of(reader);
  EXPECT_TRUE(reader.find("a", 1, "timestamp"));
  ASSERT_EQ(reader.subscriptions().size(), 2u);
  EXPECT_EQ(reader.subscriptions()[1].index, 1u);
}

TEST_F(ULogReader, ReadsAppendedData) {
  const auto log_with = [](std::uint64_t first, std::uint64_t second) {
    Crafted log;
    log.flag_bits(1, first, second).format("a:uint64_t timestamp;").subscribe(0, "a");
    return log.data(0, raw(std::uint64_t{1})).data(0, raw(std::uint64_t{2}));
  };
  const std::uint64_t end = log_with(0, 0).size();
  // The crash cut the second message off.
  Crafted log = log_with(end - 3, end - 3 + 13);
  const std::string cut = log.bytes().substr(0, end - 3);
  Crafted whole = log;
  const std::string appended = whole.data(0, raw(std::uint64_t{3})).bytes().substr(end);
  const std::string text = cut + appended + appended;
  auto reader = Reader::open(directory_.write("b.ulg", text)).value();
  Message message;
  std::vector<std::string> lines;
  while (reader.next(message).value()) {
    if (reader.is_appended()) lines.push_back(line_of(message));
  }
  EXPECT_THAT(lines, ElementsAre("D a/0 timestamp=3", "D a/0 timestamp=3"));
  EXPECT_EQ(reader.damage().count(DamageKind::cut_off), 1u);
  EXPECT_EQ(reader.damage().total(), 1u);
  EXPECT_EQ(reader.header().appended_offsets[0], end - 3);
}

TEST_F(ULogReader, SkipsUnknownTypesAndCountsThem) {
  Crafted log;
  log.flag_bits().message('Z', "new").format("a:uint64_t timestamp;").message('x', "y");
  const LogLines read = this->read(log);
  EXPECT_THAT(read.lines, ElementsAre("F a"));
  EXPECT_EQ(read.unknown_messages, 2u);
  EXPECT_EQ(read.damage.total(), 0u);
}

TEST_F(ULogReader, RefusesOtherFiles) {
  const auto error = [&](const std::string& bytes) {
    const auto reader = Reader::open(directory_.write("a.ulg", bytes));
    return reader ? "" : reader.error().message;
  };
  const std::string not_a_log = "not a ULog; name a .ulg file of PX4's logger";
  EXPECT_EQ(error(""), "is empty; copy the log again");
  EXPECT_EQ(error("timestamp,in/x\n1,2\n"), "is a text, and " + not_a_log);
  EXPECT_EQ(error("ULog\x01\x12\x36" + raw(std::uint64_t{0}, '\0')), not_a_log);
  EXPECT_EQ(error(Crafted().bytes().substr(0, 15)), "is cut off; copy the log again");
  EXPECT_EQ(error_of(Crafted(2)),
            "a.ulg: a ULog of version 2; convert it to 1, or use a newer attest");
  EXPECT_EQ(error_of(Crafted().flag_bits(0x101)),
            "a.ulg: needs a feature that attest does not know (incompatible flags 0x101); use a "
            "newer attest");
  EXPECT_THAT(Reader::open(directory_.path()).error().message, HasSubstr("a directory"));
}

TEST_F(ULogReader, ReadsAnEmptyLog) {
  EXPECT_TRUE(read(Crafted(0)).lines.empty());
  EXPECT_TRUE(read(Crafted().flag_bits()).lines.empty());
  EXPECT_EQ(read(Crafted().flag_bits()).damage.total(), 0u);
}

}  // namespace
}  // namespace attest::ulog
