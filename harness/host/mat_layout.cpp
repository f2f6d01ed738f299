#include "harness/host/mat_layout.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include "harness/core/file.hpp"

namespace attest {
namespace {

// The numbers of the format are from "MAT-File Format", MathWorks.
constexpr std::size_t header_size = 128, version_at = 124, byte_order_at = 126;
constexpr std::uint32_t version_5 = 0x0100;
constexpr std::uint32_t matrix = 14, compressed = 15;  // types of elements
constexpr std::uint32_t first_numeric_class = 6, last_numeric_class = 15;

constexpr std::uintmax_t most_in_file = std::uintmax_t{1} << 30;   // read into memory
constexpr std::size_t most_decompressed = std::size_t{256} << 20;  // one hour at 8 kHz: 230 MB

std::uint32_t integer_in(std::string_view bytes, bool is_big_endian) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t place = is_big_endian ? bytes.size() - 1 - i : i;
    value |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * place);
  }
  return value;
}

// The size in bytes of one value of this type of element; 0 for a type that is no number.
std::size_t size_of(std::uint32_t type) {
  constexpr std::array<std::size_t, 14> sizes{0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8};
  return type < sizes.size() ? sizes[type] : 0;
}

struct MatElement {
  std::uint32_t type = 0;
  std::size_t size = 0;      // of its content, as its tag says
  std::string_view content;  // shorter if the bytes end earlier

  bool is_whole() const { return content.size() == size; }
};

// Reads one element after the other.
class MatElements {
 public:
  // The elements begin at multiples of `alignment`.
  MatElements(std::string_view bytes, bool is_big_endian, std::size_t alignment)
      : bytes_(bytes), is_big_endian_(is_big_endian), alignment_(alignment) {}

  bool is_at_end() const { return bytes_.empty(); }

  // Empty if there is no complete tag.
  std::optional<MatElement> next() {
    constexpr std::size_t tag_size = 8, half = 4;
    if (bytes_.size() < tag_size) return std::nullopt;
    const std::uint32_t first = integer_in(bytes_.substr(0, half), is_big_endian_);
    if (const std::size_t size = first >> 16; size > 0) {
      // A small element: type and size in the first half of the tag, the content in the second.
      const MatElement small{first & 0xffff, size, bytes_.substr(half, std::min(size, half))};
      bytes_.remove_prefix(tag_size);
      return small;
    }
    const std::size_t size = integer_in(bytes_.substr(half, half), is_big_endian_);
    const MatElement element{first, size, bytes_.substr(tag_size, size)};
    const std::size_t padded = (size + alignment_ - 1) / alignment_ * alignment_;
    bytes_.remove_prefix(std::min(bytes_.size(), tag_size + padded));
    return element;
  }

 private:
  std::string_view bytes_;
  bool is_big_endian_;
  std::size_t alignment_;
};

// Empty if the data are damaged, or larger than most_decompressed.
std::optional<std::string> decompress(std::string_view bytes) {
  z_stream stream{};
  if (::inflateInit(&stream) != Z_OK) return std::nullopt;
  std::vector<Bytef> in(bytes.begin(), bytes.end()), out(std::size_t{1} << 16);
  stream.next_in = in.data();
  stream.avail_in = static_cast<uInt>(in.size());
  std::string result;
  int state = Z_OK;
  while (state == Z_OK && result.size() <= most_decompressed) {
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    state = ::inflate(&stream, Z_NO_FLUSH);
    result.append(out.begin(), out.end() - stream.avail_out);
  }
  ::inflateEnd(&stream);
  return state == Z_STREAM_END ? std::optional(std::move(result)) : std::nullopt;
}

std::vector<std::uint32_t> integers_in(std::string_view bytes, bool is_big_endian) {
  std::vector<std::uint32_t> integers;
  for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
    integers.push_back(integer_in(bytes.substr(at, 4), is_big_endian));
  }
  return integers;
}

std::uint64_t product(const std::vector<std::uint32_t>& dimensions) {
  constexpr std::uint64_t most = std::uint64_t{1} << 32;  // more values than an element may have
  std::uint64_t values = 1;
  for (const std::uint32_t dimension : dimensions) values = std::min(values, most) * dimension;
  return values;
}

// What is wrong with the content of a variable; empty if its values are complete, or if it is not
// numeric.
std::string complaint_about(std::string_view content, bool is_big_endian) {
  MatElements elements(content, is_big_endian, 8);
  const auto flags = elements.next();
  if (!flags || flags->content.size() < 4) return "a variable has no class";
  const std::uint32_t kind = integer_in(flags->content.substr(0, 4), is_big_endian) & 0xff;
  if (kind < first_numeric_class || kind > last_numeric_class) return "";
  const auto shape = elements.next(), name = elements.next(), values = elements.next();
  if (!shape || !name) return "a variable has no dimensions or no name";
  const auto dimensions = integers_in(shape->content, is_big_endian);
  const std::size_t width = values ? size_of(values->type) : 0;
  const std::size_t count = width == 0 ? 0 : values->content.size() / width;
  if (count == product(dimensions)) return "";
  return fmt::format("the variable `{}` has {} values, but its dimensions are {}; write it again",
                     name->content, count, fmt::join(dimensions, " x "));
}

std::string complaint_about(const MatElement& variable, bool is_big_endian) {
  if (variable.type == matrix) return complaint_about(variable.content, is_big_endian);
  if (variable.type != compressed) return "";
  const auto bytes = decompress(variable.content);
  if (!bytes) {
    return fmt::format("a compressed variable is damaged, or larger than {} MiB",
                       most_decompressed >> 20);
  }
  const auto inner = MatElements(*bytes, is_big_endian, 1).next();
  return inner && inner->type == matrix ? complaint_about(inner->content, is_big_endian) : "";
}

}  // namespace

Result<void> check_mat_layout(const std::filesystem::path& path) {
  const auto file = read_file(path, most_in_file);
  if (!file) return tl::unexpected(file.error());
  const std::string_view bytes = *file;
  if (bytes.size() < header_size) return {};
  const bool is_big_endian = bytes[byte_order_at] == 'M';
  if (integer_in(bytes.substr(version_at, 2), is_big_endian) != version_5) return {};
  MatElements variables(bytes.substr(header_size), is_big_endian, 1);
  while (!variables.is_at_end()) {
    const auto variable = variables.next();
    if (!variable || !variable->is_whole()) {
      return fail_at(path.string(), "is cut off: the last variable is not complete");
    }
    const std::string complaint = complaint_about(*variable, is_big_endian);
    if (!complaint.empty()) return fail_at(path.string(), complaint);
  }
  return {};
}

}  // namespace attest
