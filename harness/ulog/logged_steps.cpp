#include "harness/ulog/logged_steps.hpp"

#include <optional>
#include <utility>

#include "harness/ulog/own_topics.hpp"

namespace attest::ulog {
namespace {

// So many steps wait for their outputs. An output is logged a few steps after its own at most.
constexpr std::size_t most_last_steps = 1000;

// Gives each step the samples of one input topic.
class PendingRows {
 public:
  PendingRows(LogSeries& series, Module module, LogRules rules)
      : series_(series), module_(module), rules_(rules) {
    updated_ = channels()[updated_channel(module, series.name())].bit;
    is_shared_ = find_channel(module, "out/" + series.name() + ".published").has_value();
  }

  // Copies the last sample of the topic before the step at `time` to `sample`, if it is newer than
  // that of the previous call. Forgets the samples up to there. `last`: the sample of the previous
  // step; at the first step, the sample before it.
  // Returns its time.
  std::optional<std::uint64_t> advance_to(std::uint64_t time, const Sample& last, Sample& sample) {
    std::optional<std::size_t> newest;
    for (bool is_first = true; next_ < series_.size() && is_there(next_, time); is_first = false) {
      const std::size_t row = next_++;
      if (!is_first || !is_own(row, last)) newest = row;
    }
    std::optional<std::uint64_t> newest_us;
    if (newest) {
      series_.copy(*newest, sample);
      sample.in.updated |= updated_;
      newest_us = series_.time(*newest);
    }
    series_.forget_before(next_);
    return newest_us;
  }

  const std::string& name() const { return series_.name(); }

  // Forgets all samples, because no step follows.
  void forget() { series_.forget_before(series_.size()); }

 private:
  bool is_there(std::size_t row, std::uint64_t time) const {
    return series_.time(row) < time || (rules_ != LogRules::cascade && series_.time(row) == time);
  }

  // Whether the unit itself published `row`, the first sample after the step of `last`. The unit
  // publishes once in a step, soon after the step's time.
  bool is_own(std::size_t row, const Sample& last) const {
    return rules_ == LogRules::cascade && last.in.timestamp > 0 &&
           series_.time(row) - last.in.timestamp <= latest_answer_us && is_shared_ &&
           publishes(module_, series_.name(), last);
  }

  LogSeries& series_;
  Module module_;
  LogRules rules_;
  std::uint32_t updated_;
  bool is_shared_;  // the unit publishes the topic, too
  std::size_t next_ = 0;
};

}  // namespace

// The inputs of a unit, step by step.
class LoggedSteps::Inputs {
 public:
  // `first`: the sample before the first step.
  Inputs(LoggedModule& from)
      : steps_(from.log.steps()),
        setpoint_topic_(info_of(from.log.module()).setpoint_topic),
        last_(from.first) {
    for (LogSeries& series : from.log.series()) {
      if (series.is_output() || &series == &steps_) continue;
      topics_.emplace_back(series, from.log.module(), from.rules);
    }
  }

  // Adds the next step. REQUIRES: the series have the step, and all samples up to its time.
  void next(PairedSteps& steps) {
    const std::uint64_t time = steps_.time(tick_);
    steps.push_back({last_, steps_.sample_time(tick_), 0});
    Sample& now = steps.back().sample;
    for (PendingRows& rows : topics_) {
      const auto newest_us = rows.advance_to(time, last_, now);
      if (newest_us && rows.name() == setpoint_topic_) setpoint_us_ = *newest_us;
    }
    steps_.copy(tick_++, now);
    steps_.forget_before(tick_);
    now.in.timestamp = time;
    steps.back().setpoint_us = setpoint_us_;
    last_ = now;
    last_.in.updated = 0;
  }

  void forget() {
    for (PendingRows& rows : topics_) rows.forget();
  }

 private:
  LogSeries& steps_;
  std::string_view setpoint_topic_;
  std::uint64_t setpoint_us_ = 0;
  std::vector<PendingRows> topics_;
  Sample last_;  // the inputs of the last step, of which none is new
  std::size_t tick_ = 0;
};

LoggedSteps::LoggedSteps(LoggedModule& from, SampleReader reader)
    : from_(from), reader_(std::move(reader)), inputs_(std::make_unique<Inputs>(from)) {
  for (LogSeries* const series : from.outputs) {
    outputs_.emplace_back(from.log.module(), *series, from.has_sample_times, from.rules);
  }
}
LoggedSteps::LoggedSteps(LoggedSteps&&) noexcept = default;
LoggedSteps::~LoggedSteps() = default;

Result<LoggedSteps> LoggedSteps::open(LoggedModule& from) {
  auto reader = SampleReader::open(from.file, from.log);
  if (!reader) return tl::unexpected(reader.error());
  return LoggedSteps(from, *std::move(reader));
}

Result<const PairedStep*> LoggedSteps::next() {
  while (read_ < from_.steps && last_steps_.size() < most_last_steps) {
    if (auto read = read_step(); !read) return tl::unexpected(read.error());
  }
  PairedStep& step = *last_steps_.begin();
  for (const PairedOutput& output : outputs_) output.repeat(last_.sample, step.sample);
  last_ = step;
  last_steps_.drop_front(1);
  return &last_;
}

Result<void> LoggedSteps::read_step() {
  if (read_ == 0) {
    if (auto read = read_outputs_before(0); !read) return read;
  }
  inputs_->next(last_steps_);
  return ++read_ < from_.steps ? read_outputs_before(read_) : read_to_end();
}

// Reads all samples up to the step, and pairs the outputs before it.
Result<void> LoggedSteps::read_outputs_before(std::size_t step) {
  const LogSeries& steps = std::as_const(from_.log).steps();
  while (steps.size() <= step) {
    const auto more = reader_.read_more();
    if (!more) return tl::unexpected(more.error());
    if (!*more && steps.size() <= step) return fail_at(from_.file, "changed while it was read");
  }
  if (auto read = reader_.read_until(steps.time(step)); !read) return read;
  for (PairedOutput& output : outputs_) output.pair_until(steps.time(step), last_steps_);
  return {};
}

Result<void> LoggedSteps::read_to_end() {
  for (bool goes_on = true; goes_on;) {
    const auto more = reader_.read_more();
    if (!more) return tl::unexpected(more.error());
    for (PairedOutput& output : outputs_) output.pair_until({}, last_steps_);
    inputs_->forget();
    goes_on = *more;
  }
  return {};
}

}  // namespace attest::ulog
