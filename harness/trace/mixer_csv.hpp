// The columns of mixer traces as recorded from the firmware: the inputs and outputs of a mixer, one
// row per call. open_csv() reads them, with the same rules for numbers and errors.
//
// Columns: roll, pitch, yaw, thrust, delta_out_max, out[0] ... out[rotors - 1], lower_limit,
// upper_limit, yaw_limit. The geometry is not in the file: provenance.toml has it under [mixers].
#pragma once

#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/channels.hpp"
#include "harness/trace/csv_rows.hpp"

namespace attest {

// Whether the header has a column that only mixer traces have.
bool has_mixer_columns(const CsvRows& rows);

// Where each column of the header goes in a Sample. Adds their channels to `present`. Errors: an
// unknown or missing column, a number of out[] columns other than 4, 6 and 8.
Result<std::vector<CsvColumn>> mixer_columns_of(const CsvRows& rows, ChannelSet& present);

}  // namespace attest
