// Finds the samples of a log whose time is absurd, for example because one bit of it is wrong.
#pragma once

#include <algorithm>
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

// The logger writes a sample within milliseconds. A gap of all topics may be longer, so the samples
// that follow decide. A smaller jump costs the topic no more samples than those of this time.
inline constexpr std::uint64_t most_ahead_us = 50'000;

// Checks the samples of all topics in the order of the file, so that each reading of a log finds
// the same. After a gap of the log the samples that follow are as late, too, so they are plausible.
class TimeCheck {
 public:
  // Checks the data in `message`. Reads ahead if necessary, and then reads the same data into
  // `message` again. A topic without a timestamp is plausible. REQUIRES: `reader` read `message`
  // last, and checked all data before it. Errors: the file cannot be read.
  Result<TimeFit> check(Reader& reader, Message& message) {
    return fits_at_once(std::get<Data>(message)) ? TimeFit::plausible
                                                 : check_closely(reader, message);
  }
  // Does the same if the samples before this one show that its time is plausible, as for nearly all
  // samples. False, and nothing is changed: it is far after them, or the first of its topic.
  bool fits_at_once(const Data& data) {
    const std::size_t index = data.subscription->index;
    if (index >= topics_.size() || !topics_[index].last_us) return false;
    Topic& topic = topics_[index];
    const auto time_us = load<std::uint64_t>(data.bytes.data() + topic.time->offset);
    if (time_us > *newest_us_ && time_us - *newest_us_ > most_ahead_us) return false;
    topic.last_us = time_us;
    newest_us_ = std::max(*newest_us_, time_us);
    return true;
  }

 private:
  struct Topic {
    bool is_located = false;
    int early = 0;  // samples that were too early
    std::optional<Column> time = {};
    std::optional<std::uint64_t> last_us = {};  // of its last plausible sample
  };
  Result<TimeFit> check_closely(Reader& reader, Message& message);
  Topic& topic_of(const Reader& reader, const Subscription& subscription);
  // The times of samples that follow, sorted. `index`: of the subscription of the sample in
  // question.
  Result<std::vector<std::uint64_t>> read_ahead(Reader& reader, std::size_t index,
                                                std::uint64_t time_us);

  std::vector<Topic> topics_;               // by subscription
  std::optional<std::uint64_t> newest_us_;  // of all plausible samples
};

}  // namespace attest::ulog
