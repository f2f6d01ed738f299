#include "harness/sweep/sample_table.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/sweep/table_extent.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t comma = line.find(','); comma != std::string_view::npos;
       comma = line.find(',')) {
    cells.push_back(line.substr(0, comma));
    line.remove_prefix(comma + 1);
  }
  cells.push_back(line);
  return cells;
}

template <typename T>
std::optional<T> parsed(std::string_view cell) {
  T value{};
  const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (code != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

// Reads outcome and metrics from the cells from `first` on. An empty cell becomes NaN.
bool read_flight(const std::vector<std::string_view>& cells, std::size_t first, std::size_t metrics,
                 FlightResult& flight) {
  flight.outcome = std::string(cells[first]);
  flight.metrics.clear();
  for (std::size_t i = first + 1; i <= first + metrics; ++i) {
    const auto value = cells[i].empty() ? std::nan("") : parsed<double>(cells[i]);
    if (!value || cells[i].empty() != (flight.outcome != outcome_done)) return false;
    flight.metrics.push_back(*value);
  }
  return !flight.outcome.empty();
}

class TableReader {
 public:
  TableReader(const fs::path& file, const SampleColumns& columns, const SampleRange& range,
              WrongLine wrong = WrongLine::is_error)
      : file_(file), columns_(columns), range_(range), wrong_(wrong) {}

  Result<TableExtent> read(const OnRow& on_row) {
    const auto opened = open_regular_file(file_);
    if (!opened) return tl::unexpected(opened.error());
    const Result<void> taken = take_all(*opened, on_row);
    ::close(*opened);
    if (interrupted()) return fail_at(file_.string(), "not read to its end: interrupted");
    if (!taken && wrong_ == WrongLine::is_error) return tl::unexpected(taken.error());
    return extent_;
  }

 private:
  // Takes all lines, until one is wrong.
  Result<void> take_all(int descriptor, const OnRow& on_row) {
    constexpr std::size_t block_bytes = std::size_t{64} * 1024, most_in_line = std::size_t{1} << 20;
    std::string text;  // not taken yet
    Result<void> taken;
    while (taken && !interrupted()) {
      const std::size_t searched = text.size();
      text.resize(searched + block_bytes);
      const ssize_t count = ::read(descriptor, text.data() + searched, block_bytes);
      if (count < 0 && errno != EINTR) {
        return tl::unexpected(table_error(file_, "cannot be read"));
      }
      text.resize(searched + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
      if (count == 0) return text.empty() ? taken : take(text, on_row);
      std::size_t begin = 0;
      for (std::size_t end = text.find('\n', searched); taken && end != std::string::npos;
           end = text.find('\n', begin)) {
        taken = take(std::string_view(text).substr(begin, end + 1 - begin), on_row);
        begin = end + 1;
      }
      text.erase(0, begin);
      if (text.size() > most_in_line) return wrong(lines_ + 1, "is longer than any row");
    }
    return taken;
  }

  Result<void> take(std::string_view line, const OnRow& on_row) {
    extent_.is_cut = line.back() != '\n';
    if (extent_.is_cut) return {};
    const int number = ++lines_;
    const std::uint64_t bytes = line.size();
    if (number == 1) {
      if (line != columns_.header()) return wrong(number, "has other columns than this sweep");
    } else {
      const std::uint64_t index = range_.begin + extent_.rows;
      line.remove_suffix(1);
      if (index >= range_.end || !read_row(line, columns_, index, row_)) {
        return wrong(number, fmt::format("is not the row of sample {}", index));
      }
      on_row(row_);
      ++extent_.rows;
    }
    extent_.bytes += bytes;
    return {};
  }

  Result<void> wrong(int line, const std::string& what) const {
    return fail_at(file_.string(),
                   what + "; the file was changed: remove it, and run the sweep again", line);
  }

  const fs::path& file_;
  const SampleColumns& columns_;
  const SampleRange& range_;
  WrongLine wrong_;
  TableExtent extent_;
  SampleRow row_;
  int lines_ = 0;
};

}  // namespace

bool read_row(std::string_view line, const SampleColumns& columns, std::uint64_t index,
              SampleRow& row) {
  const std::vector<std::string_view> cells = cells_of(line);
  const std::size_t of_flight = 1 + columns.metrics.size();
  const std::size_t flights = columns.with_port ? 2 : 1;
  const std::size_t first = 1 + columns.dispersions.size();
  if (cells.size() != first + flights * of_flight) return false;
  if (parsed<std::uint64_t>(cells[0]) != index) return false;
  row.drawn.clear();
  for (std::size_t i = 1; i < first; ++i) {
    const auto value = parsed<double>(cells[i]);
    if (!value) return false;
    row.drawn.push_back(*value);
  }
  row.flights.resize(flights);
  for (std::size_t i = 0; i < flights; ++i) {
    if (!read_flight(cells, first + i * of_flight, columns.metrics.size(), row.flights[i])) {
      return false;
    }
  }
  return true;
}

std::string SampleColumns::header() const {
  std::string line = "sample";
  for (const std::string& name : dispersions) line += "," + name;
  for (const char* pilot : {"reference", "port"}) {
    if (!with_port && std::string_view(pilot) == "port") break;
    line += fmt::format(",{}.outcome", pilot);
    for (const std::string& name : metrics) line += fmt::format(",{}.{}", pilot, name);
  }
  return line + "\n";
}

std::string SampleColumns::line(std::uint64_t index, const std::vector<double>& drawn,
                                const std::vector<FlightResult>& flights) const {
  std::string line = fmt::format("{}", index);
  for (const double number : drawn) line += fmt::format(",{}", number);
  for (const FlightResult& flight : flights) {
    line += "," + flight.outcome;
    for (std::size_t i = 0; i < metrics.size(); ++i) {
      line += flight.metrics.empty() ? "," : fmt::format(",{}", flight.metrics[i]);
    }
  }
  return line + "\n";
}

std::size_t SampleColumns::place_of(const std::string& metric) const {
  return static_cast<std::size_t>(std::find(metrics.begin(), metrics.end(), metric) -
                                  metrics.begin());
}

Result<TableExtent> extent_of(const fs::path& file, const SampleColumns& columns,
                              const SampleRange& range, WrongLine wrong, const OnRow& on_row) {
  return TableReader(file, columns, range, wrong).read(on_row);
}

Error table_error(const fs::path& file, const std::string& what) {
  return {fmt::format("{}: {}", what, std::generic_category().message(errno)), file.string()};
}

Result<SampleData> read_samples(const fs::path& file, const SampleColumns& columns,
                                const SampleRange& range) {
  SampleData data;
  data.drawn.resize(columns.dispersions.size());
  data.pilots.resize(columns.with_port ? 2 : 1);
  for (PilotData& pilot : data.pilots) pilot.metrics.resize(columns.metrics.size());
  const auto extent = TableReader(file, columns, range).read([&](const SampleRow& row) {
    for (std::size_t i = 0; i < row.drawn.size(); ++i) data.drawn[i].push_back(row.drawn[i]);
    for (std::size_t p = 0; p < row.flights.size(); ++p) {
      data.pilots[p].outcomes.push_back(row.flights[p].outcome);
      for (std::size_t m = 0; m < columns.metrics.size(); ++m) {
        data.pilots[p].metrics[m].push_back(row.flights[p].metrics[m]);
      }
    }
  });
  if (!extent) return tl::unexpected(extent.error());
  if (extent->is_cut || extent->rows != range.size()) {
    return fail_at(file.string(), fmt::format("has {} of {} samples; run this sweep again with the "
                                              "same --out, which flies the others",
                                              extent->rows, range.size()));
  }
  return data;
}

}  // namespace attest
