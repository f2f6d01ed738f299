#include "harness/sweep/merge_shards.hpp"

#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(RangesOf, AreThoseOfAJobArray) {
  EXPECT_EQ(ranges_of({}), "");
  EXPECT_EQ(ranges_of({4}), "4");
  EXPECT_EQ(ranges_of({1, 2, 3, 5, 8, 9}), "1-3,5,8-9");
}

TEST(RangeOf, ShardsAreAllSamplesOnce) {
  for (const std::size_t count : {1u, 2u, 7u, 10u, 13u}) {
    std::uint64_t next = 0;
    for (std::size_t index = 1; index <= count; ++index) {
      const SampleRange range = range_of({index, count}, 10);
      EXPECT_EQ(range.begin, next);
      EXPECT_LE(range.size(), 10 / count + 1);
      next = range.end;
    }
    EXPECT_EQ(next, 10u);
  }
}

class MergeShardsTest : public testing::Test {
 protected:
  // Shard `index` of 3, with the rows of the samples in [begin, end).
  void make_shard(std::size_t index, std::uint64_t begin, std::uint64_t end) {
    SweepIdentity identity = whole_;
    identity.shard = Shard{index, 3}.to_string();
    const fs::path shard = folder_.path() / "shards" / fmt::to_string(index);
    ASSERT_TRUE(claim_folder(shard, identity));
    std::ofstream table(shard / sample_file);
    table << columns_.header();
    for (std::uint64_t i = begin; i < end; ++i) table << row(i);
  }
  std::string row(std::uint64_t index) const {
    return columns_.line(index, {0.5}, {{outcome_done, {static_cast<double>(index)}}});
  }
  Result<void> merge() const {
    return merge_shards({folder_.path() / "shards"}, whole_, columns_, 10, out_);
  }

  TemporaryDirectory folder_;
  fs::path out_ = folder_.path() / "merged";
  SampleColumns columns_{{"mass"}, {"settles"}, false};
  SweepIdentity whole_{"1.0", "5eed", "", "", "1/1"};
};

TEST_F(MergeShardsTest, RowsAreInTheOrderOfTheSamples) {
  make_shard(3, 6, 10);
  make_shard(1, 0, 3);
  make_shard(2, 3, 6);
  for (int again = 0; again < 2; ++again) {
    ASSERT_TRUE(merge());
    const auto data = read_samples(out_ / sample_file, columns_, {0, 10});
    ASSERT_TRUE(data) << data.error().to_string();
    for (std::size_t i = 0; i < 10; ++i) {
      EXPECT_EQ(data->pilots[0].metrics[0][i], static_cast<double>(i));
    }
  }
}

TEST_F(MergeShardsTest, ARowOfAnotherShardIsRefused) {
  make_shard(1, 0, 3);
  make_shard(2, 0, 3);
  make_shard(3, 6, 10);
  EXPECT_THAT(merge().error().to_string(),
              HasSubstr("2/samples.csv:2: is not the row of sample 3"));
  EXPECT_FALSE(fs::exists(out_ / sample_file));
}

// Two attempts at a shard begin at the same time, or the first was killed while it wrote.
TEST_F(MergeShardsTest, AHalfWrittenIdentityDoesNotKeepAFolder) {
  const fs::path folder = folder_.path() / "one";
  fs::create_directories(folder);
  std::ofstream(folder / ".identity.json.x7k2p0") << "{";
  EXPECT_TRUE(claim_folder(folder, whole_));
  EXPECT_TRUE(claim_folder(folder, whole_));
  const fs::path other = folder_.path() / "other";
  fs::create_directories(other);
  std::ofstream(other / "notes") << "mine";
  EXPECT_THAT(claim_folder(other, whole_).error().message, HasSubstr("has other files"));
}

}  // namespace
}  // namespace attest
