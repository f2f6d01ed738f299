// The call of the port that runs now, in memory that the port's process shares with its judge.
// After a crash or a timeout the judge reads there in which call, and at which tick, the port was.
// While the judge waits for a program or a live flight, it sees there whether the port still
// answers. In a live flight it also sees the progress there, and there it asks to end the flight.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "harness/core/result.hpp"
#include "harness/port/port.hpp"
#include "harness/realtime/live_flight.hpp"

namespace attest {

class PortCalls {
 public:
  // Errors: no shared memory.
  static Result<PortCalls> make();

  // Forgets the calls of a process that has ended.
  void reset() const;

  // " in step() at tick 17", " in create()"; empty between the calls. In a live flight of the
  // cascade two calls may run at the same time. The port can overwrite this memory, so only
  // messages may depend on it.
  std::string current() const;

  // How many calls have begun so far.
  std::uint64_t count() const;

  // Of the judge, for a live flight. The progress is 0 until the flight begins.
  void begin_flight() const;
  void ask_to_stop() const;
  LiveProgress progress() const;

  // Of the port's process: publishes the progress, and stops the flight when the judge asks.
  LiveWatch watch() const;

  // Returns `port`, with create() and each call of its units noted. For use in the port's process.
  // This object and `port` must outlive the result. A single `unit` is noted as a controller.
  std::unique_ptr<Port> noted(Port& port) const;
  std::unique_ptr<Unit> noted(std::unique_ptr<Unit> unit) const;

  struct Now;

 private:
  struct Unmap {
    void operator()(Now* now) const;
  };
  explicit PortCalls(Now* now) : now_(now) {}

  std::unique_ptr<Now, Unmap> now_;
};

}  // namespace attest
