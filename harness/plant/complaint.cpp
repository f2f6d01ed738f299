#include "harness/plant/complaint.hpp"

#include <algorithm>
#include <cctype>
#include <regex>

namespace attest {

int line_in(const std::string& complaint) {
  static const std::regex pattern(R"([Ll]ine(?: number)? ?=? ?(\d{1,7}))");
  std::smatch found;
  return std::regex_search(complaint, found, pattern) ? std::stoi(found[1]) : 0;
}

std::string one_line(std::string complaint) {
  const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!complaint.empty() && is_space(complaint.back())) complaint.pop_back();
  std::replace(complaint.begin(), complaint.end(), '\n', ' ');
  return complaint;
}

}  // namespace attest
