// Writes a ULog of version 1, message by message, into a file that appears at commit().
//
//     auto writer = ulog::Writer::open("flight.ulg", 0);
//     writer->define("vehicle_rates_setpoint:uint64_t timestamp;float roll;float pitch;");
//     const auto id = writer->subscribe("vehicle_rates_setpoint");
//     writer->data(*id, bytes);  // the values in this order, without gaps
//     writer->commit();
//
// Formats start with `uint64_t timestamp`, have fields of descending sizes, and are not nested, so
// they need no padding, which some readers misread. After the first subscription, a sync message is
// written about every 64 KiB.
#pragma once

#include <initializer_list>
#include <set>
#include <variant>

#include "harness/core/file.hpp"
#include "harness/ulog/format.hpp"

namespace attest::ulog {

// Errors of all functions: the file cannot be written; then commit() fails, too. Two more errors
// have no effect on the file: a message of more than 65535 bytes, and a name with characters other
// than letters, digits and _ (for topics also - and /).
class Writer {
 public:
  // `start_us`: since the start of the system.
  Writer(AtomicFile file, std::uint64_t start_us);
  static Result<Writer> open(const std::filesystem::path& path, std::uint64_t start_us);

  Result<void> info(std::string_view name, std::string_view text);  // also an error: empty text
  Result<void> parameter(std::string_view name, std::variant<std::int32_t, float> value);

  // `definition`: "topic:uint64_t timestamp;float[4] q;". Also errors: fields that are not as
  // described above, or start with _; the topic is defined already; there is a subscription
  // already.
  Result<void> define(std::string_view definition);
  // Returns the msg_id. Also errors: not defined; this instance is subscribed already.
  Result<std::uint16_t> subscribe(std::string_view topic, std::uint8_t multi_id = 0);
  // Also errors: unknown msg_id; another number of bytes than the fields have.
  Result<void> data(std::uint16_t msg_id, std::string_view bytes);
  // `level`: '0' (emergency) to '7' (debug); others are an error.
  Result<void> log(char level, std::uint64_t timestamp_us, std::string_view text);
  Result<void> dropout(std::uint16_t duration_ms);
  // Completes the file. REQUIRES: no call after it.
  Result<void> commit();

 private:
  Result<void> write(char type, std::initializer_list<std::string_view> parts);
  Result<void> write_value(char type, std::string_view key, std::string_view value);

  AtomicFile file_;
  Result<void> status_;  // the first error of a write; commit() then fails
  std::string block_;    // not written yet
  Formats formats_;
  std::vector<const Format*> subscribed_;  // by msg_id
  std::set<std::pair<std::string, std::uint8_t>> instances_;
};

}  // namespace attest::ulog
