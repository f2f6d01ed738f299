#include "harness/plant/complaint.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>

namespace attest {

int line_in(const std::string& complaint) {
  constexpr std::string_view word = "line ";
  const auto at = complaint.find(word);
  int line = 0;
  if (at != std::string::npos) {
    const char* end = complaint.data() + complaint.size();
    std::from_chars(complaint.data() + at + word.size(), end, line);
  }
  return line;
}

std::string one_line(std::string complaint) {
  const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!complaint.empty() && is_space(complaint.back())) complaint.pop_back();
  std::replace(complaint.begin(), complaint.end(), '\n', ' ');
  return complaint;
}

}  // namespace attest
