#include "harness/cli/exchange_note.hpp"

#include <fmt/format.h>

#include "harness/port/port.hpp"
#include "harness/process/round_trip.hpp"

namespace attest::cli {

std::string exchange_note(const std::string& port) {
  if (!kind_of(port).is_program) return "";
  constexpr std::size_t frame_bytes = 144;  // a `step` request of the controller (PROTOCOL.md)
  const auto pipes = pipe_round_trip(frame_bytes);
  const auto memory = memory_round_trip(frame_bytes);
  if (!pipes || !memory) {
    return fmt::format("exchange: {}\n", (pipes ? memory : pipes).error().to_string());
  }
  return fmt::format(
      "exchange: the times of a step include the exchange with the program; alone it takes {:.1f} "
      "us\n          through pipes, {:.1f} us in shared memory (medians)\n",
      in_seconds(*pipes) * 1e6, in_seconds(*memory) * 1e6);
}

}  // namespace attest::cli
