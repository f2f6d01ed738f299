// CSV files for the tests, with cells that can be changed by row and column name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/trace/trace.hpp"

namespace attest {

class Sheet {
 public:
  // Three rows of a recorded trace of the original firmware (tracking at 250 Hz).
  static Sheet recorded();
  explicit Sheet(std::string_view text);

  // `row` counts from 1, the header is row 0.
  std::string& cell(std::size_t row, std::string_view column);
  // The place of a cell in its line, from 1.
  int place(std::size_t row, std::string_view column) const;
  void remove(std::string_view column);
  void add(std::string_view column, const std::vector<std::string>& cells);

  std::string text() const;

 private:
  std::size_t index(std::string_view column) const;

  std::vector<std::vector<std::string>> rows_;
};

// Whether all channels have the same bits; all NaNs count as the same.
bool same_samples(const Trace& a, const Trace& b);

}  // namespace attest
