// The steps of a flight's log, of which cases are made.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/casefile/log_case.hpp"
#include "harness/cli/read_log.hpp"
#include "harness/loop/open_loop.hpp"

namespace attest::cli {

// The steps of a unit of the log, for case_of_log(), which has at least two. Of a unit of v1.14 to
// v1.18 that lacks too many steps, they are the single steps. Fewer than two if the log has too
// little of the unit; then, and for single steps, a note is added to `log.notes`. A log of the
// controller may lack steps, because the expected outputs of its case come from a reference that
// starts at the same tick.
Result<Trace> steps_of(const LoggedUnit& unit, FlightLog& log);

// A case, at a loop rate that is near that of the log.
struct LogWindow {
  Case the_case;
  Rate rate;
};

// Cases of some hundred ticks, of all units of the log for which `is_wanted` is true. They are
// spread over the log; a unit has at most 100. Adds notes to `log.notes`. Errors: no such unit has
// a case, with the reason.
Result<std::vector<LogWindow>> windows_of(
    FlightLog& log, const std::string& file,
    const std::function<bool(const ModuleUnderTest&)>& is_wanted);

}  // namespace attest::cli
