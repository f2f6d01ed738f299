// The samples of one topic of a log, and their places in a Sample.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/trace/channels.hpp"
#include "harness/ulog/log_topics.hpp"
#include "harness/ulog/reader.hpp"

namespace attest::ulog {

// A vector that is filled at its end, and emptied at its front a part at a time.
template <typename T>
class Queue {
 public:
  void push_back(const T& value) { values_.push_back(value); }
  // Returns `count` new elements, to be written.
  T* append(std::size_t count) {
    values_.resize(values_.size() + count);
    return values_.data() + values_.size() - count;
  }
  void drop_front(std::size_t count) {
    begin_ += count;
    if (begin_ == values_.size()) return clear();
    // Then each element moves at most once on average. A few bytes are not worth a move.
    constexpr std::size_t few_bytes = 4096;
    if (2 * begin_ < values_.size() || begin_ * sizeof(T) < few_bytes) return;
    values_.erase(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(begin_));
    begin_ = 0;
  }
  void clear() {
    values_.clear();
    begin_ = 0;
  }
  std::size_t size() const { return values_.size() - begin_; }
  bool empty() const { return size() == 0; }
  const T& operator[](std::size_t index) const { return values_[begin_ + index]; }
  const T& back() const { return values_.back(); }
  T& back() { return values_.back(); }
  T* begin() { return values_.data() + begin_; }
  T* end() { return values_.data() + values_.size(); }

 private:
  std::vector<T> values_;
  std::size_t begin_ = 0;
};

class LogSeries {
 public:
  explicit LogSeries(LogTopic topic);

  const LogTopic& topic() const { return topic_; }
  const std::string& name() const { return topic_.name; }
  bool is_output() const { return topic_.is_output; }

  // True for this topic in the instance LogTopic::multi_id, as in a log of attest.
  bool accepts(const Subscription& subscription) const {
    return subscription.multi_id == topic_.multi_id && subscription.topic == topic_.name;
  }
  // From now on, accepts() is true only for instance 0, where PX4 logs the samples of every
  // publisher.
  void accept_every_publisher() { topic_.multi_id = 0; }

  // Finds the fields of the topic in the subscription's format. REQUIRES: accepts(subscription).
  void locate(const Reader& reader, const Subscription& subscription);
  // Counts a sample. False: it is left out, because it has no timestamp, or because its timestamp
  // is not after that of the sample before. REQUIRES: accepts() its subscription.
  bool count(const Reader& reader, const Data& data);
  // Counts a sample, and keeps it unless it is left out.
  void add(const Reader& reader, const Data& data);
  // Counts a sample that is left out because its time is absurd.
  void leave_out_absurd() { ++absurd_, ++left_out_; }
  // Ends the keeping of all samples before `row`. REQUIRES: row <= size().
  void forget_before(std::size_t row) {
    if (row > forgotten_) forget(row - forgotten_);
  }
  // Forgets and counts no sample, so that the log can be read again.
  void restart();

  // The samples so far. They are counted from 0 on, also when earlier ones are forgotten.
  std::size_t size() const { return size_; }
  std::size_t left_out() const { return left_out_; }
  std::size_t absurd() const { return absurd_; }  // of left_out()
  // Samples left out because the topic has no timestamp. Not counted in left_out().
  std::size_t without_time() const { return without_time_; }
  std::uint64_t newest_time() const { return newest_; }  // us; 0 without a sample
  // Whether every sample has the field `timestamp_sample`, and this time never decreases.
  bool has_sample_times() const { return has_sample_times_; }

  // REQUIRES, here and in copy(): `row` was added and not forgotten.
  std::uint64_t time(std::size_t row) const { return times_[row - forgotten_].published_us; }
  // The field `timestamp_sample`: the time of the sensor sample behind this sample. Empty if the
  // topic has no such field.
  std::optional<std::uint64_t> sample_time(std::size_t row) const {
    return times_[row - forgotten_].sampled_us;
  }

  // Whether the log has the topic, perhaps without samples.
  bool is_located() const { return located_.has_value(); }
  // The fields that the log's topic does not have. REQUIRES: is_located().
  std::vector<const LogField*> missing_fields() const;
  // The channels of the fields that the log's topic has. REQUIRES: is_located().
  std::vector<std::size_t> logged_channels() const;

  // Writes the values of sample `row`. A field that the log does not have is LogField::if_absent.
  void copy(std::size_t row, Sample& to) const;
  // Copies the values of the topic.
  void copy_fields(const Sample& from, Sample& to) const;

 private:
  // Where a field is in the log; without `column`, the log does not have it. With `state`, the
  // field is a flag, which is true if the column's value is this state.
  struct Place {
    std::optional<Column> column;
    std::optional<std::uint8_t> state;
  };

  // Successive bytes that are the same in the two places of a copy.
  struct SameBytes {
    std::size_t from, to, count;
  };
  struct Times {
    std::uint64_t published_us;
    std::optional<std::uint64_t> sampled_us;
  };

  Place find_place(const Reader& reader, const Subscription& subscription,
                   const LogField& field) const;
  static void add(const SameBytes& more, std::vector<SameBytes>& parts);
  static void copy_all(const std::vector<SameBytes>& parts, const char* from, char* to);
  std::uint64_t bits_of(const char* data, std::size_t field) const;
  void forget(std::size_t rows);

  LogTopic topic_;
  std::optional<std::size_t> located_;  // index of the subscription of these places
  std::optional<Column> time_, sample_time_;
  std::vector<Place> places_;           // of the topic's fields
  std::vector<SameBytes> of_row_;       // for copy()
  std::vector<std::size_t> converted_;  // the fields that are not in of_row_
  std::vector<SameBytes> of_sample_;    // for copy_fields()
  std::size_t size_ = 0, left_out_ = 0, absurd_ = 0, without_time_ = 0;
  std::uint64_t newest_ = 0;
  std::optional<std::uint64_t> newest_sample_time_;
  bool has_sample_times_ = true;

  std::size_t forgotten_ = 0;  // rows; the others are here
  Queue<Times> times_;
  std::size_t row_bytes_ = 0;
  Queue<char> rows_;  // the data of each sample, as in the log
};

}  // namespace attest::ulog
