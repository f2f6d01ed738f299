#include "harness/recording/npy_file.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "harness/core/file.hpp"

namespace attest {
namespace {

constexpr std::string_view magic = "\x93NUMPY";

// A field of an array. Kind and size are the type: "f4", "u8", "b1"; "V3" is padding.
struct Element {
  std::string name;
  char kind = 0;
  std::size_t size = 0;
};

struct Header {
  std::vector<Element> fields;  // one field without a name if the array is not structured
  bool is_fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t data = 0;  // where the elements begin
};

// Reads the header's text, which is a Python literal:
// {'descr': [('timestamp', '<u8'), ('x', '<f4')], 'fortran_order': False, 'shape': (60,), }
class Literal {
 public:
  explicit Literal(std::string_view text) : text_(text) {}

  bool take(std::string_view word) {
    skip_spaces();
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }

  std::optional<std::string> text() {
    skip_spaces();
    if (text_.empty() || (text_.front() != '\'' && text_.front() != '"')) return std::nullopt;
    const std::size_t end = text_.find(text_.front(), 1);
    if (end == std::string_view::npos) return std::nullopt;
    std::string value(text_.substr(1, end - 1));
    text_.remove_prefix(end + 1);
    return value;
  }

  std::optional<std::size_t> number() {
    skip_spaces();
    std::size_t value = 0;
    const auto parsed = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (parsed.ec != std::errc()) return std::nullopt;
    text_.remove_prefix(static_cast<std::size_t>(parsed.ptr - text_.data()));
    return value;
  }

 private:
  void skip_spaces() {
    text_.remove_prefix(std::min(text_.find_first_not_of(" \n"), text_.size()));
  }

  std::string_view text_;
};

// "<f4" -> f, 4. The byte order must be little-endian, native or irrelevant (`|`).
std::optional<Element> element_of(const std::string& name, const std::string& descr) {
  Element element{name};
  if (descr.size() < 3 || (descr[0] != '<' && descr[0] != '|' && descr[0] != '=')) {
    return std::nullopt;
  }
  element.kind = descr[1];
  const auto parsed = std::from_chars(descr.data() + 2, descr.data() + descr.size(), element.size);
  constexpr std::size_t largest = 4096;  // for padding
  if (parsed.ec != std::errc() || element.size == 0 || element.size > largest) return std::nullopt;
  const bool is_number = std::string_view("fiub").find(element.kind) != std::string_view::npos;
  const bool is_size =
      element.size == 1 || element.size == 2 || element.size == 4 || element.size == 8;
  const bool is_float = element.kind != 'f' || element.size == 4 || element.size == 8;
  if (element.kind != 'V' && !(is_number && is_size && is_float)) return std::nullopt;
  return element;
}

std::optional<std::vector<Element>> fields_of(Literal& literal) {
  std::vector<Element> fields;
  if (!literal.take("[")) {
    const auto descr = literal.text();
    const auto element = descr ? element_of("", *descr) : std::nullopt;
    if (!element) return std::nullopt;
    return std::vector{*element};
  }
  while (!literal.take("]")) {
    if (!literal.take("(")) return std::nullopt;
    const auto name = literal.text();
    if (!name || !literal.take(",")) return std::nullopt;
    const auto descr = literal.text();
    const auto element = descr ? element_of(*name, *descr) : std::nullopt;
    if (!element || !literal.take(")")) return std::nullopt;
    fields.push_back(*element);
    literal.take(",");
  }
  return fields;
}

bool read_shape(Literal& literal, std::vector<std::size_t>& shape) {
  if (!literal.take("(")) return false;
  while (!literal.take(")")) {
    const auto count = literal.number();
    if (!count) return false;
    shape.push_back(*count);
    literal.take(",");
  }
  return true;
}

std::optional<Header> header_of(std::string_view bytes) {
  constexpr std::size_t before_length = 8;  // magic and version
  if (!bytes.starts_with(magic) || bytes.size() < before_length + 4) return std::nullopt;
  const bool is_first_version = bytes[6] == 1;
  std::uint32_t length = 0;
  const std::size_t length_size = is_first_version ? 2 : 4;
  std::memcpy(&length, bytes.data() + before_length, length_size);
  Header header;
  header.data = before_length + length_size + length;
  if (header.data > bytes.size()) return std::nullopt;
  Literal literal(bytes.substr(before_length + length_size, length));
  if (!literal.take("{")) return std::nullopt;
  while (!literal.take("}")) {
    const auto key = literal.text();
    if (!key || !literal.take(":")) return std::nullopt;
    if (*key == "descr") {
      auto fields = fields_of(literal);
      if (!fields) return std::nullopt;
      header.fields = *std::move(fields);
    } else if (*key == "fortran_order") {
      header.is_fortran_order = literal.take("True");
      if (!header.is_fortran_order && !literal.take("False")) return std::nullopt;
    } else if (*key != "shape" || !read_shape(literal, header.shape)) {
      return std::nullopt;
    }
    literal.take(",");
  }
  return header;
}

template <typename Value>
double value_at(const char* place) {
  Value value;
  std::memcpy(&value, place, sizeof value);
  return static_cast<double>(value);
}

double read_element(const Element& element, const char* place) {
  switch (element.kind) {
    case 'f':
      return element.size == 4 ? value_at<float>(place) : value_at<double>(place);
    case 'i':
      return element.size == 1   ? value_at<std::int8_t>(place)
             : element.size == 2 ? value_at<std::int16_t>(place)
             : element.size == 4 ? value_at<std::int32_t>(place)
                                 : value_at<std::int64_t>(place);
    default:
      return element.size == 1   ? value_at<std::uint8_t>(place)
             : element.size == 2 ? value_at<std::uint16_t>(place)
             : element.size == 4 ? value_at<std::uint32_t>(place)
                                 : value_at<std::uint64_t>(place);
  }
}

Table structured(const Header& header, std::size_t record, const char* data) {
  Table table;
  std::size_t offset = 0;
  for (const Element& field : header.fields) {
    if (field.kind != 'V') {
      Column column{field.name, {}};
      for (std::size_t row = 0; row < header.shape[0]; ++row) {
        column.values.push_back(read_element(field, data + row * record + offset));
      }
      table.push_back(std::move(column));
    }
    offset += field.size;
  }
  return table;
}

Table two_dimensional(const Header& header, const std::vector<std::string>& names,
                      const char* data) {
  const Element& element = header.fields.front();
  const std::size_t rows = header.shape[0], columns = header.shape[1];
  Table table;
  for (std::size_t i = 0; i < columns; ++i) {
    Column column{names[i], {}};
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t at = header.is_fortran_order ? i * rows + row : row * columns + i;
      column.values.push_back(read_element(element, data + at * element.size));
    }
    table.push_back(std::move(column));
  }
  return table;
}

std::string complaint_about(const Header& header, const std::vector<std::string>& names) {
  const bool has_names = header.fields.size() > 1 || !header.fields.front().name.empty();
  const std::vector<std::size_t>& shape = header.shape;
  if (has_names) {
    return shape.size() == 1 ? "" : "is a structured array of several dimensions; it needs one";
  }
  if (shape.size() != 2) {
    return fmt::format("is an array of {} dimension(s); it needs two, rows for ticks",
                       shape.size());
  }
  if (names.empty()) {
    return "has no names; write a structured array, or name the columns in `columns` of the "
           "manifest";
  }
  if (shape[1] == names.size()) return "";
  const bool is_transposed = shape[0] == names.size();
  return fmt::format("has {} rows and {} columns, and the manifest names {} columns{}", shape[0],
                     shape[1], names.size(),
                     is_transposed ? "; it is transposed: save the array's .T" : "");
}

}  // namespace

Result<Table> read_npy(const std::filesystem::path& path, const std::vector<std::string>& names) {
  constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;
  const auto bytes = read_file(path, most_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto header = header_of(*bytes);
  if (!header || header->fields.empty()) {
    return fail_at(path.string(),
                   "is no NPY file of little-endian integers, floats or booleans; write one with "
                   "numpy.save()");
  }
  if (std::string complaint = complaint_about(*header, names); !complaint.empty()) {
    return fail_at(path.string(), std::move(complaint));
  }
  std::size_t record = 0;
  for (const Element& field : header->fields) record += field.size;
  std::size_t bytes_left = bytes->size() - header->data;
  for (const std::size_t count : header->shape) bytes_left /= std::max<std::size_t>(count, 1);
  if (bytes_left < record) return fail_at(path.string(), "is cut off: some elements are missing");
  const char* const data = bytes->data() + header->data;
  if (header->shape.size() == 1) return structured(*header, record, data);
  return two_dimensional(*header, names, data);
}

namespace {

std::string_view descr_of(ChannelType type) {
  switch (type) {
    case ChannelType::u64:
      return "<u8";
    case ChannelType::f32:
      return "<f4";
    case ChannelType::u8:
    case ChannelType::bit:
      return "|u1";
  }
  return "";
}

template <typename Value>
void append(double value, std::string& bytes) {
  const auto narrowed = static_cast<Value>(value);
  bytes.append(reinterpret_cast<const char*>(&narrowed), sizeof narrowed);
}

void append(const Column& column, std::size_t row, std::string& bytes) {
  switch (column.type) {
    case ChannelType::u64:
      return append<std::uint64_t>(column.values[row], bytes);
    case ChannelType::f32:
      return append<float>(column.values[row], bytes);
    case ChannelType::u8:
    case ChannelType::bit:
      return append<std::uint8_t>(column.values[row], bytes);
  }
}

}  // namespace

Result<void> write_npy(const std::filesystem::path& path, const Table& table) {
  const std::size_t rows = table.empty() ? 0 : table.front().values.size();
  std::string header = "{'descr': [";
  for (const Column& column : table) {
    header += fmt::format("('{}', '{}'), ", column.name, descr_of(column.type));
  }
  header += fmt::format("], 'fortran_order': False, 'shape': ({},), }}", rows);
  // Version 1: two bytes for the length; the elements begin at a multiple of 64.
  constexpr std::size_t before_header = 10, alignment = 64;
  header.append(alignment - (before_header + header.size() + 1) % alignment, ' ');
  header += '\n';
  std::string bytes(magic);
  bytes += '\x01';
  bytes += '\0';
  append<std::uint16_t>(static_cast<double>(header.size()), bytes);
  bytes += header;
  for (std::size_t row = 0; row < rows; ++row) {
    for (const Column& column : table) append(column, row, bytes);
  }
  return write_file(path, bytes);
}

}  // namespace attest
