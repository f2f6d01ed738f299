#include "harness/process/launcher.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/process/process.hpp"

namespace attest {
namespace {

struct Launched {
  pid_t child;
  int reason;  // errno, if there is no child
};

// Runs in the launcher: serves the owner until the owner closes the socket.
void serve(const BarrierOptions& options, const Launcher::Work& work, MessageSocket& owner) {
  const auto barrier = Barrier::make(options);
  if (!barrier) {
    fmt::print(stderr, "{}\n", barrier.error().to_string());
    ::_exit(EXIT_FAILURE);
  }
  while (true) {
    const std::vector<int> descriptors = owner.receive_descriptors();
    if (descriptors.size() != 3) return;
    const ChildFiles files{descriptors[0], descriptors[1], descriptors[2]};
    Launched launched{};
    launched.child = fork_sibling([&] {
      run_in_child(&*barrier, files, [&](MessageSocket& socket) {
        const Received request = socket.receive();
        if (request.kind == Received::Kind::message) work(request.head, socket);
      });
    });
    launched.reason = errno;
    for (const int descriptor : descriptors) ::close(descriptor);
    if (!owner.send("", {{&launched, sizeof launched}})) return;
  }
}

}  // namespace

Result<Launcher> Launcher::start(const BarrierOptions& barrier, const Work& work,
                                 double time_limit_s) {
  auto process = Child::spawn(Child::Runs::our_code,
                              [&](MessageSocket& owner) { serve(barrier, work, owner); });
  if (!process) return tl::unexpected(process.error());
  return Launcher(*std::move(process), time_limit_s);
}

pid_t Launcher::fork_there(const ChildFiles& files) {
  const std::array descriptors{files.input, files.output, files.socket};
  if (!process_.socket().send_descriptors(descriptors)) {  // for example, too many are in transit
    is_alive_ = errno != EPIPE && errno != ECONNRESET;
    return -1;
  }
  const Patience patience = Patience::seconds(time_limit_s_);
  Launched launched{};
  Received::Kind answered = process_.receive(patience).kind;
  if (answered == Received::Kind::message) {
    answered = process_.receive_blob(&launched, sizeof launched, patience);
  }
  is_alive_ = answered == Received::Kind::message;
  is_late_ = answered == Received::Kind::too_late;
  if (!is_alive_) {
    errno = ECHILD;
    return -1;
  }
  errno = launched.reason;
  return launched.child;
}

std::string Launcher::why_it_died() {
  if (is_late_) {
    return fmt::format("did not answer within {} s; the port may have stopped it", time_limit_s_);
  }
  return process_.end() + "; please report this";
}

Result<Child> Launcher::launch(const std::string& request) {
  if (!is_alive_) return fail("the launcher process of attest has died");
  auto child = Child::adopt(
      [&](const ChildFiles& files) { return Process::adopt([&] { return fork_there(files); }); });
  if (is_alive_) {
    // A failure of send() is ignored here: the caller's receive() shows that the child has died.
    if (child) child->socket().send(request, {}, Patience::seconds(time_limit_s_));
    return child;
  }
  process_.kill();
  return fail("a launcher process of attest " + why_it_died());
}

}  // namespace attest
