// The samples of one topic of a log, and their places in a Sample.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/trace/channels.hpp"
#include "harness/ulog/reader.hpp"

namespace attest::ulog {

class LogSeries {
 public:
  // Of the topic's instance 0. An input vehicle_rates_setpoint is the instance 1, because the
  // controller itself publishes the instance 0 (trace_log.hpp).
  LogSeries(std::string_view topic, bool is_output);

  // `field`: "q[0]", the value of that channel.
  void add_field(std::string field, std::size_t channel);

  const std::string& topic() const { return topic_; }
  bool is_output() const { return is_output_; }
  const std::vector<std::size_t>& channels() const { return channels_; }

  bool accepts(const Subscription& subscription) const {
    return subscription.multi_id == multi_id_ && subscription.topic == topic_;
  }
  // Leaves out a sample without a timestamp, or whose timestamp is not after the one before.
  // REQUIRES: accepts it.
  void add(const Reader& reader, const Data& data);

  std::size_t size() const { return times_.size(); }
  std::size_t left_out() const { return left_out_; }
  // The same, because the topic has no timestamp. Not counted in left_out().
  std::size_t without_time() const { return without_time_; }
  std::uint64_t time(std::size_t row) const { return times_[row]; }  // us
  // Of the control_state that an output answers; empty if the topic has no such field.
  std::optional<std::uint64_t> sample_time(std::size_t row) const;
  // Index of the first sample after that time; size() if there is none.
  std::size_t first_after(std::uint64_t time) const;

  // The fields that the log's topic does not have. REQUIRES: size() > 0.
  std::vector<std::string> missing_fields() const;
  // The channels of the fields that it has. REQUIRES: size() > 0.
  std::vector<std::size_t> logged_channels() const;

  // Writes the channels of a sample.
  void copy(std::size_t row, Sample& to) const;
  // Writes those of the last sample up to `time`, if it is newer than that of the call before.
  // REQUIRES: times of calls do not decrease.
  bool advance_to(std::uint64_t time, Sample& to);

 private:
  void locate(const Reader& reader, const Subscription& subscription);

  std::string topic_;
  bool is_output_;
  std::uint8_t multi_id_;
  std::vector<std::string> fields_;
  std::vector<std::size_t> channels_;   // of fields_
  std::optional<std::size_t> located_;  // subscription of the places below
  std::optional<Column> time_, sample_time_;
  std::vector<std::optional<Column>> columns_;  // of fields_
  std::vector<std::uint64_t> times_, sample_times_;
  std::vector<float> values_;  // of a sample after the other
  std::size_t left_out_ = 0, without_time_ = 0;
  std::size_t next_ = 0;  // of advance_to
};

}  // namespace attest::ulog
