#include "harness/port/conversation.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/core/printable.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/csv_cells.hpp"

namespace attest {

std::string_view name_of(Request request) {
  switch (request) {
    case Request::create:
      return "create";
    case Request::destroy:
      return "destroy";
    case Request::set_parameter:
      return "set_parameter";
    case Request::step:
      return "step";
    case Request::batch:
      return "batch";
  }
  return "";
}

Result<std::unique_ptr<Conversation>> Conversation::begin(const std::vector<std::string>& command) {
  auto started = PipedProgram::start(command);
  if (!started) return tl::unexpected(started.error());
  return begin(*std::move(started));
}

Result<std::unique_ptr<Conversation>> Conversation::begin(PipedProgram program) {
  const bool is_written = program.write(greeting());
  const auto line = is_written ? program.read_line(max_line) : std::nullopt;
  if (!line) {
    const std::string_view begun = program.unread();
    if (begun.size() > max_line) {
      return fail(fmt::format("its answer to the handshake has no end within {} bytes", max_line));
    }
    const std::string unfinished =
        begun.empty() ? "" : fmt::format(", after {} without a line feed", in_backquotes(begun));
    return fail(fmt::format("it {} before it answered the handshake{}", program.end(), unfinished));
  }
  auto hello = parse_hello(*line);
  if (!hello) return tl::unexpected(hello.error());
  if (hello->frames == FrameForm::text) {
    return text_conversation(std::move(program), *std::move(hello));
  }
  if (hello->frames == FrameForm::shared && !program.share_memory()) {
    return fail("it has no memory for `frames` = `shared`");
  }
  return binary_conversation(std::move(program), *std::move(hello));
}

int Conversation::batch(std::uint32_t, Module, std::span<ProgramStep>, std::size_t& done) {
  done = 0;
  return ATTEST_FAILED;
}

void Conversation::destroy_quietly(std::uint32_t unit) noexcept {
  if (is_over_) return;
  try {
    const int result = destroy(unit);
    if (result != ATTEST_OK) {
      broken(Request::destroy, fmt::format("has the result {}; only {} (ok) is possible", result,
                                           static_cast<int>(ATTEST_OK)));
    }
  } catch (const PortBroke& broke) {
    late_ = broke;
  }
}

void Conversation::throw_late() {
  if (late_) throw *std::exchange(late_, std::nullopt);
}

void Conversation::ended(Request request) {
  is_over_ = true;
  const std::string begun = program_.unread().empty() ? ""
                                                      : fmt::format(" after {} bytes of an answer",
                                                                    program_.unread().size());
  throw PortBroke(PortBroke::How::ended, fmt::format("the program {}{} in the request `{}`",
                                                     program_.end(), begun, name_of(request)));
}

void Conversation::broken(Request request, const std::string& what) {
  is_over_ = true;
  throw PortBroke(PortBroke::How::rules, fmt::format("the answer to the request `{}` {}",
                                                     name_of(request), printable_part(what)));
}

}  // namespace attest
