#include "harness/host/port_launcher.hpp"

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "harness/host/host_protocol.hpp"
#include "harness/host/in_process_host.hpp"
#include "harness/host/port_process.hpp"
#include "harness/process/launcher.hpp"
#include "harness/process/process.hpp"

namespace attest {
namespace {

using Kind = Received::Kind;

// What a port's process serves. The process is a fork, so these objects are in its memory too.
struct Served {
  const HostOptions* options;
  Course course;
};

// Runs in the port's process.
void serve(const Served& served, const PortCalls& calls, MessageSocket& judge) {
  const HostOptions& options = *served.options;
  auto host =
      open_in_process_host(options.port, options.said, served.course, &calls, options.files.get());
  if (!host) {
    refuse(host.error(), 0, judge);
    return;
  }
  bool goes_on = greet((*host)->declarations(), judge);
  for (std::uint64_t request = 1; goes_on; ++request) {
    const Received question = judge.receive();
    if (question.kind != Kind::message) return;
    BlobReader blobs(question.blobs, [&](void* place, std::size_t size) {
      return judge.receive_blob(place, size) == Kind::message;
    });
    try {
      goes_on = answer({question.head, blobs, request}, **host, judge);
    } catch (const PortBroke& broke) {  // a program ended or broke its protocol outside of a step
      goes_on = give_fault(fault_of(broke), request, judge);
    }
  }
}

Result<std::shared_ptr<const PortCalls>> shared_calls() {
  return PortCalls::make().map(
      [](PortCalls calls) { return std::make_shared<const PortCalls>(std::move(calls)); });
}

// One thread at a time, same as Launcher.
class PortLauncher {
 public:
  static Result<PortLauncher> start(const BarrierOptions& barrier) {
    auto calls = shared_calls();
    if (!calls) return tl::unexpected(calls.error());
    auto launcher =
        Launcher::start(barrier, [&calls](const std::string& request, MessageSocket& judge) {
          Served served{};
          std::memcpy(&served, request.data(), sizeof served);
          serve(served, **calls, judge);
        });
    if (!launcher) return tl::unexpected(launcher.error());
    return PortLauncher(*std::move(calls), *std::move(launcher));
  }

  bool is_alive() const { return launcher_.is_alive(); }

  Result<PortChild> launch(const Served& served) {
    calls_->reset();
    std::string request(sizeof served, '\0');
    std::memcpy(request.data(), &served, sizeof served);
    return launcher_.launch(request).map([&](Child child) {
      return PortChild{std::move(child), calls_};
    });
  }

 private:
  PortLauncher(std::shared_ptr<const PortCalls> calls, Launcher launcher)
      : calls_(std::move(calls)), launcher_(std::move(launcher)) {}

  std::shared_ptr<const PortCalls> calls_;
  Launcher launcher_;
};

// The launcher of this process; empty if there is none.
std::optional<PortLauncher>& port_launcher() {
  static std::optional<PortLauncher> launcher;
  return launcher;
}

}  // namespace

Result<void> start_port_launcher(const BarrierOptions& barrier) {
  port_launcher().reset();
  auto launcher = PortLauncher::start(barrier);
  if (!launcher) return tl::unexpected(launcher.error());
  port_launcher().emplace(*std::move(launcher));
  return {};
}

bool has_port_launcher() { return port_launcher().has_value(); }

Result<PortChild> launch_port(const HostOptions& options, const Course& course) {
  const Served served{&options, course};
  if (auto& launcher = port_launcher()) {
    auto child = launcher->launch(served);
    if (!launcher->is_alive()) launcher.reset();
    return child;
  }
  if (is_below_guard()) return fail("the worker has no launcher for the port's process");
  auto calls = shared_calls();
  if (!calls) return tl::unexpected(calls.error());
  return Child::spawn(
             Child::Runs::code_of_others,
             [&](MessageSocket& judge) { serve(served, **calls, judge); }, *options.barrier)
      .map([&](Child child) {
        return PortChild{std::move(child), *std::move(calls)};
      });
}

}  // namespace attest
