// Outputs from a table, as a port's answer to the inputs of a trace.
#pragma once

#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/host/manifest.hpp"
#include "harness/host/table.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Replaces the outputs of `trace` by those of the table, row by row. Columns may be in any order,
// and their names are compared as identifiers (identifier_of()), with or without `out/`. Columns of
// outputs that the manifest lists as not recorded are not read; a flag `published` among them
// becomes 1.
// Errors, each with what to do: a missing or repeated output; fewer or more rows than ticks; times
// that are not those of the ticks, because rows are missing or in another order, or because the
// column has another unit of time; a value that the type of its channel cannot have.
// REQUIRES: the table has a column.
Result<void> set_recorded_outputs(const Table& table, const Manifest& manifest,
                                  const std::string& file, Trace& trace);

// At each tick, a topic that is not published keeps the values of the previous tick.
void keep_unpublished(Trace& trace);

// The names of the columns that are neither a signal of the module nor a parameter.
std::vector<std::string> ignored_columns(const Table& table, const Manifest& manifest,
                                         Module module);

}  // namespace attest
