// Reads a ULog, the log format of PX4, version 0 or 1, message by message, in memory that does not
// grow with its data. A reader belongs to one thread.
//
//     auto reader = ulog::Reader::open(path);
//     const auto roll = reader->find("vehicle_rates_setpoint", 0, "roll");
//     ulog::Message message;
//     while (auto more = reader->next(message)) {  // ends at an Error
//       if (!*more) break;                         // end of file
//       const auto* data = std::get_if<ulog::Data>(&message);
//       if (data && roll->is_in(*data)) use(roll->of(*data));
//     }
//
// The reader counts damage and goes on with the next intact message. A message with a wrong body is
// skipped by its length if another message seems to follow. Otherwise reading continues after the
// next sync message. If there is none, the rest of the log (or of an appended part) is not read.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <variant>

#include "harness/ulog/format.hpp"

namespace attest::ulog {

inline constexpr std::size_t head_bytes = 3;  // of a message: u16 size of its body, type

// An instance of a topic. Data messages refer to it by its number.
struct Subscription {
  std::uint16_t id;       // msg_id
  std::uint8_t multi_id;  // instance, from 0
  std::string topic;      // also the name of its format
  std::size_t index;      // in Reader::subscriptions()
  const Format* format;   // measured; null: unusable, so the data are skipped
};

// Messages. Their views are valid until the reader's next call, their pointers as long as the
// reader exists.

// D: the values of a topic, in Format::least_bytes to Format::bytes bytes.
struct Data {
  const Subscription* subscription;
  std::string_view bytes;
};

// F: defines a format. Formats::measure() may not have computed its sizes yet.
struct Defined {
  const Format* format;
};

// A: data of the subscription may follow. R: no more data of it follow.
struct Subscribed {
  const Subscription* subscription;
  bool has_ended;
};

// I, M, P and Q: a value with a name.
struct KeyValue {
  char kind;  // I: information, M: one of several with this name, P: parameter, Q: its default
  // M: 1 continues the value of the message before. Q: bit 0, default of the system; bit 1, default
  // of this vehicle. Otherwise 0.
  std::uint8_t flags;
  std::string_view name;
  Type type;  // P and Q: i32 or f32
  bool is_array;
  std::string_view bytes;  // of all elements
};

// L and C: a line for people. `level` is '0' (emergency) to '7' (debug). C has a tag, its source.
struct LogLine {
  char level;
  std::optional<std::uint16_t> tag;
  std::uint64_t timestamp;  // us
  std::string_view text;
};

// O: the logger lost messages during this time.
struct Dropout {
  std::uint16_t duration_ms;
};

// S: a pattern at which reading can start again.
struct Sync {};

using Message = std::variant<Data, Defined, Subscribed, KeyValue, LogLine, Dropout, Sync>;

// The place of a number in the data of one subscription.
struct Column {
  const Subscription* subscription;
  Type type;
  std::uint32_t offset;  // bytes
  bool is_in(const Data& data) const { return data.subscription == subscription; }
  // As load_as(). REQUIRES: is_in(data).
  template <typename T = double>
  T of(const Data& data) const {
    return load_as<T>(type, data.bytes.data() + offset);
  }
};

// What is wrong with a file. `bad_format` is counted for definitions, subscriptions and data.
enum class DamageKind { cut_off, garbage, bad_message, bad_format, unknown_id, wrong_size };
struct Damage {
  static constexpr std::size_t most_findings = 10;
  struct Finding {
    std::uint64_t offset;  // of the message in the file
    DamageKind kind;
    std::string message;
  };

  std::array<std::uint64_t, 6> counts{};  // by kind
  std::vector<Finding> first;             // the first most_findings
  // Of all findings: those that cannot have removed a sample. These are info messages and defaults
  // of parameters whose length is intact, and all damage in an appended part.
  std::uint64_t harmless = 0;
  std::uint64_t skipped_bytes = 0;  // skipped to find the next sync message
  std::uint64_t count(DamageKind kind) const { return counts[static_cast<std::size_t>(kind)]; }
  std::uint64_t total() const { return std::accumulate(counts.begin(), counts.end(), 0ULL); }
  bool may_lack_samples() const { return total() > harmless; }
};

struct Header {
  std::uint8_t version = 0;
  std::uint64_t start_us = 0;  // since the start of the system
  // From the flag bits message. Files of version 0 do not have it, so these are 0.
  std::uint64_t compatible_flags = 0, incompatible_flags = 0;
  std::array<std::uint64_t, 3> appended_offsets{};  // in the file; 0: unused
};

class Reader {
 public:
  // Also reads the messages up to the first data, so that find() works at once. next() nevertheless
  // begins with the first message. Errors: unreadable, not a ULog, another version, incompatible
  // flags that attest does not know.
  static Result<Reader> open(const std::filesystem::path& path);

  const Header& header() const { return header_; }
  const Formats& formats() const { return formats_; }                               // so far
  const std::deque<Subscription>& subscriptions() const { return subscriptions_; }  // so far
  // Finds a number in the data of an instance of a topic, by its path as in Format::locate().
  // Errors: no such topic, instance or field so far; its format cannot be used.
  Result<Column> find(std::string_view topic, std::uint8_t multi_id, std::string_view path) const;
  // Reads the next valid message. False: after the last one. Errors: the file cannot be read.
  Result<bool> next(Message& message) {
    const auto data = data_ahead();
    if (!data) return next_of_any_kind(message);
    pass(*data);
    message = *data;
    return true;
  }
  // Passes over the next data as long as `skips(data)`. Stops early at damage, at other messages
  // and at the end of the buffer: next() then reads them. It is faster than next().
  template <typename Skips>
  void skip_data(Skips skips) {
    for (auto data = data_ahead(); data && skips(*data); data = data_ahead()) pass(*data);
  }

  // The state before the last message, so that it can be read again.
  struct Place {
    std::uint64_t position;
    std::size_t section;
    std::vector<const Subscription*> active;
    Damage damage;
    std::uint64_t unknown_messages;
  };
  // REQUIRES: the last message was Data.
  Place place_of_last() const;
  // next() then reads the message of that place. Formats and subscriptions stay known.
  void return_to(const Place& place);

  // The place of the last message in the file, and whether it is in a part that was appended after
  // the end of the log, such as the report of a crash.
  std::uint64_t offset() const { return offset_; }
  bool is_appended() const { return section_ > 0; }

  // The damage found so far. Messages of an unknown type are skipped and do not count as damage.
  const Damage& damage() const { return damage_; }
  std::uint64_t unknown_messages() const { return unknown_messages_; }

 private:
  Reader() = default;
  Result<void> read_header();
  void start();
  // The next message if it is intact data in the buffer, as nearly all are.
  std::optional<Data> data_ahead() const;
  void pass(const Data& data) {
    offset_ = position_;
    position_ += head_bytes + sizeof(Subscription::id) + data.bytes.size();
  }
  Result<bool> next_of_any_kind(Message& message);
  // The bytes of the file from `offset` on: `count` or more, at most 1 MiB; fewer only up to end_.
  std::string_view bytes_at(std::uint64_t offset, std::size_t count);
  void fill_buffer(std::uint64_t offset);
  // Each sets `message` and returns true, or counts the damage and returns false. accept() also
  // returns false for a message of unknown type.
  bool accept(char type, std::string_view body, Message& message);
  bool accept_data(std::string_view body, Message& message);
  bool accept_value(char type, std::string_view body, Message& message);
  bool accept_subscription(std::string_view body, Message& message);
  bool refuse(DamageKind kind, const std::string& why, bool is_harmless = false);  // returns false
  void resynchronise(bool is_cut_off);

  std::string file_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_{nullptr, std::fclose};
  std::unique_ptr<char[]> buffer_;                   // a part of the file
  std::uint64_t buffer_begin_ = 0, buffer_end_ = 0;  // in the file
  std::optional<Error> read_failure_;
  std::uint64_t file_size_ = 0;  // when it was opened
  Header header_;
  Formats formats_;
  std::deque<Subscription> subscriptions_;   // at addresses that stay
  std::vector<const Subscription*> active_;  // by msg_id; null: no data are expected
  std::uint64_t first_message_ = 0;          // in the file
  std::vector<std::uint64_t> section_ends_;  // of the log itself, then of each appended part
  std::size_t section_ = 0;
  std::uint64_t end_ = 0;       // of the section
  std::uint64_t position_ = 0;  // of the next message
  std::uint64_t offset_ = 0;
  Damage damage_;
  std::uint64_t unknown_messages_ = 0;
};

inline std::optional<Data> Reader::data_ahead() const {
  constexpr std::size_t id_bytes = sizeof(Subscription::id);
  const std::uint64_t end = std::min(buffer_end_, end_);
  if (position_ < buffer_begin_ || position_ + head_bytes + id_bytes > end) return std::nullopt;
  const char* const bytes = buffer_.get() + (position_ - buffer_begin_);
  const std::size_t body_bytes = load<std::uint16_t>(bytes);
  if (bytes[2] != 'D' || body_bytes < id_bytes || position_ + head_bytes + body_bytes > end) {
    return std::nullopt;
  }
  const std::size_t id = load<std::uint16_t>(bytes + head_bytes);
  const Subscription* const found = id < active_.size() ? active_[id] : nullptr;
  const std::string_view data(bytes + head_bytes + id_bytes, body_bytes - id_bytes);
  const bool is_intact = found && found->format && found->format->allows(data.size());
  return is_intact && !read_failure_ ? std::optional(Data{found, data}) : std::nullopt;
}

}  // namespace attest::ulog
