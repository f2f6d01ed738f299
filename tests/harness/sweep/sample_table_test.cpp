#include "harness/sweep/sample_table.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::HasSubstr;

class SampleTableTest : public testing::Test {
 protected:
  std::string row(std::uint64_t index) const {
    const auto x = static_cast<double>(index);
    const FlightResult done{outcome_done, {x / 3, std::sqrt(x)}};
    return columns_.line(index, {x * 0.1, -x},
                         {done, index % 7 == 3 ? FlightResult{outcome_diverged, {}} : done});
  }
  std::optional<SampleTable> open_on(const std::string& machine) const {
    return SampleTable::open_on(machine, file_, columns_, range_).value();
  }
  // Appends the rows up to `end`; returns their number.
  std::uint64_t append_to(SampleTable& table, std::uint64_t end) const {
    const std::uint64_t begin = table.next();
    while (table.next() < end) EXPECT_TRUE(table.append(row(table.next())));
    return table.next() - begin;
  }
  // Appends all rows that are missing.
  Result<void> fill() const {
    auto table = SampleTable::open(file_, columns_, range_);
    if (!table) return tl::unexpected(table.error());
    append_to(**table, range_.end);
    return (*table)->finish();
  }
  std::size_t files() const {
    const std::filesystem::directory_iterator all(folder_.path());
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }
  std::string text() const {
    std::ostringstream all;
    all << std::ifstream(file_).rdbuf();
    return all.str();
  }
  void write(const std::string& bytes) const { std::ofstream(file_) << bytes; }

  TemporaryDirectory folder_;
  std::filesystem::path file_ = folder_.path() / "samples.csv";
  SampleColumns columns_{{"mass", "tilt"}, {"settles", "peak"}, true};
  SampleRange range_{20, 60};
};

TEST_F(SampleTableTest, IsReadAsItWasWritten) {
  ASSERT_TRUE(fill());
  EXPECT_THAT(text(), HasSubstr("sample,mass,tilt,reference.outcome,reference.settles,"
                                "reference.peak,port.outcome,port.settles,port.peak\n20,2,-20,"));
  const auto data = read_samples(file_, columns_, range_);
  ASSERT_TRUE(data) << data.error().to_string();
  ASSERT_EQ(data->samples(), 40u);
  EXPECT_EQ(data->drawn[0][4], 24 * 0.1);
  EXPECT_EQ(data->pilots[0].metrics[1][4], std::sqrt(24.0));
  EXPECT_EQ(data->pilots[1].outcomes[4], outcome_diverged);
  EXPECT_TRUE(std::isnan(data->pilots[1].metrics[0][4]));
}

TEST_F(SampleTableTest, CutAnywhereItIsContinuedToTheSameBytes) {
  ASSERT_TRUE(fill());
  const std::string whole = text();
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    write(whole.substr(0, random() % (whole.size() + 1)));
    ASSERT_TRUE(fill());
    ASSERT_EQ(text(), whole);
  }
}

TEST_F(SampleTableTest, AnIncompleteTableIsNotRead) {
  ASSERT_TRUE(fill());
  const std::string whole = text();
  write(whole.substr(0, whole.size() - 1));
  EXPECT_THAT(read_samples(file_, columns_, range_).error().message, HasSubstr("has 39 of 40"));
}

TEST_F(SampleTableTest, AChangedLineIsRefusedWithItsNumber) {
  ASSERT_TRUE(fill());
  const std::string whole = text();
  const auto error_after = [&](const std::string& what, const std::string& with) {
    std::string changed = whole;
    changed.replace(changed.find(what), what.size(), with);
    write(changed);
    const auto table = SampleTable::open(file_, columns_, range_);
    return table ? "" : table.error().to_string();
  };
  EXPECT_THAT(error_after("\n25,", "\n26,"),
              HasSubstr("samples.csv:7: is not the row of sample 25"));
  EXPECT_THAT(error_after("\n25,", "\n25,1,"), HasSubstr("is not the row of sample 25"));
  EXPECT_THAT(error_after("\n25,2.5", "\n25,2x5"), HasSubstr("is not the row of sample 25"));
  EXPECT_THAT(error_after("mass", "mess"), HasSubstr("samples.csv:1: has other columns"));
  EXPECT_THAT(error_after("\n25,", "\n"), HasSubstr("is not the row of sample 25"));
}

TEST_F(SampleTableTest, HasOneWriterOnAMachine) {
  auto first = SampleTable::open(file_, columns_, range_);
  ASSERT_TRUE(first && *first);
  const auto second = SampleTable::open(file_, columns_, range_);
  ASSERT_TRUE(second);
  EXPECT_FALSE(*second);
  append_to(**first, range_.end);
  ASSERT_TRUE((*first)->finish());
  EXPECT_EQ((*SampleTable::open(file_, columns_, range_))->next(), range_.end);
  EXPECT_EQ(files(), 1u);
}

TEST_F(SampleTableTest, IsMissingUntilItIsFinished) {
  {
    auto table = open_on("a");
    append_to(*table, range_.end);
    EXPECT_FALSE(std::filesystem::exists(file_));
  }
  ASSERT_TRUE(open_on("a")->finish());
  EXPECT_TRUE(read_samples(file_, columns_, range_));
}

// A node is lost, but still works; the cluster has started its shard again.
TEST_F(SampleTableTest, TwoMachinesMakeOneTable) {
  ASSERT_TRUE(fill());
  const std::string whole = text();
  std::filesystem::remove(file_);
  for (const bool lost_is_last : {false, true}) {
    auto lost = open_on("lost");
    append_to(*lost, 31);
    auto second = open_on("second");
    EXPECT_EQ(second->next(), 31u);  // it continues
    append_to(*lost, 37);
    append_to(*second, 50);
    auto third = open_on("third");
    EXPECT_EQ(append_to(*third, range_.end), 10u);
    append_to(*lost, range_.end);
    ASSERT_TRUE((lost_is_last ? third : lost)->finish());
    ASSERT_TRUE((lost_is_last ? lost : third)->finish());
    append_to(*second, 55);  // it dies without an end
    EXPECT_EQ(text(), whole);
    EXPECT_EQ(files(), 1u);
    std::filesystem::remove(file_);
  }
}

TEST_F(SampleTableTest, ADyingMachineMayLeaveAnything) {
  ASSERT_TRUE(fill());
  const std::string whole = text();
  std::filesystem::remove(file_);
  std::string damaged = whole;
  damaged.replace(whole.find("\n30,") + 2, 40, 40, '\0');  // a block that did not arrive
  std::ofstream(file_.string() + ".part-lost") << damaged;
  EXPECT_EQ(open_on("lost")->next(), 30u);
  EXPECT_EQ(open_on("other")->next(), 30u);
  ASSERT_TRUE(fill());
  EXPECT_EQ(text(), whole);
}

}  // namespace
}  // namespace attest
