// Finds the samples of a log whose time is absurd, for example because one bit of it is wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/ulog/reader.hpp"

namespace attest::ulog {

// How the time of a sample fits those of the samples around it in the file.
enum class TimeFit : std::uint8_t {
  plausible,
  too_late,  // far after the samples before it, and after most of those that follow
  too_early  // the first sample of its topic, and far before those that follow. An event, such as a
             // landing, may really be from long before the log.
};

// Checks the samples of all topics in the order of the file, so that each reading of a log finds
// the same. After a gap of the log the samples that follow are as late, too, so they are plausible.
class TimeCheck {
 public:
  // Checks the data in `message`. Reads ahead if necessary, and then reads the same data into
  // `message` again. A topic without a timestamp is plausible. REQUIRES: `reader` read `message`
  // last, and checked all data before it. Errors: the file cannot be read.
  Result<TimeFit> check(Reader& reader, Message& message);

 private:
  struct Topic {
    bool is_located = false;
    int early = 0;  // samples that were too early
    std::optional<Column> time = {};
    std::optional<std::uint64_t> last_us = {};  // of its last plausible sample
  };
  Topic& topic_of(const Reader& reader, const Subscription& subscription);
  // The times of samples that follow, sorted. `index`: of the subscription of the sample in
  // question.
  Result<std::vector<std::uint64_t>> read_ahead(Reader& reader, std::size_t index,
                                                std::uint64_t time_us);

  std::vector<Topic> topics_;               // by subscription
  std::optional<std::uint64_t> newest_us_;  // of all plausible samples
};

}  // namespace attest::ulog
