#include "harness/trace/csv_rows.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <unordered_set>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"

namespace attest {
namespace {

// About the size of a first-level cache. A line must fit into the buffer.
constexpr std::size_t buffer_size = std::size_t{64} * 1024;

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

// Counts a UTF-8 sequence as one character.
int characters(std::string_view text) {
  const auto is_first_byte = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
  return static_cast<int>(std::count_if(text.begin(), text.end(), is_first_byte));
}

// The column of a cell in its line, in characters, from 1.
int place_of(std::string_view line, std::string_view cell) {
  return 1 + characters(line.substr(0, static_cast<std::size_t>(cell.data() - line.data())));
}

}  // namespace

Result<CsvRows> CsvRows::open(const std::filesystem::path& path, Unnamed unnamed,
                              std::string name) {
  CsvRows rows;
  rows.file_ = name.empty() ? path.string() : std::move(name);
  auto opened = open_regular_file(path);
  if (!opened) {
    opened.error().file = rows.file_;
    return tl::unexpected(opened.error());
  }
  rows.stream_.reset(::fdopen(*opened, "rb"));
  if (!rows.stream_) {
    ::close(*opened);
    return fail_at(rows.file_,
                   fmt::format("cannot open the file: {}", std::generic_category().message(errno)));
  }
  struct stat status {};
  if (::fstat(*opened, &status) == 0) rows.unread_ = static_cast<std::uintmax_t>(status.st_size);
  std::setvbuf(rows.stream_.get(), nullptr, _IONBF, 0);  // buffer_ is the buffer
  rows.buffer_ = std::make_unique_for_overwrite<char[]>(buffer_size + 1);
  if (const auto done = rows.read_header(unnamed); !done) return tl::unexpected(done.error());
  return rows;
}

Result<CsvRows> CsvRows::of(std::string_view text, const std::filesystem::path& path) {
  CsvRows rows;
  rows.file_ = path.string();
  rows.buffer_ = std::make_unique_for_overwrite<char[]>(text.size() + 1);
  std::copy(text.begin(), text.end(), rows.buffer_.get());
  rows.end_ = text.size();
  rows.at_end_of_file_ = true;
  rows.empty_repeats_ = true;
  if (const auto done = rows.read_header(Unnamed::refused); !done) {
    return tl::unexpected(done.error());
  }
  return rows;
}

Result<void> CsvRows::read_header(Unnamed unnamed) {
  const auto more = next_line();
  if (!more) return tl::unexpected(more.error());
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (line_.starts_with(byte_order_mark)) line_.remove_prefix(byte_order_mark.size());
  if (!*more || line_.empty() || is_digit(line_.front())) {
    return fail_at(file_, "no header; the first line must name the columns", 1, 1);
  }
  std::unordered_set<std::string_view> names;
  for (const std::string_view name : split(line_)) {
    if (name.empty() && unnamed == Unnamed::refused) {
      return fail_at_place(name, "a column without a name; name it or remove the comma");
    }
    if (name.find('\0') != std::string_view::npos) {
      return fail_at_place(name, "a NUL byte in the name of a column; the file is damaged");
    }
    if (!names.insert(name).second) {
      return fail_at_place(name,
                           fmt::format("repeated column {}; remove one", in_backquotes(name)));
    }
    header_.emplace_back(name);
  }
  return {};
}

// Moves the unread text to the front of the buffer and reads more behind it.
Result<void> CsvRows::fill() {
  std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
  end_ -= std::exchange(begin_, 0);
  if (interrupted()) return fail_at(file_, "not read to its end: interrupted");
  const std::size_t room = buffer_size - end_;
  const std::size_t count = std::fread(buffer_.get() + end_, 1, room, stream_.get());
  if (count < room) {
    if (std::ferror(stream_.get()) != 0) {
      return fail_at(
          file_, fmt::format("cannot read the file: {}", std::generic_category().message(errno)));
    }
    at_end_of_file_ = true;
  }
  end_ += count;
  unread_ -= std::min<std::uintmax_t>(count, unread_);
  if (count > bytes_left_) return too_large();
  bytes_left_ -= count;
  return {};
}

tl::unexpected<Error> CsvRows::too_large() const {
  return fail_at(file_,
                 fmt::format("is larger than {} GiB, the most that a trace in memory may have",
                             most_csv_bytes >> 30));
}

Result<void> CsvRows::limit_size() {
  if (unread_ > most_csv_bytes) return too_large();
  bytes_left_ = most_csv_bytes;
  return {};
}

Result<bool> CsvRows::next_line() {
  const char* newline = nullptr;
  while (true) {
    const char* const begin = buffer_.get() + begin_;
    newline = static_cast<const char*>(std::memchr(begin, '\n', end_ - begin_));
    if (newline != nullptr || at_end_of_file_) break;
    if (begin_ == 0 && end_ == buffer_size) {
      return fail_at(file_, "line is longer than any trace's; is this a CSV trace?",
                     line_number_ + 1);
    }
    if (const auto done = fill(); !done) return tl::unexpected(done.error());
  }
  if (newline == nullptr) {
    if (begin_ == end_) return false;
    buffer_[end_] = '\n';  // parsers look one character past the line
    newline = buffer_.get() + end_;
  }
  const char* const begin = buffer_.get() + begin_;
  const auto length = static_cast<std::size_t>(newline - begin);
  line_ = std::string_view(begin, length);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  begin_ = std::min(begin_ + length + 1, end_);
  ++line_number_;
  return true;
}

Result<bool> CsvRows::next(void* row) {
  auto more = next_line();
  if (!more || !*more) return more;
  if (!line_.empty()) {
    if (!parse_line(static_cast<char*>(row))) return diagnose(static_cast<char*>(row));
    return true;
  }
  const int empty_line = line_number_;
  while (line_.empty()) {
    more = next_line();
    if (!more || !*more) return more;
  }
  return fail_at(file_, "empty line between rows; remove it", empty_line, 1);
}

std::size_t CsvRows::rows_left() const {
  return static_cast<std::size_t>((unread_ + (end_ - begin_)) / (line_.size() + 1));
}

bool CsvRows::parse_line(char* row) const {
  const char* first = line_.data();
  const char* const last = first + line_.size();
  const CsvColumn* const back = &columns_.back();
  const bool repeats = empty_repeats_ && line_.front() == ',';
  for (const CsvColumn& column : columns_) {
    const bool is_repeated = repeats && (first == last || *first == ',');
    const char* const end = is_repeated ? first : parse_cell(first, last, column, row);
    if (end == nullptr) return false;
    if (&column == back) return end == last;
    if (end == last || *end != ',') return false;
    first = end + 1;
  }
  return false;
}

// Finds the error in a line that parse_line() refused. A row of the wrong length is reported first,
// because its cells may belong to other columns.
tl::unexpected<Error> CsvRows::diagnose(char* row) const {
  const std::vector<std::string_view> cells = split(line_);
  const std::size_t want = columns_.size();
  if (cells.size() < want) {
    const std::string_view end_of_line = line_.substr(line_.size());
    return fail_at_place(end_of_line, fmt::format("row has {} of {} cells, {} is missing; complete "
                                                  "or remove the row",
                                                  cells.size(), want, header_[cells.size()]));
  }
  if (cells.size() > want) {
    return fail_at_place(cells[want],
                         fmt::format("row has {} cells, the header has {}; remove the extra cells",
                                     cells.size(), want));
  }
  const bool repeats = empty_repeats_ && line_.front() == ',';
  const auto is_bad = [&](std::size_t i) {
    if (repeats && cells[i].empty()) return false;
    const char* const last = cells[i].data() + cells[i].size();
    return parse_cell(cells[i].data(), last, columns_[i], row) != last;
  };
  std::size_t bad = 0;
  while (bad + 1 < want && !is_bad(bad)) ++bad;
  return fail_at_cell(bad, cell_error(cells[bad], columns_[bad].type, header_[bad]));
}

tl::unexpected<Error> CsvRows::fail_at_name(std::size_t column, std::string message) const {
  int place = 1;
  for (std::size_t i = 0; i < column; ++i) place += characters(header_[i]) + 1;  // and a comma
  return fail_at(file_, std::move(message), 1, place);
}

tl::unexpected<Error> CsvRows::fail_at_cell(std::size_t column, std::string message) const {
  return fail_at_place(split(line_)[column], std::move(message));
}

tl::unexpected<Error> CsvRows::fail_at_place(std::string_view place, std::string message) const {
  return fail_at(file_, std::move(message), line_number_, place_of(line_, place));
}

}  // namespace attest
