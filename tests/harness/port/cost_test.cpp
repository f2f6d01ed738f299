// The cost of a step: in the handshake, and in the frames.
#include "harness/port/cost.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "harness/port/conversation.hpp"
#include "harness/port/hello.hpp"
#include "harness/port/program_port.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Result<Hello> hello_with(const std::string& cost) {
  return parse_hello(
      R"({"protocol":1,"name":"n","version":"2","profiles":[],"frames":"text","cost":)" + cost +
      "}");
}

TEST(ParseHello, ValidatesHowThePortCounts) {
  const auto counter_of = [](const std::string& cost) { return hello_with(cost)->cost; };
  EXPECT_EQ(counter_of(R"({"unit":"cycles","clock_hz":25000000})"),
            (CostCounter{CostUnit::cycles, 25e6}));
  EXPECT_EQ(counter_of(R"({"unit":"cycles","clock_hz":1e12})"),
            (CostCounter{CostUnit::cycles, 1e12}));
  EXPECT_EQ(counter_of(R"({"unit":"instructions"})"), (CostCounter{CostUnit::instructions, 0}));
  EXPECT_EQ(counter_of(R"({"unit":"nanoseconds"})"), (CostCounter{CostUnit::nanoseconds, 0}));
  for (const auto& [cost, wrong] : {
           std::pair(R"("cycles")", "has `cost` = \"cycles\"; it is an object with `unit`"),
           std::pair("null", "has `cost` = null"),
           std::pair("{}", "its `cost` lacks `unit`"),
           std::pair(R"({"unit":7})", "its `cost` has `unit` = 7"),
           std::pair(R"({"unit":"joules"})", "`cost` has the unit `joules`; it is `cycles`"),
           std::pair(R"({"unit":"cycles"})", "`cost` lacks `clock_hz`"),
           std::pair(R"({"unit":"cycles","clock_hz":0})", "`clock_hz` = 0; it is above 0"),
           std::pair(R"({"unit":"cycles","clock_hz":-1})", "`clock_hz` = -1; it is above 0"),
           std::pair(R"({"unit":"cycles","clock_hz":1.1e12})", "at most 1e+12"),
           std::pair(R"({"unit":"cycles","clock_hz":"25e6"})", "`clock_hz` = \"25e6\"; it is"),
           std::pair(R"({"unit":"cycles","clock_hz":true})", "`clock_hz` = true; it is"),
           std::pair(R"({"unit":"instructions","clock_hz":1})", "instructions do not have"),
           std::pair(R"({"unit":"nanoseconds","clock_hz":1})", "nanoseconds do not have"),
           std::pair(R"({"unit":"cycles","clock_hz":1,"clok":1})", "unknown member `clok`"),
       }) {
    EXPECT_THAT(hello_with(cost).error().message, HasSubstr(wrong)) << cost;
  }
}

// A program that has written these answers, and whose requests are not read.
PipedProgram program_with_costs(const std::string& answers) {
  const int file = ::memfd_create("answers", MFD_CLOEXEC);
  EXPECT_EQ(::write(file, answers.data(), answers.size()), static_cast<ssize_t>(answers.size()));
  ::lseek(file, 0, SEEK_SET);
  return PipedProgram::recorded(::memfd_create("requests", MFD_CLOEXEC), file);
}

std::string in_bytes(const auto&... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  return bytes;
}

TEST(Conversation, TakesTheCostOfAStepAndOfEachStepOfABatch) {
  const std::uint32_t step = 4, batch = 5, unit = 1, ok = 0;
  const attest_outputs out{};
  const std::uint32_t of_step = sizeof ok + sizeof out + 8, of_batch = 8 + 2 * (sizeof out + 8);
  const StepCost costs[] = {{2190, 812}, {2011, 0}, {UINT32_MAX, 1}};
  auto talk = Conversation::begin(program_with_costs(
      R"({"protocol":1,"name":"n","version":"2","profiles":[],"frames":"binary","batch":true,)"
      R"("cost":{"unit":"cycles","clock_hz":25000000}})"
      "\n" +
      in_bytes(of_step, step, unit, std::uint32_t{1}, ok, out, costs[0]) +
      in_bytes(of_batch, batch, unit, std::uint32_t{2}, ok, std::uint32_t{2}, out, costs[1], out,
               costs[2]) +
      in_bytes(of_step - 8, step, unit, std::uint32_t{3}, ok, out)));
  ASSERT_TRUE(talk) << talk.error().to_string();
  std::vector<ProgramStep> steps(2);
  EXPECT_EQ((*talk)->step(unit, Module::mc_att_control, steps[0]), ATTEST_OK);
  EXPECT_EQ(steps[0].cost, costs[0]);
  std::size_t done = 0;
  EXPECT_EQ((*talk)->batch(unit, Module::mc_att_control, steps, done), ATTEST_OK);
  EXPECT_EQ(done, 2u);
  EXPECT_EQ(steps[0].cost, costs[1]);
  EXPECT_EQ(steps[1].cost, costs[2]);
  try {
    (*talk)->step(unit, Module::mc_att_control, steps[0]);
    FAIL() << "an answer without a cost is taken";
  } catch (const PortBroke& broke) {
    EXPECT_THAT(broke.what(), HasSubstr("has a payload of 76 bytes instead of 84"));
  }
}

Result<std::unique_ptr<Port>> in_text(const std::string& mode) {
  return open_program(fmt::format("{} {}/tests/ports/programs/in_text.py {}", ATTEST_PYTHON,
                                  ATTEST_SOURCE_DIR, mode));
}

// Of in_text.py, whose answer to the 20th step may be wrong.
std::string wrong_cost_of(const std::string& mode) {
  const auto port = in_text(mode);
  if (!port) return port.error().to_string();
  const auto unit = (*port)->create("px4-v1.5.5");
  attest_outputs out{};
  try {
    for (int i = 0; i < 20; ++i) unit->step(attest_inputs{}, out);
  } catch (const PortBroke& broke) {
    return broke.how() == PortBroke::How::rules ? broke.what() : "it ended";
  }
  return "none";
}

TEST(ProgramPort, AWrongCostIsNotTaken) {
  const std::pair<const char*, const char*> answers[] = {
      {"counts", "none"},
      {"no_cost", "lacks `cost`, although the handshake has `cost`"},
      {"no_stack", "lacks `stack`, although the handshake has `cost`"},
      {"negative_cost", "has `cost` = -1; it is an integer from 0 to 4294967295"},
      {"large_cost", "has `cost` = 4294967296; it is an integer from 0 to"},
      {"half_a_byte", "has `stack` = 0.5; it is an integer from 0 to"},
      {"undeclared_cost", "has `cost`, which is no output of that module"},
  };
  for (const auto& [mode, wrong] : answers) {
    EXPECT_THAT(wrong_cost_of(mode), HasSubstr(wrong)) << mode;
  }
}

TEST(ProgramPort, HasTheCostsOfTheLastCall) {
  const auto port = in_text("counts");
  ASSERT_TRUE(port) << port.error().to_string();
  EXPECT_EQ((*port)->cost(), (CostCounter{CostUnit::instructions, 0}));
  const auto unit = (*port)->create("px4-v1.5.5");
  ASSERT_TRUE(unit);
  EXPECT_THAT(unit->costs(), testing::IsEmpty());
  attest_inputs in{};
  attest_outputs out{};
  for (std::uint32_t i = 0; i < 2; ++i) {
    in.timestamp = 4000 * i;
    ASSERT_EQ(unit->step(in, out), ATTEST_OK);
    EXPECT_THAT(unit->costs(), ElementsAre(StepCost{1000 + i, 256}));
  }
}

}  // namespace
}  // namespace attest
