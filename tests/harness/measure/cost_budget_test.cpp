// The file of the worst costs: written, read, and compared.
#include "harness/measure/cost_budget.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/core/file.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

VectorTimes counted_vector(const std::string& group, const std::string& name,
                           std::vector<Cost> steps, const Rate& rate = Rate::hz(250)) {
  VectorTimes vector;
  vector.result.profile = "px4-v1.5.5";
  vector.result.group = group;
  vector.result.name = name;
  vector.result.rate = rate;
  vector.steps = std::move(steps);
  return vector;
}

const CostCounter cycles{CostUnit::cycles, 25e6};

CostBudget budget_of(std::vector<VectorTimes> vectors, const std::string& port = "mine",
                     const CostCounter& counter = cycles) {
  CorpusTimes times;
  times.vectors = std::move(vectors);
  return cost_budget_of(times, port, counter);
}

CostBudget small_budget(std::int64_t large, std::int64_t rates) {
  return budget_of({counted_vector("large_angle", "flip", {Cost(7), Cost(large)}),
                    counted_vector("large_angle", "roll", {Cost(8)}),
                    counted_vector("rates", "p", {Cost(rates)})});
}

Result<CostBudget> read_back(const std::string& text) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "costs.json";
  EXPECT_TRUE(write_file(path, text));
  return read_cost_budget(path);
}

TEST(CostBudget, HasTheWorstStepOfEachGroupAndRate) {
  const CostBudget budget = budget_of(
      {counted_vector("rates", "q", {Cost(8)}), counted_vector("rates", "p", {Cost(5), Cost(9)}),
       counted_vector("rates", "p", {Cost(6)}, Rate::hz(500)), VectorTimes{}});
  ASSERT_EQ(budget.worst.size(), 2u);
  const WorstCost& worst = budget.worst.at({"px4-v1.5.5", "mc_att_control", "rates", "250"});
  EXPECT_EQ(worst.cost, 9);
  EXPECT_EQ(worst.vector, "px4-v1.5.5/rates/p@250hz");
  EXPECT_EQ(worst.tick, 1u);
}

TEST(CostBudget, IsReadAsItWasWritten) {
  const CostBudget budget = small_budget(2011, 1900);
  const auto read = read_back(text_of(budget));
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->port, "mine");
  EXPECT_EQ(read->counter, cycles);
  EXPECT_THAT(changes(*read, budget, 0), IsEmpty());
  EXPECT_EQ(read->worst.size(), 2u);
  EXPECT_EQ(text_of(*read), text_of(budget));
}

TEST(CostBudget, AnotherFileIsRefused) {
  const std::string right = text_of(small_budget(2011, 1900));
  const auto error_with = [&](std::string_view from, std::string_view to) {
    std::string text = right;
    text.replace(text.find(from), from.size(), to);
    const auto read = read_back(text);
    return read ? "" : read.error().message;
  };
  EXPECT_THAT(error_with("attest-cost-budget-1", "attest-time-1"), HasSubstr("no budget file"));
  EXPECT_THAT(error_with("\"cycles\"", "\"joules\""), HasSubstr("has the unit `joules`"));
  EXPECT_THAT(error_with("2011", "-1"), HasSubstr("cost"));
  EXPECT_THAT(error_with("\"rates\"", "\"large_angle\""), HasSubstr("twice"));
  EXPECT_FALSE(read_back("[]"));
  EXPECT_FALSE(read_back(right.substr(0, 200)));
}

TEST(CostBudget, AChangeHasTheVectorAndTheGrowth) {
  const auto found = changes(small_budget(2011, 1900), small_budget(2190, 1800), 0);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].to_string(), "2,011 -> 2,190, +8.9%, in px4-v1.5.5/large_angle/flip@250hz");
  EXPECT_TRUE(found[0].fails);
  EXPECT_EQ(found[1].to_string(), "1,900 -> 1,800, -5.3%, in px4-v1.5.5/rates/p@250hz");
  EXPECT_FALSE(found[1].fails);
}

TEST(CostBudget, TheAllowanceIsTheLargestGrowthThatDoesNotFail) {
  const CostBudget before = small_budget(2000, 1), after = small_budget(2100, 1);
  EXPECT_FALSE(changes(before, after, 5).at(0).fails);
  EXPECT_TRUE(changes(before, after, 4.9).at(0).fails);
  EXPECT_EQ(changes(small_budget(1000000, 1), small_budget(1000001, 1), 0).at(0).to_string(),
            "1,000,000 -> 1,000,001, +0.0001%, in px4-v1.5.5/large_angle/flip@250hz");
}

TEST(CostBudget, AGroupThatIsNotInTheFileFails) {
  const CostBudget all = small_budget(2011, 1900);
  CostBudget part = all;
  part.worst.erase(part.worst.begin());
  const auto found = changes(part, all, 1000);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].fails);
  EXPECT_EQ(found[0].to_string(),
            "px4-v1.5.5/large_angle at 250 Hz, mc_att_control is not in the file "
            "(px4-v1.5.5/large_angle/flip@250hz)");
  EXPECT_THAT(changes(all, part, 0), IsEmpty());  // a run of some groups
}

TEST(CostBudget, IsOfOnePortUnitAndClock) {
  const CostBudget file = small_budget(2011, 1900);
  const auto error_of = [&](const CostBudget& now) {
    const auto same = check_same_port(file, now, "costs.json");
    return same ? "" : same.error().to_string();
  };
  EXPECT_EQ(error_of(file), "");
  CostBudget now = file;
  now.port = "other";
  EXPECT_THAT(error_of(now), HasSubstr("is of the port `mine`, and this is `other`"));
  now = file;
  now.counter = {CostUnit::instructions, 0};
  EXPECT_THAT(error_of(now), HasSubstr("has cycles at 25 MHz, and this port counts instructions"));
  now.counter = {CostUnit::cycles, 168e6};
  EXPECT_THAT(error_of(now), HasSubstr("this port counts cycles at 168 MHz"));
  now = file;
  now.worst[{"px4-v1.3.4", "mc_att_control", "rates", "250"}] = {};
  EXPECT_THAT(error_of(now), HasSubstr("has no costs of px4-v1.3.4"));
}

}  // namespace
}  // namespace attest
