// Builds a ULog byte by byte, also a wrong one, independently of the writer.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace attest::ulog {

// The bytes of values, one after the other.
template <typename... T>
std::string raw(T... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  return bytes;
}

inline const std::string sync_pattern = "\x2F\x73\x13\x20\x25\x0C\xBB\x12";

class Crafted {
 public:
  explicit Crafted(std::uint8_t version = 1, std::uint64_t start_us = 112233)
      : bytes_("ULog\x01\x12\x35" + raw(version, start_us)) {}

  const std::string& bytes() const { return bytes_; }
  std::uint64_t size() const { return bytes_.size(); }

  Crafted& append(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  Crafted& message(char type, const std::string& body) {
    return append(raw(static_cast<std::uint16_t>(body.size()), type) + body);
  }
  Crafted& flag_bits(std::uint64_t incompatible = 0, std::uint64_t first_offset = 0,
                     std::uint64_t second_offset = 0) {
    return message(
        'B', raw(std::uint64_t{0}, incompatible, first_offset, second_offset, std::uint64_t{0}));
  }
  Crafted& format(const std::string& definition) { return message('F', definition); }
  Crafted& subscribe(std::uint16_t id, const std::string& topic, std::uint8_t multi_id = 0) {
    return message('A', raw(multi_id, id) + topic);
  }
  Crafted& data(std::uint16_t id, const std::string& values) {
    return message('D', raw(id) + values);
  }
  // I, P; with `flags`: M, Q.
  Crafted& value(char type, const std::string& key, const std::string& bytes) {
    return message(type, raw(static_cast<std::uint8_t>(key.size())) + key + bytes);
  }
  Crafted& value(char type, std::uint8_t flags, const std::string& key, const std::string& bytes) {
    return message(type, raw(flags, static_cast<std::uint8_t>(key.size())) + key + bytes);
  }
  Crafted& log(char level, std::uint64_t timestamp, const std::string& text) {
    return message('L', level + raw(timestamp) + text);
  }
  Crafted& sync() { return message('S', sync_pattern); }

 private:
  std::string bytes_;
};

}  // namespace attest::ulog
