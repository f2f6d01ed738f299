#include "harness/cli/pipes_note.hpp"

#include <fmt/format.h>

#include "harness/port/port.hpp"
#include "harness/process/pipe_round_trip.hpp"

namespace attest::cli {

std::string pipes_note(const std::string& port) {
  if (!is_program(port)) return "";
  constexpr std::size_t frame_bytes = 144;  // of a step of the controller (PROTOCOL.md)
  const auto round_trip = pipe_round_trip(frame_bytes);
  if (!round_trip) return fmt::format("pipes: {}\n", round_trip.error().to_string());
  return fmt::format(
      "pipes: the times of a step include the exchange with the program; pipes alone take {:.1f} "
      "us "
      "(median, with `cat`)\n",
      in_seconds(*round_trip) * 1e6);
}

}  // namespace attest::cli
