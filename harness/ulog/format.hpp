// The basic types of a ULog, the formats that the file defines for its topics, and the places of
// their fields.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"

namespace attest::ulog {

// The first bytes of every log; the version follows.
inline constexpr std::string_view file_magic = "ULog\x01\x12\x35";

enum class Type { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64, boolean, character, nested };
std::string_view name_of(Type type);  // "uint8_t"; empty for nested
std::uint32_t bytes_of(Type type);    // 0 for nested: depends on the format

// Reads a value of a file by a copy, because it may have any alignment. Files are little-endian.
static_assert(std::endian::native == std::endian::little);
template <typename T>
T load(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

// Converts the value at `bytes` as static_cast does. To double, everything is exact except 64-bit
// integers beyond 2^53. A bool is 0 or 1. REQUIRES: not nested; not a float type if T is an
// integer.
template <typename T>
T load_as(Type type, const char* bytes) {
  if (type == Type::f32) return static_cast<T>(load<float>(bytes));
  if (type == Type::f64) return static_cast<T>(load<double>(bytes));
  if (type == Type::u64) return static_cast<T>(load<std::uint64_t>(bytes));
  if (type == Type::i64) return static_cast<T>(load<std::int64_t>(bytes));
  if (type == Type::u32) return static_cast<T>(load<std::uint32_t>(bytes));
  if (type == Type::i32) return static_cast<T>(load<std::int32_t>(bytes));
  if (type == Type::u16) return static_cast<T>(load<std::uint16_t>(bytes));
  if (type == Type::i16) return static_cast<T>(load<std::int16_t>(bytes));
  if (type == Type::i8) return static_cast<T>(load<std::int8_t>(bytes));
  const auto byte = load<std::uint8_t>(bytes);
  return static_cast<T>(type == Type::boolean ? byte != 0 : byte);
}

struct Field {
  Type type;
  std::string type_name;  // the format's name if nested
  std::string name;       // of a leaf: its path through nested formats, "a.b[2].c"
  std::uint32_t count;    // elements; 1 without brackets
  bool is_array;
  std::uint32_t offset = 0;  // of a leaf: bytes, in the data

  // Padding aligns the next field. A data message may lack the padding at its end.
  bool is_padding() const { return name.starts_with("_padding"); }
  Field at(std::string path, std::uint32_t at) const {
    return {type, type_name, std::move(path), count, is_array, at};
  }
};

// Parses "float[4] q". An array may be empty, as the `char[0] perf_top_preflight` of PX4's info
// messages. Errors: it does not have this form.
Result<Field> parse_field(std::string_view text);

struct Format {
  std::string name;
  std::string text;  // "type field;..."
  std::vector<Field> fields;
  // Formats::measure() sets these members. A leaf is a field of a basic type, perhaps in a nested
  // format, that is no padding.
  std::vector<Field> leaves = {};
  std::uint32_t bytes = 0;        // 0: not measured
  std::uint32_t least_bytes = 0;  // without padding at the end

  // Whether the data of a sample may have this size. REQUIRES: measured.
  bool allows(std::size_t size) const { return size >= least_bytes && size <= bytes; }

  // Finds a number by its path: "roll", "q[0]", "a.b[2]". If several fields have this path, finds
  // the first. Errors: no such field; an array without an index, or with an index past its end; an
  // index for a field that is no array. REQUIRES: measured.
  Result<Field> locate(std::string_view path) const;
  // The first name of a leaf that an earlier leaf has too; empty if all names differ. REQUIRES:
  // measured.
  std::string repeated_leaf() const;
};

class Formats {
 public:
  static constexpr std::uint32_t most_bytes = 0xffff - 2;  // a u16 counts the data and their msg_id
  static constexpr std::size_t most_leaves = 4096;         // no topic of PX4 has a tenth as many
  static constexpr int most_depth = 16;

  // Adds "name:type field;...". The same definition may be added again. Errors: it does not have
  // this form; the name already has another definition, which is kept.
  Result<const Format*> add(std::string_view definition);
  // Computes leaves and sizes, if this was not done before. The pointer is valid as long as this
  // object. Errors: this or a nested format is missing; nested too deeply, or in itself; more than
  // most_bytes or most_leaves.
  Result<const Format*> measure(std::string_view name, int depth_left = most_depth);
  const std::map<std::string, Format, std::less<>>& all() const { return formats_; }

 private:
  std::map<std::string, Format, std::less<>> formats_;
};

}  // namespace attest::ulog
