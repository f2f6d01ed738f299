#include "harness/plant/simulator_message.hpp"

#include <algorithm>
#include <cctype>
#include <regex>

namespace attest {

int line_in(const std::string& simulator_message) {
  static const std::regex pattern(R"([Ll]ine(?: number)? ?=? ?(\d{1,7}))");
  std::smatch found;
  return std::regex_search(simulator_message, found, pattern) ? std::stoi(found[1]) : 0;
}

std::string on_one_line(std::string simulator_message) {
  const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!simulator_message.empty() && is_space(simulator_message.back()))
    simulator_message.pop_back();
  std::replace(simulator_message.begin(), simulator_message.end(), '\n', ' ');
  return simulator_message;
}

}  // namespace attest
