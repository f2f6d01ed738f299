#include "harness/host/file_format.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "harness/core/file.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

Trace two_ticks() {
  Trace trace;
  for (const std::uint64_t timestamp : {5'000'000u, 5'004'000u}) {
    Sample sample{};
    sample.in.timestamp = timestamp;
    sample.in.control_state.roll_rate = timestamp == 5'000'000u ? 0.1f : std::nanf("");
    sample.in.updated = ATTEST_UPDATED_PARAMETER_UPDATE;
    sample.in.actuator_armed.armed = 1;
    trace.samples.push_back(sample);
  }
  trace.parameters = {{0, "MC_ROLL_P", 6.5f}, {1, "MC_ROLL_P", 7}};
  trace.present = channels_of(Module::mc_att_control);
  return trace;
}

class FileFormatTest : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return directory_.path() / name; }

  Result<void> write(const std::string& name) const {
    return write_trace(*AtomicFile::open(path(name)), two_ticks());
  }

  Result<Table> read(const std::string& name) const {
    return read_as<&FileFormat::read_table>(path(name), std::size_t{100});
  }
  Result<Table> read(const std::string& name, const std::string& bytes) const {
    EXPECT_TRUE(write_file(path(name), bytes));
    return read(name);
  }

  std::string error(const std::string& name, const std::string& bytes) const {
    const auto table = read(name, bytes);
    return table ? "no error" : table.error().to_string();
  }

  TemporaryDirectory directory_;
};

TEST_F(FileFormatTest, TablesReadBackTheSameInEachFormat) {
  const Table all = table_of(two_ticks());
  for (const std::string name : {"a.csv", "a.mat"}) {
    ASSERT_TRUE(write(name));
    const auto table = read(name);
    ASSERT_TRUE(table) << table.error().to_string();
    ASSERT_EQ(table->size(), all.size()) << name;
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(identifier_of((*table)[i].name), identifier_of(all[i].name));
      ASSERT_EQ((*table)[i].values.size(), 2u);
      for (std::size_t row = 0; row < 2; ++row) {
        const auto read = static_cast<float>((*table)[i].values[row]);
        const auto written = static_cast<float>(all[i].values[row]);
        EXPECT_TRUE(read == written || (std::isnan(read) && std::isnan(written)))
            << name << " " << all[i].name;
      }
    }
    const Column& parameter = (*table)[inputs_of(two_ticks()).size() - 1];
    EXPECT_THAT(parameter.name, HasSubstr("MC_ROLL_P"));
    EXPECT_THAT(parameter.values, ElementsAre(6.5, 7));
  }
}

TEST_F(FileFormatTest, TheFirstBytesChooseItAndElseTheEnding) {
  ASSERT_TRUE(write("a.mat"));
  ASSERT_TRUE(write("a.ulog"));
  for (const std::string name : {"a.mat", "a.ulog"}) {
    const FileFormat& format = format_of(path(name));
    EXPECT_NE(format.name, "csv");
    std::filesystem::rename(path(name), path("b.csv"));
    EXPECT_EQ(format_of(path("b.csv")).name, format.name);
  }
  EXPECT_EQ(format_of(path("missing.ulg")).name, "ulg");
  EXPECT_EQ(format_of(path("missing")).name, "csv");
}

TEST_F(FileFormatTest, WhatAFormatCannotDoIsAnError) {
  ASSERT_TRUE(write("a.mat"));
  EXPECT_EQ(read_as<&FileFormat::open>(path("a.mat"), TraceNeed::outputs).error().message,
            "is a MAT file; this needs one of the format csv");
  EXPECT_EQ(read_as<&FileFormat::read_signals>(path("a.mat")).error().message,
            "is a MAT file; this needs one of the format csv or ulg");
}

TEST_F(FileFormatTest, ADamagedMatFileIsAnErrorOrLacksVariables) {
  ASSERT_TRUE(write("a.mat"));
  const std::string whole = read_file(path("a.mat")).value();
  const std::size_t columns = read("a.mat")->size();
  for (std::size_t size = 0; size < whole.size(); size += 61) {
    const auto table = read("b.mat", whole.substr(0, size));
    EXPECT_TRUE(!table || table->size() < columns);
  }
  EXPECT_THAT(error("b.mat", "timestamp,x\n"), HasSubstr("is no MAT file"));
}

TEST_F(FileFormatTest, AMatFileThatEndsInsideAVariableIsCutOff) {
  ASSERT_TRUE(write("a.mat"));
  const std::string whole = read_file(path("a.mat")).value();
  const std::size_t columns = read("a.mat")->size();
  ASSERT_EQ(error("b.mat", whole), "no error");
  for (std::size_t missing = 1; missing < 300; ++missing) {
    const auto table = read("b.mat", whole.substr(0, whole.size() - missing));
    // A file that ends between two variables has fewer columns.
    const std::string error = table ? "" : table.error().to_string();
    EXPECT_TRUE(table ? table->size() < columns : error.find("is cut off") != std::string::npos)
        << missing << " bytes are missing; " << error;
  }
}

// Of "MAT-File Format", MathWorks: the size of the file's header and of an element's tag, and where
// an element of this file has its first dimension (after the tags of element, flags and
// dimensions).
constexpr std::size_t mat_header = 128, mat_tag = 8, mat_dimension_at = 8 + 16 + 8;

std::uint32_t mat_size_at(const std::string& bytes, std::size_t element) {
  std::uint32_t size = 0;
  std::memcpy(&size, &bytes[element + 4], sizeof size);
  return size;
}

// With three values instead of two in the dimensions of each variable.
std::string with_a_third_row(std::string mat) {
  for (std::size_t at = mat_header; at < mat.size(); at += mat_tag + mat_size_at(mat, at)) {
    mat[at + mat_dimension_at] = 3;
  }
  return mat;
}

// The same file as MATLAB writes it, each variable compressed; `missing` bytes of it left out.
std::string with_compressed_variables(const std::string& mat, std::size_t missing = 0) {
  std::string result = mat.substr(0, mat_header);
  for (std::size_t at = mat_header; at < mat.size(); at += mat_tag + mat_size_at(mat, at)) {
    const std::size_t size = mat_tag + mat_size_at(mat, at);
    std::vector<Bytef> compressed(::compressBound(size));
    uLongf count = compressed.size();
    ::compress(compressed.data(), &count, reinterpret_cast<const Bytef*>(&mat[at]), size);
    const std::uint32_t tag[] = {15, static_cast<std::uint32_t>(count - missing)};
    result.append(reinterpret_cast<const char*>(tag), sizeof tag);
    result.append(compressed.begin(),
                  compressed.begin() + static_cast<std::ptrdiff_t>(count - missing));
  }
  return result;
}

// libmatio returns zeros, or other bytes of the file or of its memory.
TEST_F(FileFormatTest, AMatVariableWithFewerValuesThanItsDimensionsIsAnError) {
  ASSERT_TRUE(write("a.mat"));
  const std::string whole = read_file(path("a.mat")).value();
  const std::size_t columns = read("a.mat")->size();
  const auto compressed = read("b.mat", with_compressed_variables(whole));
  ASSERT_TRUE(compressed) << compressed.error().to_string();
  EXPECT_EQ(compressed->size(), columns);
  const std::string short_by_one = with_a_third_row(whole);
  for (const std::string& damaged : {short_by_one, with_compressed_variables(short_by_one)}) {
    EXPECT_THAT(error("b.mat", damaged),
                AllOf(HasSubstr("b.mat: "), HasSubstr("the variable `timestamp` has 2 values, but "
                                                      "its dimensions are 3 x 1")));
  }
  EXPECT_THAT(error("b.mat", with_compressed_variables(whole, 9)),
              HasSubstr("a compressed variable is damaged"));
}

// Those with doubles, floats, and bytes, whose values are in the tag.
TEST_F(FileFormatTest, EachVariableOfAMatFileIsChecked) {
  ASSERT_TRUE(write("a.mat"));
  const std::string whole = read_file(path("a.mat")).value();
  std::size_t variables = 0;
  for (std::size_t at = mat_header; at < whole.size(); at += mat_tag + mat_size_at(whole, at)) {
    std::string damaged = whole;
    for (const char rows : {'\0', '\1', '\3'}) {
      damaged[at + mat_dimension_at] = rows;
      EXPECT_THAT(error("b.mat", damaged), HasSubstr("but its dimensions are"));
    }
    ++variables;
  }
  EXPECT_EQ(variables, table_of(two_ticks()).size());
}

TEST_F(FileFormatTest, ACsvTableMayHaveRowNumbersWithoutAName) {
  const auto table = read("a.csv", ",x,y\n0,1.5,+2e3\n1,nan,-inf\n");
  ASSERT_TRUE(table) << table.error().to_string();
  ASSERT_EQ(table->size(), 3u);
  EXPECT_EQ((*table)[1].name, "x");
  EXPECT_TRUE(std::isnan((*table)[1].values[1]));
  EXPECT_THAT((*table)[2].values, ElementsAre(2000, -std::numeric_limits<double>::infinity()));
  EXPECT_THAT(error("a.csv", "x,y\n1,2,3\n"), HasSubstr("a.csv:2:5"));
  EXPECT_THAT(error("a.csv", "x,y\n1,yes\n"), HasSubstr("`yes` is not a number for y"));
}

}  // namespace
}  // namespace attest
