// Ports that are programs. What a whole run says of those that break the protocol is in
// tests/cli/programs.bats.
#include "harness/port/program_port.hpp"

#include <array>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/mman.h>
#include <unistd.h>

#include "harness/port/conversation.hpp"
#include "harness/port/hello.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string programs =
    std::string(ATTEST_PYTHON) + " " + ATTEST_SOURCE_DIR + "/tests/ports/programs/";

TEST(WordsOf, SplitsAsAShellDoes) {
  ::setenv("ATTEST_TEST_VARIABLE", "one two", 1);
  const auto words = words_of(R"(run 'a b' "c d" e\ f "$ATTEST_TEST_VARIABLE")");
  ASSERT_TRUE(words) << words.error().to_string();
  EXPECT_THAT(*words, ElementsAre("run", "a b", "c d", "e f", "one two"));
}

TEST(WordsOf, RefusesWhatOnlyAShellCanDo) {
  for (const auto& [command, why] :
       {std::pair("a | b", "has one of the characters |"), std::pair("a > b", "no shell"),
        std::pair("a 'b", "not closed"), std::pair("$(a)", "command substitution"),
        std::pair("$ATTEST_NO_SUCH_VARIABLE", "not set"), std::pair("", "needs a command"),
        std::pair("  ", "needs a command")}) {
    const auto words = words_of(command);
    ASSERT_FALSE(words) << command;
    EXPECT_THAT(words.error().message, HasSubstr(why)) << command;
  }
}

TEST(FilesOf, AreTheProgramAndItsArgumentsThatAreFiles) {
  const std::string file = std::string(ATTEST_SOURCE_DIR) + "/README.md";
  EXPECT_THAT(files_of("proc:/bin/cat -n " + file), ElementsAre("/bin/cat", file));
  EXPECT_THAT(files_of("lib:mine.so"), ElementsAre("mine.so"));
  EXPECT_THAT(files_of("builtin"), ElementsAre());
}

TEST(ParseHello, TakesAllThatAPortMaySay) {
  const auto hello = parse_hello(
      R"({"protocol":1,"name":"n","version":"2","profiles":["px4-v1.5.5"],"frames":"binary",)"
      R"("batch":true,"modules":["mixer"],"unsupported_groups":["tpa"],"arithmetic":"fixed:22",)"
      R"("fixed_step":"1000/3","files":["law.py","../vector.py"],"lacks":["sticks"]})");
  ASSERT_TRUE(hello) << hello.error().to_string();
  EXPECT_EQ(hello->name, "n");
  EXPECT_EQ(hello->version, "2");
  EXPECT_THAT(hello->profiles, ElementsAre("px4-v1.5.5"));
  EXPECT_EQ(hello->frames, FrameForm::binary);
  EXPECT_TRUE(hello->has_batch);
  EXPECT_EQ(hello->modules, only(Module::mc_att_control) | only(Module::mixer));
  EXPECT_THAT(hello->unsupported_groups, ElementsAre("tpa"));
  EXPECT_THAT(hello->lacks.words, ElementsAre("sticks"));
  EXPECT_EQ(hello->fraction_bits, 22);
  EXPECT_EQ(hello->fixed_step->to_string(), "1000/3");
  EXPECT_THAT(hello->files, ElementsAre("law.py", "../vector.py"));
}

TEST(ParseHello, AProgramOfTheCascadeAloneHasNoController) {
  const auto modules_of = [](const std::string& profiles) {
    const auto hello = parse_hello(R"({"protocol":1,"name":"n","version":"2","profiles":[)" +
                                   profiles + R"(],"frames":"binary","modules":["rate_unit"]})");
    return hello ? hello->modules : ModuleSet();
  };
  const ModuleSet controller = only(Module::mc_att_control), unit = only(Module::rate_unit);
  EXPECT_EQ(modules_of(R"("px4-v1.16.0")"), unit);
  EXPECT_EQ(modules_of(R"("px4-v1.16.0","px4-v1.14.4")"), unit);
  EXPECT_EQ(modules_of(R"("px4-v1.16.0","px4-v1.3.4")"), unit | controller);
  EXPECT_EQ(modules_of(R"("our-law")"), unit | controller);
}

TEST(ParseHello, EveryPrefixOfAnAnswerIsAnError) {
  const std::string whole =
      R"({"protocol":1,"name":"n","version":"2","profiles":["px4-v1.5.5"],"frames":"text"})";
  ASSERT_TRUE(parse_hello(whole));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(parse_hello(whole.substr(0, size))) << size;
  }
}

// The error of an answer in which `member` replaces or follows those of a right one.
std::string wrong_with(const std::string& member, const std::string& value) {
  nlohmann::json hello = {{"protocol", 1},
                          {"name", "n"},
                          {"version", "2"},
                          {"profiles", nlohmann::json::array()},
                          {"frames", "text"}};
  hello[member] = nlohmann::json::parse(value);
  const auto parsed = parse_hello(hello.dump());
  return parsed ? "none" : parsed.error().message;
}

TEST(ParseHello, SaysWhichMemberIsWrong) {
  EXPECT_EQ(wrong_with("name", "\"m\""), "none");
  EXPECT_THAT(wrong_with("protocol", "0"), HasSubstr("has `protocol` 0; this attest speaks 1"));
  EXPECT_THAT(wrong_with("protocol", "2"), HasSubstr("has `protocol` 2; this attest speaks 1"));
  EXPECT_THAT(wrong_with("protocol", "\"1\""),
              HasSubstr("has `protocol` = \"1\"; it is the version"));
  EXPECT_THAT(wrong_with("protocol", "4294967297"), HasSubstr("has `protocol` 4294967297; this"));
  for (const char* number : {"1.5", "true", "1e300"}) {
    EXPECT_THAT(wrong_with("protocol", number), HasSubstr("it is the version of the protocol"));
  }
  EXPECT_THAT(wrong_with("arithmetic", "\"fixed:5\""), HasSubstr("its arithmetic is `fixed:5`"));
  EXPECT_THAT(wrong_with("fixed_step", "\"0\""), HasSubstr("its fixed step: "));
  EXPECT_THAT(wrong_with("modules", "[\"gimbal\"]"), HasSubstr("has the module `gimbal`"));
  EXPECT_THAT(wrong_with("frames", "\"xml\""), HasSubstr("has `frames` = `xml`"));
  EXPECT_EQ(wrong_with("byte_after_line", "true"), "none");
  EXPECT_THAT(wrong_with("byte_after_line", "1"), HasSubstr("it is true or false"));
  EXPECT_THAT(wrong_with("batch", "true"), HasSubstr("`batch`, which text frames do not have"));
  EXPECT_THAT(wrong_with("fixed_setp", "\"250\""), HasSubstr("did you mean `fixed_step`?"));
  EXPECT_THAT(parse_hello("[1]").error().message, HasSubstr("is `[1]`, which is no JSON object"));
  EXPECT_THAT(parse_hello(R"({"protocol":1})").error().message,
              HasSubstr("lacks `name`, which is the name of the port"));
}

int null_device() { return ::open("/dev/null", O_WRONLY | O_CLOEXEC); }

// A file with the answers of a program. Takes ownership of `requests`.
PipedProgram program_that_wrote(std::string_view answers, int requests = null_device()) {
  const int file = ::memfd_create("answers", MFD_CLOEXEC);
  EXPECT_EQ(::write(file, answers.data(), answers.size()), static_cast<ssize_t>(answers.size()));
  ::lseek(file, 0, SEEK_SET);
  return PipedProgram::recorded(requests, file);
}

// What attest writes to a program that declares `members`, until the answer to a `destroy`.
std::string written_to_program(const std::string& members) {
  const std::string hello = R"({"protocol":1,"name":"n","version":"2","profiles":[])" + members;
  const int written = ::memfd_create("requests", MFD_CLOEXEC);
  auto talk = Conversation::begin(
      program_that_wrote(hello + "}\n" + R"({"sequence":1,"result":"ok"})" + "\n", ::dup(written)));
  if (!talk) return talk.error().to_string();
  EXPECT_EQ((*talk)->destroy(1), ATTEST_OK);
  std::string bytes(4096, 0);
  bytes.resize(static_cast<std::size_t>(::pread(written, bytes.data(), bytes.size(), 0)));
  ::close(written);
  return bytes;
}

TEST(Conversation, WritesAByteAfterEachLineIfTheProgramAsksForIt) {
  const std::string request = R"({"do":"destroy","sequence":1,"unit":1})"
                              "\n";
  EXPECT_EQ(written_to_program(R"(,"frames":"text")"), greeting() + request);
  EXPECT_EQ(written_to_program(R"(,"frames":"text","byte_after_line":true)"),
            greeting() + ' ' + request + ' ');
}

TEST(ParseHello, ByteAfterLineIsForTextFramesOnly) {
  const auto hello =
      parse_hello(R"({"protocol":1,"name":"n","version":"2","profiles":[],"frames":"shared",)"
                  R"("byte_after_line":true})");
  ASSERT_FALSE(hello);
  EXPECT_THAT(hello.error().message, HasSubstr("`byte_after_line`, which is for text frames"));
}

TEST(Conversation, ShowsControlCharactersOfAnAnswer) {
  auto talk = Conversation::begin(
      program_that_wrote(R"({"protocol":1,"name":"n","version":"2","profiles":[],"frames":"text"})"
                         "\n"
                         R"({"sequence":1,"result":"ok","out/\u001b[2J":1})"
                         "\n"));
  ASSERT_TRUE(talk) << talk.error().to_string();
  ProgramStep step;
  try {
    (*talk)->step(1, Module::mc_att_control, step);
    FAIL() << "the answer is taken";
  } catch (const PortBroke& broke) {
    EXPECT_THAT(broke.what(), HasSubstr("has `out/\\x1b[2J`, which is no output"));
  }
  EXPECT_TRUE((*talk)->is_over());
}

attest_inputs level_and_rolling() {
  attest_inputs in{};
  in.timestamp = 5'000'000;
  in.updated = 0x1ff;
  in.control_state.q[0] = 1;
  in.control_state.roll_rate = 0.5f;
  in.vehicle_attitude_setpoint.q_d[0] = 1;
  in.vehicle_attitude_setpoint.thrust = 0.5f;
  in.battery_status.scale = 1;
  in.vehicle_control_mode.flag_control_rates_enabled = 1;
  in.vehicle_control_mode.flag_control_attitude_enabled = 1;
  in.actuator_armed.armed = 1;
  in.vehicle_status.is_rotary_wing = 1;
  return in;
}

TEST(ProgramPort, SendsAndTakesTheBytesOfTheExample) {
  auto port = open_program(programs + "example.py");
  ASSERT_TRUE(port) << port.error().to_string();
  EXPECT_EQ((*port)->name(), "example");
  const auto unit = (*port)->create("px4-v1.5.5");
  ASSERT_TRUE(unit);
  EXPECT_EQ(unit->set_parameter("MC_ROLL_P", 6.5f), ATTEST_OK);
  EXPECT_EQ(unit->set_timestamp_sample(5'000'000), ATTEST_OK);
  attest_outputs out{};
  EXPECT_EQ(unit->step(level_and_rolling(), out), ATTEST_OK);
  EXPECT_EQ(out.actuator_controls_0.control[0], -0.15f);
  EXPECT_EQ(out.actuator_controls_0.control[3], 0.5f);
  EXPECT_EQ(out.mc_att_ctrl_status.roll_rate_integ, -0.0005f);
  EXPECT_EQ(out.mc_att_ctrl_status.published, 1);
}

TEST(ProgramPort, AsksForNoProfileThatTheProgramDoesNotName) {
  auto port = open_program(programs + "example.py");
  ASSERT_TRUE(port) << port.error().to_string();
  // The example would end at this request, so create() would throw.
  EXPECT_FALSE((*port)->create("px4-v1.3.4"));
}

TEST(ProgramPort, StartsAProgramAgainThatHasEnded) {
  auto port = open_program(programs + "program.py exits");
  ASSERT_TRUE(port) << port.error().to_string();
  for (int start = 0; start < 2; ++start) {
    const auto unit = (*port)->create("px4-v1.5.5");
    ASSERT_TRUE(unit);
    attest_outputs out{};
    for (int i = 0; i < 19; ++i) ASSERT_EQ(unit->step(level_and_rolling(), out), ATTEST_OK);
    try {
      unit->step(level_and_rolling(), out);
      FAIL() << "it answered the 20th step";
    } catch (const PortBroke& broke) {
      EXPECT_EQ(broke.how(), PortBroke::How::ended);
      EXPECT_STREQ(broke.what(), "the program exited with status 3 in the request `step`");
    }
  }
}

// Of program.py, whose answer to the 20th step is wrong.
std::string wrong_answer_of(const std::string& program) {
  auto port = open_program(programs + program);
  if (!port) return port.error().to_string();
  const auto unit = (*port)->create("px4-v1.5.5");
  attest_outputs out{};
  try {
    for (int i = 0; i < 20; ++i) unit->step(level_and_rolling(), out);
  } catch (const PortBroke& broke) {
    return broke.how() == PortBroke::How::rules ? broke.what() : "it ended";
  }
  return "none";
}

TEST(ProgramPort, AnAnswerThatBreaksTheRulesIsNotTaken) {
  const std::pair<const char*, const char*> answers[] = {
      {"program.py right", "none"},
      {"program.py garbage", "which are no header of a frame"},
      {"program.py prints", "begins with the bytes `roll = 0.3"},
      {"program.py huge", "has a payload of 4294967295 bytes instead of 76"},
      {"program.py short", "has a payload of 72 bytes instead of 76"},
      {"program.py stale", "sequence number 20; they must be those of the request: 4, 1, 21"},
      {"program.py wrong_unit", "has kind 4, unit 99"},
      {"program.py wrong_kind", "has kind 1, unit 1"},
      {"in_text.py", "none"},
      {"in_text.py no_object", "is `[1]`; it must be a JSON object with `sequence` and `result`"},
      {"in_text.py no_sequence", "it must be a JSON object with `sequence` and `result`"},
      {"in_text.py stale", "has the sequence number 20; that of the request is 21"},
      {"in_text.py other_result", "has the result \"fine\""},
      {"in_text.py unknown_output", "has `out/roll`, which is no output of that module"},
      {"in_text.py text_for_number", "roll` = \"0.1\", which is no value of that signal"},
      {"in_text.py half_a_flag", "published` = 0.5, which is no value of that signal"},
  };
  for (const auto& [program, wrong] : answers) {
    EXPECT_THAT(wrong_answer_of(program), HasSubstr(wrong)) << program;
  }
}

TEST(ProgramPort, AWrongAnswerInSharedMemoryIsNotTakenEither) {
  const std::pair<const char*, const char*> answers[] = {
      {"right", "none"},
      {"garbage", "which are no header of a frame"},
      {"huge", "has a payload of 4294967295 bytes instead of 76"},
      {"short", "has a payload of 72 bytes instead of 76"},
      {"stale", "sequence number 20; they must be those of the request: 4, 1, 21"},
      {"exits", "it ended"},
  };
  for (const auto& [mode, wrong] : answers) {
    const std::string program = std::string("program.py ") + mode + " --shared";
    EXPECT_THAT(wrong_answer_of(program), HasSubstr(wrong)) << program;
  }
}

// The outputs that a program gives for unpublished topics do not matter.
TEST(ProgramPort, TopicsThatAreNotPublishedKeepTheirValues) {
  auto port = open_program(programs + "program.py right");
  ASSERT_TRUE(port) << port.error().to_string();
  const auto unit = (*port)->create("px4-v1.5.5");
  ASSERT_TRUE(unit);
  attest_outputs out{};
  attest_inputs in = level_and_rolling();
  in.vehicle_control_mode = {};  // nothing is controlled, nothing published
  out.vehicle_rates_setpoint.roll = 7;
  ASSERT_EQ(unit->step(in, out), ATTEST_OK);
  EXPECT_EQ(out.vehicle_rates_setpoint.published, 0);
  EXPECT_EQ(out.vehicle_rates_setpoint.roll, 7);
}

TEST(ProgramPort, ABatchIsTheSameAsItsSteps) {
  auto batches = open_program(programs + "program.py hello_in_batches");
  auto steps = open_program(programs + "program.py right");
  ASSERT_TRUE(batches && steps);
  const auto batched = (*batches)->create("px4-v1.5.5"), stepped = (*steps)->create("px4-v1.5.5");
  ASSERT_TRUE(batched && stepped);
  EXPECT_EQ(stepped->max_batch(), 0u);
  ASSERT_GE(batched->max_batch(), 50u);
  std::vector<Sample> samples(50);
  std::vector<std::uint64_t> times;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    attest_inputs& in = samples[i].in = level_and_rolling();
    in.timestamp += 4000 * i;
    if (i > 0) in.updated = 0;
    if (i == 40) {  // from here on nothing is controlled, and nothing published
      in.updated = ATTEST_UPDATED_VEHICLE_CONTROL_MODE;
      in.vehicle_control_mode = {};
    }
    times.push_back(in.timestamp);
  }
  const Batched done = batched->batch(samples, times);
  EXPECT_EQ(done.done, samples.size());
  EXPECT_EQ(done.result, ATTEST_OK);
  attest_outputs one{};
  for (const Sample& sample : samples) {
    ASSERT_EQ(stepped->step(sample.in, one), ATTEST_OK);
    const attest_outputs& out = sample.out;
    EXPECT_EQ(out.actuator_controls_0.control[0], one.actuator_controls_0.control[0]);
    EXPECT_EQ(out.mc_att_ctrl_status.roll_rate_integ, one.mc_att_ctrl_status.roll_rate_integ);
    EXPECT_EQ(out.vehicle_rates_setpoint.thrust, one.vehicle_rates_setpoint.thrust);
  }
}

}  // namespace
}  // namespace attest
