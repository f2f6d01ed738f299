#include "harness/ulog/left_out.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace attest::ulog {
namespace {

constexpr std::size_t most_topics = 4;  // that a note names

std::string samples(std::size_t count) {
  return fmt::format("{} sample{}", count, count == 1 ? "" : "s");
}

}  // namespace

void LeftOutSamples::add(const std::string& why, const std::string& topic, std::size_t count) {
  if (count > 0) counts_[why][topic] = count;
}

std::vector<std::string> LeftOutSamples::notes() const {
  std::vector<std::string> notes;
  for (const auto& [why, topics] : counts_) {
    if (topics.size() == 1) {
      const auto& [topic, count] = *topics.begin();
      notes.push_back(fmt::format("{} of {} left out, because {}", samples(count), topic, why));
      continue;
    }
    std::vector<std::pair<std::string, std::size_t>> most(topics.begin(), topics.end());
    std::stable_sort(most.begin(), most.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    std::size_t all = 0;
    std::vector<std::string> names;
    for (const auto& [topic, count] : most) {
      all += count;
      if (names.size() < most_topics) names.push_back(fmt::format("{} of {}", count, topic));
    }
    const std::size_t others = most.size() - names.size();
    notes.push_back(fmt::format("{} of {} topics left out, because {}: {}{}", samples(all),
                                most.size(), why, fmt::join(names, ", "),
                                others > 0 ? fmt::format(", and of {} more", others) : ""));
  }
  return notes;
}

}  // namespace attest::ulog
