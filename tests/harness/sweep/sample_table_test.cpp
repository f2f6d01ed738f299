#include "harness/sweep/sample_table.hpp"

#include <cmath>
#include <fstream>
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
  // Appends all rows that are missing.
  Result<void> fill() const {
    auto table = SampleTable::open(file_, columns_, range_);
    if (!table) return tl::unexpected(table.error());
    while (table->next() < range_.end) {
      if (auto done = table->append(row(table->next())); !done) return done;
    }
    return table->finish();
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

TEST_F(SampleTableTest, HasOneWriter) {
  const auto first = SampleTable::open(file_, columns_, range_);
  ASSERT_TRUE(first);
  EXPECT_THAT(SampleTable::open(file_, columns_, range_).error().message,
              HasSubstr("another `attest sweep` is writing this file"));
}

}  // namespace
}  // namespace attest
