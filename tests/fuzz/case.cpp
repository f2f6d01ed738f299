// Case files. A case that parses has run configurations and inputs at its rates; reading it twice
// gives the same inputs.
#include <regex>
#include <string>

#include "harness/casefile/parse.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/loop/case_timing.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace attest::fuzz {
namespace {

constexpr std::int64_t most_ticks = 3000;  // so that an input takes milliseconds

// The text decides the folder, because a case must be in the folder of its profile and group.
std::string first_match(const std::string& text, const std::regex& pattern) {
  std::smatch match;
  return std::regex_search(text, match, pattern) ? match[1].str() : "other";
}

std::filesystem::path write_case(const std::string& text) {
  static const std::regex profile(R"(\nprofiles = \["(px4-v1\.\d{1,2}\.\d)\")");
  static const std::regex group(R"(\ngroup = "([a-z_]{1,24})\")");
  static const bool has_models = [] {
    std::filesystem::create_symlink(ATTEST_SOURCE_DIR "/models", folder() / "models");
    return true;
  }();
  require(has_models, "there are models");
  const std::string head = text.substr(0, 500);
  return write(std::filesystem::path("cases") / first_match(head, profile) /
                   first_match(head, group) / "roll.toml",
               text);
}

void require_same_inputs(const Case& the_case, const Case& again, const Rate& rate) {
  const Trace first = stimulate(the_case, rate);
  const Trace second = stimulate(again, rate);
  require(first.samples.size() == second.samples.size(), "the same ticks");
  require(first.present == second.present, "the same channels");
  std::uint64_t last = 0;
  for (std::size_t i = 0; i < first.samples.size(); ++i) {
    const std::uint64_t now = first.samples[i].in.timestamp;
    require(now == second.samples[i].in.timestamp, "the same timestamps");
    require(i == 0 || now > last, "timestamps increase");
    last = now;
  }
}

void use_flight(const Case& the_case, const LoopRate& rate) {
  flight_timing(the_case, rate);
  const Timeline timeline = timeline_of(the_case, rate.motor_unit);
  task_times(the_case.flight->saturation, timeline);
  if (the_case.flight->battery) task_times(the_case.flight->battery->timing, timeline);
}

void use(const Case& the_case, const Case& again) {
  require(!the_case.configurations().empty(), "there is a run configuration");
  for (const LoopRate& rate : {the_case.rates.front(), the_case.rates.back()}) {
    if (tick_count(the_case.duration, rate.motor_unit) > most_ticks) continue;
    require_same_inputs(the_case, again, rate.motor_unit);
    if (the_case.flight) use_flight(the_case, rate);
  }
}

}  // namespace
}  // namespace attest::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace attest;
  const auto file = fuzz::write_case(std::string(fuzz::text_of(data, size)));
  const auto the_case = parse_case(file);
  if (!the_case) {
    fuzz::require_readable(the_case.error(), file);
    return 0;
  }
  const auto again = parse_case(file);
  fuzz::require(again.has_value(), "a case that parses does so again");
  fuzz::use(*the_case, *again);
  return 0;
}
