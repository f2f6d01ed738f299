// Counts the samples of a log that are left out, for one note a reason: a jump of the clock may
// concern all topics.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace attest::ulog {

class LeftOutSamples {
 public:
  static constexpr const char* not_later = "the timestamps do not increase";
  static constexpr const char* absurd = "the time does not fit the samples around it";
  static constexpr const char* without_time = "the topic has no timestamp";

  // `count` may be 0. A second call for the same topic and reason replaces the first, because
  // several modules may have the same topic.
  void add(const std::string& why, const std::string& topic, std::size_t count);
  // One for each reason that has samples. Names the topics with the most samples.
  std::vector<std::string> notes() const;

 private:
  std::map<std::string, std::map<std::string, std::size_t>> counts_;  // why -> topic -> samples
};

}  // namespace attest::ulog
