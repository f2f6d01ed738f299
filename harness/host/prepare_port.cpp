#include <utility>

#include "harness/host/port_process.hpp"
#include "harness/port/port.hpp"

namespace attest {

void hold_to(const PortDescription& port, HostOptions& options) {
  options.hangs = port.hangs;
  if (port.hangs.empty()) options.said = port;
}

Result<PortDescription> prepare_port(HostOptions& options,
                                     const std::vector<std::string>& profiles) {
  const auto store = [&](Result<PortFiles> files) {
    return files.map([&](PortFiles& read) {
      options.files = std::make_shared<const PortFiles>(std::move(read));
    });
  };
  const auto hashed = store(PortFiles::read(options.port));
  auto port = describe_port(options, profiles);
  // If a file is no port, the error of loading it is the better one.
  if (!port) return port;
  if (!hashed) return tl::unexpected(hashed.error());
  if (kind_of(options.port).is_program && !port->files.empty()) {
    if (auto again = store(PortFiles::read(options.port, port->files)); !again) {
      return tl::unexpected(again.error());
    }
  }
  hold_to(*port, options);
  return port;
}

Result<void> check_port(const HostOptions& options) {
  return options.files ? options.files->check(PortFiles::Untouched::hashed) : Result<void>();
}

}  // namespace attest
