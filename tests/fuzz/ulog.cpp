// ULog files. Each message that the reader gives lies within the file and after the one before it,
// and each field of its data can be read. A second reading gives the same. A flight that was read
// has steps at increasing times, and an output where one is paired with the step.
#include <string>

#include "harness/ulog/flight_log.hpp"
#include "harness/ulog/reader.hpp"
#include "harness/ulog/single_steps.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace attest::fuzz {
namespace {

std::uint64_t sum_of(const ulog::Message& message) {
  std::uint64_t sum = message.index();
  if (const auto* const data = std::get_if<ulog::Data>(&message)) {
    for (const ulog::Field& leaf : data->subscription->format->leaves) {
      require(leaf.offset + leaf.count * ulog::bytes_of(leaf.type) <= data->bytes.size(),
              "a field lies in its data");
      sum += ulog::load_as<double>(leaf.type, data->bytes.data() + leaf.offset) != 0;
    }
  }
  if (const auto* const each = std::get_if<ulog::KeyValue>(&message)) {
    for (const char byte : each->bytes) sum += static_cast<unsigned char>(byte);
  }
  if (const auto* const line = std::get_if<ulog::LogLine>(&message)) {
    for (const char byte : line->text) sum += static_cast<unsigned char>(byte);
  }
  return sum;
}

std::uint64_t sum_of_log(const std::filesystem::path& file, std::size_t size) {
  auto reader = ulog::Reader::open(file);
  if (!reader) {
    require_readable(reader.error(), file);
    return 0;
  }
  std::uint64_t sum = 0, last = 0;
  ulog::Message message;
  while (true) {
    const auto more = reader->next(message);
    require(more.has_value(), "the file can be read to its end");
    if (!*more) break;
    require(reader->offset() > last && reader->offset() < size, "the messages follow one another");
    last = reader->offset();
    sum += sum_of(message);
  }
  for (const ulog::Damage::Finding& finding : reader->damage().first) {
    require_readable(finding.message);
    require(finding.offset < size || size == 16, "damage has a place in the file");
  }
  if (!reader->subscriptions().empty()) {
    const auto found = reader->find(reader->subscriptions().front().topic, 0, "timestamp");
    if (!found) require_readable(found.error(), file);
  }
  return sum;
}

void check_unit(const LoggedUnit& unit) {
  if (!unit.not_judged.empty()) require_readable(unit.not_judged);
  require(unit.setpoints.size() == unit.trace.samples.size(), "each tick has what is known of it");
  std::uint64_t last = 0;
  for (const Sample& sample : unit.trace.samples) {
    require(sample.in.timestamp > last || &sample == unit.trace.samples.data(),
            "the times of steps increase");
    last = sample.in.timestamp;
  }
  for (const LoggedOutput& output : unit.outputs) {
    const auto flag = find_channel(unit.module, "out/" + output.topic + ".published");
    std::size_t published = 0;
    for (const Sample& sample : unit.trace.samples) {
      published += value_of(channels()[*flag], sample) != 0 ? 1 : 0;
    }
    require(published == output.paired && output.paired <= output.samples,
            "a step has an output if one is paired with it");
  }
}

void check_single_steps(const LoggedUnit& unit) {
  if (!info_of(unit.module).is_of_cascade()) return;
  const auto steps = single_steps_of(unit);
  require(steps.has_value(), "the ticks of a unit in memory can be read");
  Trace all;
  require(steps->ticks->next_part(whole_trace, all).has_value(), "the single steps can be read");
  const SingleSteps& found = *steps->single_steps;
  require(all.samples.size() == found.with_own_setpoint + found.with_given_setpoint,
          "the single steps are counted");
  require(all.samples.size() <= unit.trace.samples.size(), "a single step is a step");
}

void check_flight(const std::filesystem::path& file) {
  const auto log = read_flight_log(file);
  if (!log) return require_readable(log.error(), file);
  for (const std::string& note : log->notes) require_readable(note);
  for (const LoggedUnit& unit : log->units) {
    check_unit(unit);
    check_single_steps(unit);
  }
}

}  // namespace
}  // namespace attest::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace attest;
  const auto file = fuzz::write("log.ulg", fuzz::text_of(data, size));
  fuzz::require(fuzz::sum_of_log(file, size) == fuzz::sum_of_log(file, size), "the same values");
  fuzz::check_flight(file);
  return 0;
}
