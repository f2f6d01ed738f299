// The results of earlier runs, which are kept in files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/controller/elementary/sweep.hpp"

namespace attest::elementary {

struct HardCase {
  const Function* f;
  Arguments at;
};

// The arguments of hard_cases.txt. Ends the program with a message if a line is malformed.
std::vector<HardCase> hard_cases();

// A line of hard_cases.txt.
std::string line_of(const HardCase& hard);

// A row of the table in RESULTS.md without its time: function, share, count, differences, hash.
std::string row_of(const Function& f, std::string_view share, const Swept& swept);

// "all", or "every 1009th".
std::string share_of(std::uint64_t every);

// Whether RESULTS.md has this row.
bool is_kept(std::string_view row);

}  // namespace attest::elementary
