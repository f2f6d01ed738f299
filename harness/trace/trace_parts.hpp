// A long trace, read part by part, so that it need not be in memory as a whole.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// As the number of ticks of next_part(): all. A reader of a file then limits its size, because the
// trace is in memory as a whole.
inline constexpr std::size_t whole_trace = std::numeric_limits<std::size_t>::max();

// So many ticks of a long trace are in memory, and go to a port in one request.
inline constexpr std::size_t ticks_at_once = 2048;

class TraceParts {
 public:
  virtual ~TraceParts() = default;

  virtual const std::string& file() const = 0;  // for messages
  virtual const ChannelSet& present() const = 0;

  // Replaces `part` by the next ticks, at most `most`. Its changes of parameters have the ticks of
  // the part, which begin at 0. Fewer ticks than `most`: the trace has ended. Errors: the trace
  // cannot be read, or is not valid.
  virtual Result<void> next_part(std::size_t most, Trace& part) = 0;

  // The next tick is then the first one. Errors: those of next_part().
  virtual Result<void> rewind() = 0;
};

// Calls `take` with each part, the tick at which it begins, and whether it is the last. Ends when
// `take` returns false. Returns the number of ticks that were read.
template <typename Take>
Result<std::size_t> for_each_part(TraceParts& trace, std::size_t most_ticks, Take take) {
  Trace part;
  std::size_t first_tick = 0;
  for (bool goes_on = true; goes_on;) {
    if (auto read = trace.next_part(most_ticks, part); !read) return tl::unexpected(read.error());
    const bool is_last = part.samples.size() < most_ticks;
    goes_on = take(std::as_const(part), first_tick, is_last) && !is_last;
    first_tick += part.samples.size();
  }
  return first_tick;
}

// The changes at `ticks` ticks from `first_tick` on, with the ticks of that part.
std::vector<ParameterChange> changes_in(const std::vector<ParameterChange>& all,
                                        std::size_t first_tick, std::size_t ticks);

// The parts of a trace that is in memory, and outlives this.
class PartsOfTrace final : public TraceParts {
 public:
  explicit PartsOfTrace(const Trace& whole) : whole_(whole) {}

  const std::string& file() const override { return whole_.source; }
  const ChannelSet& present() const override { return whole_.present; }
  Result<void> next_part(std::size_t most, Trace& part) override;
  Result<void> rewind() override {
    next_ = 0;
    return {};
  }

 private:
  const Trace& whole_;
  std::size_t next_ = 0;
};

}  // namespace attest
