// What the columns of a unit's CSV trace are.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/csv_rows.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// A row in memory is a Sample and the values of the parameter columns.
inline constexpr std::size_t parameters_offset = sizeof(Sample);

struct CsvLayout {
  std::vector<CsvColumn> columns;
  std::vector<std::string> parameters;
  ChannelSet present;
  std::string profile;               // empty: no column says it
  std::vector<std::string> ignored;  // names of columns
};

// Errors: the file is a golden (golden/README.md).
Result<void> refuse_golden(const CsvRows& rows);

// Errors: a golden; an unknown column, or one of another module.
Result<CsvLayout> layout_of(const CsvRows& rows, Module module, TraceNeed need);

// Errors: a channel that is needed is not in `present`.
Result<void> check_need(const ChannelSet& present, TraceNeed need, const std::string& file);

}  // namespace attest
