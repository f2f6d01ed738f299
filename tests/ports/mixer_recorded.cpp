// The mixer against a recorded mixer trace, to the bit: mixer_recorded DEFINITION TRACE.csv
// A program of its own, without the harness, so that it can be built by each compiler at each
// optimisation level in a second. Exits 1 and says where if anything differs.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "controller/actuation/mixer.hpp"

namespace {

using attest::actuation::Mixer;
using attest::actuation::Saturation;

std::vector<float> numbers(const std::string& line) {
  std::vector<float> values;
  std::istringstream cells(line);
  for (std::string cell; std::getline(cells, cell, ',');) {
    values.push_back(std::strtof(cell.c_str(), nullptr));
  }
  return values;
}

// Columns: four controls, delta_out_max, a command a rotor, three flags.
bool agrees(Mixer& mixer, const std::vector<float>& row) {
  const std::size_t rotors = mixer.rotor_count();
  if (row.size() != 5 + rotors + 3) return false;
  Saturation saturation{};
  const auto out = mixer.mix({row[0], row[1], row[2], row[3]}, row[4], saturation);
  bool same = saturation.lower == (row[5 + rotors] != 0) &&
              saturation.upper == (row[6 + rotors] != 0) &&
              saturation.yaw == (row[7 + rotors] != 0);
  for (std::size_t i = 0; i < rotors; ++i) {
    same = same && std::bit_cast<std::uint32_t>(out[i]) == std::bit_cast<std::uint32_t>(row[5 + i]);
  }
  return same;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  auto mixer = Mixer::parse(argv[1]);
  std::ifstream trace(argv[2]);
  std::string line;
  if (!mixer || !std::getline(trace, line)) return 2;
  int row = 1;
  while (std::getline(trace, line)) {
    ++row;
    if (agrees(*mixer, numbers(line))) continue;
    std::fprintf(stderr, "%s:%d: differs\n", argv[2], row);
    return 1;
  }
  return row > 1000 ? 0 : 2;  // an empty trace proves nothing
}
